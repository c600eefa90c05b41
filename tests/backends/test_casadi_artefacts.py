"""What is bound to a release of CasADi: serialised functions, and the compiled plant with derivatives."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import casadi as ca
import numpy as np
import pytest
from arms_support import ARMS, base_vector, inputs, model, standard_vector

from modelgen.errors import InputError
from modelgen.functions import Options, nominal_base
from modelgen.generation import generate, generate_arm

ARM = ARMS["ariane4"]
pytestmark = pytest.mark.xdist_group("ariane4")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The arm's folder with every artefact."""
    out = tmp_path_factory.mktemp("generated")
    generate([ARM], out, Options(), artefacts=("casadi", "plant"), processes=1)
    return out / "ariane4"


@pytest.fixture(scope="module")
def functions(checkout: Path) -> dict[str, ca.Function]:
    """The functions of the module in the repository, by importing it as a user does."""
    sys.path.insert(0, str(checkout / "generated" / "ariane4"))
    writes, sys.dont_write_bytecode = sys.dont_write_bytecode, True
    try:
        import ariane4_casadi  # noqa: PLC0415 - found in a generated folder
    finally:
        sys.path.pop(0)
        sys.dont_write_bytecode = writes
    made: dict[str, ca.Function] = ariane4_casadi.functions()
    return made


@pytest.fixture(scope="module")
def plant(folder: Path) -> ca.Function:
    """The plant, built by the command at the head of its file."""
    library = folder / "ariane4_plant.so"
    sources = [
        f"{f}/ariane4_{n}.c" for f, n in (("plant", "plant"), ("src", "forward_dynamics"), ("src", "sincos"))
    ]
    command = [
        "cc",
        "-O1",
        "-Wall",
        "-Werror",
        "-shared",
        "-fPIC",
        "-Iinclude",
        *sources,
        "-lm",
        "-o",
        library,
    ]
    subprocess.run(command, cwd=folder, check=True)
    return ca.external("ariane4_plant", str(library))


def states(count: int) -> list[list[np.ndarray]]:
    """Arguments of forward_dynamics inside the strokes: q, dq, input, parameters about the nominal ones."""
    made = model("ariane4")
    function = next(f for f in made.functions if f.name == "forward_dynamics")
    nominal = np.array(list(nominal_base(made).values()))
    rng = np.random.default_rng(5)
    return [[*inputs(made, function, rng)[:3], nominal * rng.uniform(0.9, 1.1, 24)] for _ in range(count)]


def test_every_function_is_serialised_and_gives_the_same(
    folder: Path, functions: dict[str, ca.Function]
) -> None:
    assert {path.stem for path in (folder / "casadi").iterdir()} == set(functions)
    made = model("ariane4")
    rng = np.random.default_rng(6)
    for f in made.functions:
        name = f"ariane4_{f.name}"
        loaded = ca.Function.load(str(folder / "casadi" / f"{name}.casadi"))
        assert str(loaded) == str(functions[name])
        arguments = inputs(made, f, rng)
        for one, other in zip(loaded.call(arguments), functions[name].call(arguments), strict=True):
            np.testing.assert_array_equal(one.full(), other.full())


def test_a_serialised_function_has_second_derivatives(folder: Path) -> None:
    loaded = ca.Function.load(str(folder / "casadi" / "ariane4_energy.casadi"))
    q, dq = ca.MX.sym("q", 3), ca.MX.sym("dq", 3)
    p = base_vector(model("ariane4"), standard_vector(model("ariane4"), np.random.default_rng(1)))
    mass = ca.Function("mass", [q, dq], [ca.hessian(loaded(q, dq, p)[0], dq)[0]])
    expected = ca.Function.load(str(folder / "casadi" / "ariane4_mass_matrix.casadi"))
    at = [0.1, 0.9, 3.0]
    np.testing.assert_allclose(mass(at, [1, 2, 3]).full(), expected(at, p).full(), rtol=1e-12)


def test_the_plant_has_the_face_of_forward_dynamics(
    plant: ca.Function, functions: dict[str, ca.Function]
) -> None:
    dynamics = functions["ariane4_forward_dynamics"]
    assert plant.class_name() == "External"
    assert plant.name_in() == dynamics.name_in()
    assert plant.name_out() == dynamics.name_out()
    assert [plant.sparsity_in(i) for i in range(4)] == [dynamics.sparsity_in(i) for i in range(4)]


def test_the_plant_and_its_jacobian_are_those_of_the_sx_function(
    plant: ca.Function, functions: dict[str, ca.Function]
) -> None:
    jacobian = plant.jacobian()
    expected = functions["ariane4_forward_dynamics"].jacobian()
    for arguments in states(50):
        result = functions["ariane4_forward_dynamics"](*arguments).full()
        np.testing.assert_allclose(
            plant(*arguments).full(), result, rtol=1e-12, atol=1e-12 * abs(result).max()
        )
        for one, other in zip(
            jacobian.call([*arguments, result]), expected.call([*arguments, result]), strict=True
        ):
            np.testing.assert_allclose(
                one.full(), other.full(), rtol=1e-9, atol=1e-9 * abs(other.full()).max()
            )


