"""Functions that do the work of several at once: their values are those of each, in every language."""

from collections.abc import Mapping
from dataclasses import replace
from types import ModuleType

import numpy as np
import pytest
from arms_support import ARMS, inputs
from c_support import Library, flat, flat_c, shared_library, write

from modelgen.backends import NumpyFunction
from modelgen.description import Combined, loads
from modelgen.effects import known_effects
from modelgen.errors import InputError
from modelgen.functions import Function, Model, Options, build_model
from modelgen.generation.arm import print_model

pytestmark = pytest.mark.xdist_group("combined")

COMBINED = {
    "tick": ("inverse_dynamics", "mass_matrix"),
    "adapt": ("slotine_li_regressor", "gravity", "bias"),
    "plan": ("forward_dynamics_derivatives", "jacobian", "energy"),
    "everything": ("forward_kinematics", "regressor", "forward_dynamics", "gravity", "inverse_dynamics"),
}
ORDER = ["q", "dq", "ddq", "dq_r", "ddq_r", "input", "parameters"]
ARM = replace(ARMS["ariane4"], combined=tuple(Combined(*one) for one in COMBINED.items()))


def functions(made: Model) -> dict[str, Function]:
    return {f.name: f for f in made.functions}


def each(made: Model, name: str, given: Mapping[str, np.ndarray]) -> np.ndarray:
    """The outputs of a function on its own, one after the other."""
    function = functions(made)[name]
    return flat(function, NumpyFunction(function)(*(given[a.name] for a in function.arguments)))


@pytest.fixture(scope="module")
def made() -> Model:
    return build_model(ARM)


@pytest.fixture(scope="module")
def library(made: Model, tmp_path_factory: pytest.TempPathFactory) -> tuple[Library, dict[str, object]]:
    folder = tmp_path_factory.mktemp("combined")
    files = print_model(made, ARM, {}).files
    write(files, folder)
    module = ModuleType("generated")
    exec(files["ariane4_casadi.py"], module.__dict__)  # noqa: S102 - the text under test
    return Library(shared_library(folder, "ariane4", "double"), made, "double"), module.functions()


@pytest.mark.parametrize("suffix", ["", "_standard"])
@pytest.mark.parametrize("name", sorted(COMBINED))
def test_values_are_those_of_each(
    name: str, suffix: str, made: Model, library: tuple[Library, dict[str, object]]
) -> None:
    compiled, casadi = library
    known = functions(made)
    function = known[f"{name}{suffix}"]
    arguments = [a.name for a in function.arguments]
    assert arguments == [a for a in ORDER if a in arguments]
    rng = np.random.default_rng(2)
    for _ in range(3):
        given = inputs(made, function, rng)
        parts = [f"{part}{suffix}" if f"{part}{suffix}" in known else part for part in COMBINED[name]]
        by_name = dict(zip(arguments, given, strict=True))
        expected = np.concatenate([each(made, part, by_name) for part in parts])
        status, by_c = compiled.call(function.name, *given)
        assert status == 0
        results = [
            flat(function, NumpyFunction(function)(*given)),
            flat_c(by_c),
            flat(function, casadi[f"ariane4_{function.name}"](*given)),  # type: ignore[operator]
        ]
        for found in results:
            assert np.abs(found - expected).max() <= 1e-12 * np.abs(expected).max()
            np.testing.assert_allclose(found, expected, rtol=1e-10, atol=1e-15 * np.abs(expected).max())


def total(function: Function) -> int:
    return sum(function.operations[kind] for kind in ("mul", "add", "neg"))


def test_work_that_is_shared_is_done_once(made: Model) -> None:
    known = functions(made)
    apart = [known[name] for name in COMBINED["tick"]]
    assert total(known["tick"]) < 0.95 * sum(total(f) for f in apart)
    assert known["tick"].operations["trig"] == max(f.operations["trig"] for f in apart)
    assert known["plan"].operations["div"] == known["forward_dynamics_derivatives"].operations["div"]


def test_a_lever_beyond_its_stroke_zeroes_every_output(
    made: Model, library: tuple[Library, dict[str, object]]
) -> None:
    given = inputs(made, functions(made)["everything"], np.random.default_rng(2))
    given[0] = given[0] + 3.0
    status, found = library[0].call("everything", *given)
    assert status == 1
    assert not np.any(flat_c(found))


def test_folded_parameters_too_and_rows_where_they_exist() -> None:
    few = replace(ARMS["gravity_arm"], combined=(Combined("tick", ("inverse_dynamics", "mass_matrix")),))
    names = [f.name for f in build_model(few, Options(nominal=True)).functions]
    assert [n for n in names if n.startswith("tick")] == ["tick", "tick_standard", "tick_nominal"]
    names = [f.name for f in build_model(few, Options(gains="row_wise")).functions]
    assert [n for n in names if n.startswith("tick")] == ["tick_standard"]
    assert not [f for f in build_model(few, Options(combined=False)).functions if f.parts]


TEXT = """schema: 1
convention: khalil_kleinfinger
arms:
  bench:
    joints:
      - {name: j1}
    combined:
      %s
"""


@pytest.mark.parametrize(
    ("entry", "message"),
    [
        (
            "tick: [gravity, inverse_dynamix]",
            "arms.yaml:8:23: combined 'tick': found 'inverse_dynamix', expected functions of the arm, "
            "did you mean 'inverse_dynamics'? (available: inverse_dynamics, gravity, ",
        ),
        ("tick: [gravity, gravity]", "arms.yaml:8:23: combined 'tick': found 'gravity' twice, expected"),
        ("bias: [gravity]", "arms.yaml:8:7: 'bias' is in use"),
        ("fast_standard: [gravity]", "arms.yaml:8:7: 'fast_standard' is in use or ends in one of _standard"),
        (
            "tick: [pose]",
            "arms.yaml:8:14: combined 'tick': found 'pose', expected functions of the arm, available:",
        ),
    ],
)
def test_what_does_not_exist_is_said_with_what_does(entry: str, message: str) -> None:
    (arm,) = loads(TEXT % entry, "arms.yaml", known_effects()).values()
    with pytest.raises(InputError) as error:
        build_model(arm)
    assert str(error.value).startswith(message)


@pytest.mark.parametrize("entry", ["Tick: [gravity]", "tick: []", "tick: gravity"])
def test_what_is_no_list_of_functions_is_refused(entry: str) -> None:
    with pytest.raises(InputError, match=r"arms.yaml:8:\d+"):
        loads(TEXT % entry, "arms.yaml", known_effects())


def test_the_self_test_calls_it(library: tuple[Library, dict[str, object]]) -> None:
    text = (library[0].path.parent / "examples/self_test/main.c").read_text(encoding="utf-8")
    assert all(f"ariane4_{name}(" in text for name in COMBINED)
