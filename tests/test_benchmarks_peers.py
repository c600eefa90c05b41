"""The programs of `make bench` compute the same, and their instructions are counted."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from peers import field, mujoco_model, sympy_kane
from peers.measure import Call, instructions, values

pytestmark = pytest.mark.skipif(shutil.which("gcc") is None, reason="needs gcc")
HEADER = Path("/usr/include/valgrind/callgrind.h")


@pytest.fixture(scope="module")
def peers(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Call]:
    if not HEADER.exists():
        pytest.skip("needs valgrind (Debian: valgrind)")
    folder = tmp_path_factory.mktemp("peers")
    case = field.subject("yaw3pitch", samples=20)
    program, _ = field.ours.generated(field.links_alone(case.arm), folder)
    mujoco_model.save(case.arm, folder / "model.mjb")
    source = folder / "kane.c"
    sympy_kane.main("yaw3pitch", source)
    return {
        field.OURS: Call(program, folder, case),
        field.MUJOCO: Call(mujoco_model.harness(folder), folder, case, folder / "model.mjb"),
        field.KANE: Call(field.ours.kane(source, case.joints, folder), folder, case),
    }


@pytest.mark.parametrize("peer", [field.MUJOCO, field.KANE])
def test_everyone_computes_the_same(peers: dict[str, Call], peer: str) -> None:
    ours, theirs = values(peers[field.OURS]), values(peers[peer])
    assert set(theirs) & {"inverse_dynamics"}
    for function, value in theirs.items():
        np.testing.assert_allclose(value, ours[function], rtol=0, atol=1e-9 * np.abs(value).max())


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