def test_the_plants_jacobian_is_the_difference_quotient_of_the_c(plant: ca.Function) -> None:
    """Where no dry friction changes its sign: the C alone is the witness."""
    for arguments in states(5):
        blocks = plant.jacobian().call([*arguments, np.zeros(3)])
        for k, block in enumerate(blocks):
            direction = np.random.default_rng(k).uniform(0.5, 1, arguments[k].size) * abs(arguments[k])
            step = 1e-5
            ahead, back = (
                plant(*[a + s * step * direction if i == k else a for i, a in enumerate(arguments)]).full()
                for s in (1, -1)
            )
            slope = (block.full() @ direction)[:, None]
            np.testing.assert_allclose(
                (ahead - back) / (2 * step), slope, rtol=1e-6, atol=1e-7 * abs(slope).max()
            )


def test_the_plant_differentiates_inside_a_casadi_graph(plant: ca.Function) -> None:
    """The effort's Jacobian is the inverse of the mass matrix times the drive gains."""
    q, dq, i, p = states(1)[0]
    u = ca.MX.sym("u", 3)
    slope = ca.Function("slope", [u], [ca.jacobian(plant(q, dq, u, p), u)])
    step = plant(q, dq, i + np.eye(3)[0], p) - plant(q, dq, i, p)
    np.testing.assert_allclose(slope(i).full()[:, 0], step.full().ravel(), rtol=1e-9)


def test_the_plant_refuses_a_lever_beyond_its_stroke(plant: ca.Function) -> None:
    _, dq, i, p = states(1)[0]
    with pytest.raises(RuntimeError, match="ariane4_plant"):
        plant([1.0, 1.0, 3.0], dq, i, p)


def test_artefacts_belong_to_a_check_that_asks_for_them(folder: Path, tmp_path: Path) -> None:
    shutil.copytree(folder, tmp_path / "ariane4", ignore=shutil.ignore_patterns("*.so"))
    (tmp_path / "ariane4" / "casadi" / "ariane4_bias.casadi").write_text("other")
    (tmp_path / "ariane4" / "plant" / "ariane4_plant.c").unlink()

    def drift(*artefacts: str) -> list[tuple[str, str]]:
        found = generate([ARM], tmp_path, Options(), check=True, artefacts=artefacts, processes=1).drift
        return [(d.path.relative_to(tmp_path / "ariane4").as_posix(), d.kind) for d in found]

    assert drift() == []
    assert drift("casadi") == [("casadi/ariane4_bias.casadi", "changed")]
    assert drift("plant") == [("plant/ariane4_plant.c", "missing")]
    generate([ARM], tmp_path, Options(), processes=1)
    assert not (tmp_path / "ariane4" / "casadi").exists(), "stale artefacts stay behind"
    assert len(drift("casadi", "plant")) == len(model("ariane4").functions) + 1


def test_the_manifest_does_not_depend_on_artefacts(folder: Path, checkout: Path) -> None:
    committed = checkout / "generated" / "ariane4" / "manifest.json"
    assert "casadi/" not in (folder / "manifest.json").read_text()
    assert (folder / "manifest.json").read_text() == generate_arm(ARM, Options()).files["manifest.json"]
    ignored = ["casadi/ariane4_bias.casadi", "plant/ariane4_plant.c"]
    done = subprocess.run(
        ["git", "check-ignore", *(str(committed.parent / name) for name in ignored)],
        cwd=checkout,
        capture_output=True,
        text=True,
        check=False,
    )
    if "not a git repository" in done.stderr:
        pytest.skip("needs a git checkout")
    assert len(done.stdout.splitlines()) == 2


def test_row_wise_gains_have_no_plant() -> None:
    with pytest.raises(InputError, match="no forward_dynamics to make a plant of"):
        generate_arm(ARMS["gravity_arm"], Options(gains="row_wise"), ("plant",))


def test_the_module_needs_casadi_alone(checkout: Path, tmp_path: Path) -> None:
    """A copy of one file, in a process that cannot import modelgen or anything that modelgen needs."""
    shutil.copy(checkout / "generated" / "ariane4" / "ariane4_casadi.py", tmp_path)
    q, dq, i, p = (a.tolist() for a in states(1)[0])
    code = f"""
import sys
for name in ("modelgen", "sympy", "jinja2", "pydantic", "rich", "ruamel", "typer", "acados_template"):
    sys.modules[name] = None
import casadi
from ariane4_casadi import functions
f = functions()
ddq = f["ariane4_forward_dynamics"](q={q}, dq={dq}, input={i}, parameters={p})["ddq"]
back = f["ariane4_inverse_dynamics"](q={q}, dq={dq}, ddq=ddq, parameters={p})["input"]
assert float(casadi.norm_inf(back - casadi.DM({i}))) < 1e-9, back
print(len(f))
"""
    environment = os.environ | {"PYTHONPATH": "", "PYTHONDONTWRITEBYTECODE": "1"}
    done = subprocess.run(
        [sys.executable, "-c", code],
        cwd=tmp_path,
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 0, done.stderr
    assert int(done.stdout) == len(model("ariane4").functions)
