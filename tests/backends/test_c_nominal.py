"""Nominal parameters folded in, and their array: against the functions that take the standard vector."""

import ctypes
from dataclasses import dataclass

import casadi
import numpy as np
import pytest
from arms_support import ARMS
from c_support import Library, shared_library, write

from modelgen.description import Arm, loads
from modelgen.errors import InputError
from modelgen.functions import Model, Options, build_model, nominal_standard
from modelgen.generation.arm import print_model

pytestmark = pytest.mark.xdist_group("c_nominal")

FOLDED = ["inverse_dynamics", "gravity", "bias", "mass_matrix", "forward_dynamics"]
ELASTIC = """
schema: 1
convention: khalil_kleinfinger
arms:
  elastic:
    joints:
      - {name: j1, drive: {type: direct, ratio: 50, torque_constant: 0.1},
         effects: [{drive_inertia: {inertia: 2e-4}}, {joint_flexibility: {stiffness: 900}}]}
      - {name: j2, d: 0.5, drive: {type: direct, ratio: 30, torque_constant: 0.1},
         effects: [{coulomb_friction: {magnitude: 0.2}}, {drive_inertia: {inertia: 1e-4}}]}
    links:
      j1: {mass: 6, com: [0.2, 0.01, 0], inertia: [0.02, 0, 0, 0.1, 0, 0.1]}
      j2: {mass: 3, com: [0.15, 0, 0.02], inertia: [0.01, 0, 0, 0.05, 0, 0.05]}
"""


@dataclass
class Generated:
    """An arm's code with its nominal parameters."""

    model: Model
    library: Library
    module: dict[str, object]


def described(name: str) -> Arm:
    """An arm that ships, or the elastic one."""
    return ARMS[name] if name in ARMS else loads(ELASTIC)["elastic"]


@pytest.fixture(scope="module", params=["ariane4", "elastic"])
def generated(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Generated:
    folder = tmp_path_factory.mktemp(request.param)
    arm = described(request.param)
    model = build_model(arm, Options(nominal=True))
    files = print_model(model, arm, {}).files
    write(files, folder)
    module: dict[str, object] = {}
    exec(files[f"{arm.name}_casadi.py"], module)  # noqa: S102 - the text under test
    return Generated(model, Library(shared_library(folder, arm.name, "double"), model, "double"), module)


def array(g: Generated) -> np.ndarray:
    """The array of the C code."""
    kind = ctypes.c_double * len(g.model.grouping.base)
    return np.array(kind.in_dll(g.library.library, f"{g.model.arm.name}_nominal_parameters"))


def called(g: Generated, name: str, state: dict[str, np.ndarray]) -> tuple[int, dict[str, np.ndarray]]:
    """Status and outputs of a function in a state that has all inputs by name."""
    return g.library.call(name, *(state[a.name] for a in g.library.functions[name].arguments))


def test_functions_and_array_are_the_description_s_arm(generated: Generated) -> None:
    rng, n = np.random.default_rng(3), len(generated.model.arm.coordinates)
    standard = np.array(list(nominal_standard(generated.model).values()))
    limits = [
        generated.model.arm.joints[i].limits.position or (-1.0, 1.0) for i in generated.model.arm.coordinates
    ]
    state = {name: rng.uniform(-0.5, 0.5, n) for name in ("dq", "ddq", "input")}
    state["q"] = np.array([low + 0.6 * (high - low) for low, high in limits])
    state["state"] = rng.uniform(-1e-3, 1e-3, len(generated.model.states))
    given_as = {"_nominal": {}, "": {"parameters": array(generated)}, "_standard": {"parameters": standard}}
    for name in FOLDED:
        (status, folded), given, whole = (
            called(generated, name + suffix, state | more) for suffix, more in given_as.items()
        )
        assert (status, given[0], whole[0]) == (0, 0, 0)
        scale = np.abs(whole[1]["out"]).max()
        np.testing.assert_allclose(folded["out"], whole[1]["out"], atol=1e-12 * scale, err_msg=name)
        np.testing.assert_allclose(given[1]["out"], whole[1]["out"], atol=1e-12 * scale, err_msg=name)


def test_casadi_has_the_same_values(generated: Generated) -> None:
    assert list(array(generated)) == list(generated.module["NOMINAL_PARAMETERS"])
    name = f"{generated.model.arm.name}_mass_matrix"
    functions = generated.module["functions"]()
    q = casadi.DM([0.1] * functions[name].numel_in(0))
    folded, given = (
        functions[f"{name}_nominal"](q),
        functions[name](q, generated.module["NOMINAL_PARAMETERS"]),
    )
    np.testing.assert_allclose(folded, given, rtol=1e-12, atol=1e-12)


def test_what_has_no_nominal_value_is_named() -> None:
    with pytest.raises(InputError, match=r"ur10e: FV1, .* has no nominal value in the description"):
        build_model(ARMS["ur10e"], Options(nominal=True))
    with pytest.raises(InputError, match="row-wise gains"):
        build_model(ARMS["ariane4"], Options(nominal=True, gains="row_wise"))
