"""The programs of `make bench` compute the same, and what they cost is counted."""

import importlib.util
import shutil
from pathlib import Path

import numpy as np
import pytest
from peers import cost, field, mujoco_model, operations, ours, symbolic, sympy_kane
from peers.build import Built, pinocchio_flags
from peers.measure import Call, heap, instructions, values

pytestmark = [
    pytest.mark.xdist_group("peers"),
    pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc"),
]
HEADER = Path("/usr/include/valgrind/callgrind.h")


def calls(name: str, folder: Path, *, others: bool = False) -> dict[str, Call]:
    """modelgen and MuJoCo; `others`: SymPy and SymForce besides."""
    if not HEADER.exists():
        pytest.skip("needs valgrind (Debian: valgrind)")
    case = field.subject(name, samples=20)
    (folder / "ours").mkdir()
    model = field.links_alone(case.arm)
    ours.write(model, folder / "ours")
    mujoco_model.save(case, folder / "model.mjb")
    made: dict[str, Built] = {field.OURS: ours.built(model, folder / "ours")}
    if others:
        (folder / "kane").mkdir()
        sympy_kane.main(name, folder / "kane" / "kane.c")
        made[field.KANE] = symbolic.kane(folder / "kane" / "kane.c", case.joints)
        if importlib.util.find_spec("symforce") and pinocchio_flags():
            (folder / "symforce").mkdir()
            cost.generated("peers.symforce_newton", name, str(folder / "symforce"))
            made[field.SYMFORCE] = symbolic.symforce(folder / "symforce", case.joints)
    found = {peer: Call(built.program, folder, case) for peer, built in made.items()}
    model_file = folder / "model.mjb"
    found[field.MUJOCO] = Call(mujoco_model.harness(folder), folder, case, model_file)
    return found


@pytest.fixture(scope="module")
def peers(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Call]:
    return calls("yaw3pitch", tmp_path_factory.mktemp("peers"), others=True)


@pytest.mark.parametrize("peer", [field.MUJOCO, field.KANE, field.SYMFORCE])
def test_everyone_computes_the_same(peers: dict[str, Call], peer: str) -> None:
    if peer not in peers:
        pytest.skip(f"needs {peer}")
    case = peers[peer].subject
    results = {name: values(peers[name]) for name in (field.OURS, peer)}
    assert "inverse_dynamics" in results[peer]
    field._agree(case, field.links_alone(case.arm), results)


@pytest.mark.parametrize("name", ["two_fingers", "ariane4", "scara"])
def test_trees_locked_and_sliding_joints_are_given_to_everyone_alike(name: str, tmp_path: Path) -> None:
    found = calls(name, tmp_path)
    case = found[field.OURS].subject
    results = {peer: values(call) for peer, call in found.items()}
    field._agree(case, field.links_alone(case.arm), results)


def test_a_peer_that_computes_something_else_is_refused(peers: dict[str, Call]) -> None:
    case = peers[field.OURS].subject
    right = values(peers[field.OURS])
    wrong = {"forward_dynamics": right["forward_dynamics"] * (1 + 1e-7)}
    model = field.links_alone(case.arm)
    field._agree(case, model, {field.OURS: right})
    with pytest.raises(RuntimeError, match=r"somebody and modelgen differ by .* in forward_dynamics"):
        field._agree(case, model, {field.OURS: right, "somebody": wrong})


def test_instructions_do_not_depend_on_the_run(peers: dict[str, Call]) -> None:
    first, second = instructions(peers[field.OURS]), instructions(peers[field.OURS])
    assert first == second
    assert set(first) > set(field.FUNCTIONS)
    assert 200 < first["mass_matrix"] < first["inverse_dynamics"] < first["inverse_dynamics_run_time"]


def test_only_mujoco_allocates(peers: dict[str, Call]) -> None:
    assert heap(peers[field.OURS]) == 0
    assert heap(peers[field.MUJOCO]) > 1e5


def test_operations_are_counted_as_written() -> None:
    text = """
    /* a*b */ const double a = -1.5e-3*q[0] + std::sin(q(1, 0)); // x/y
    a0 = (-a1); a2 = casadi_sq(a0) - pow(a1, 2)/(a3 - -2.0); return -a2;
    """
    counted = operations.operations(text)
    assert counted == {"mul": 3, "add": 3, "neg": 2, "div": 1, "sqrt": 0, "trig": 1}


def test_memory_of_a_process_is_its_own() -> None:
    ballast = np.ones(40_000_000)  # 320 MB that a child must not be charged with
    _, small, _ = cost.launched(["true"])
    _, large, _ = cost.launched([shutil.which("python3") or "python3", "-c", "b = b'x' * 10**8"])
    assert small < 100 < large < 250
    assert ballast[-1] == 1
