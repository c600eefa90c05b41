"""The example's MPC in C drives the arm as CasADi's does, which has other derivatives and another solver."""

import shutil
import subprocess
from collections.abc import Callable
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from mpc_arm import ControlledArm, perturbed
from mpc_c import built, closed_loop_in_c, daqp
from mpc_horizon import Horizon
from mpc_loop import closed_loop
from mpc_plant import Plant
from mpc_support import example

pytestmark = pytest.mark.xdist_group("mpc")

Program = Callable[[float], Path]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return tmp_path_factory.mktemp("mpc")


@pytest.fixture(scope="module")
def arm(tmp_path_factory: pytest.TempPathFactory) -> ControlledArm:
    return example(tmp_path_factory).arm


@pytest.fixture(scope="module")
def program(
    checkout: Path, folder: Path, arm: ControlledArm, tmp_path_factory: pytest.TempPathFactory
) -> Program:
    """The closed loop, by the least descent of a step."""
    try:
        sources = daqp(folder)
    except RuntimeError as error:
        pytest.skip(str(error))
    generated = (example(tmp_path_factory).generated, checkout / "generated" / "ariane4")
    return cache(lambda least: built(arm, generated, sources, folder / f"{least:g}", least))


@pytest.fixture(scope="module")
def plant(arm: ControlledArm, tmp_path_factory: pytest.TempPathFactory) -> Plant:
    return Plant(example(tmp_path_factory).library, "ariane4", perturbed(arm, 1), 3)


@pytest.fixture(scope="module")
def horizon(arm: ControlledArm) -> Horizon:
    """Another formulation, to the last digits; what it plans depends on what it is given alone."""
    return Horizon(arm, "forward", "fatrop", tolerance=1e-9)


# In motion; where the current of joint 1 is not enough; where its reference is beyond the stroke.
@pytest.mark.parametrize("begin", [2.0, 9.0, 15.0])
def test_both_drive_the_arm_alike(
    arm: ControlledArm, program: Program, plant: Plant, horizon: Horizon, begin: float
) -> None:
    """Each solved as far as it goes: what is left is the solvers' rounding, grown by the loop."""
    mine = closed_loop_in_c(program(1e-12), arm, perturbed(arm, 1), 0.3, begin)
    other = closed_loop(horizon, plant, 0.3, begin=begin)
    assert other.failures == 0
    moved = abs(np.diff(other.states[:, :3], axis=0)).max()
    assert moved > 1e-3
    np.testing.assert_allclose(mine.inputs, other.inputs, rtol=0, atol=1e-4 * arm.effort.max())
    np.testing.assert_allclose(mine.states[:, :3], other.states[:, :3], rtol=0, atol=1e-6)


def test_every_plan_converges_within_the_limits(arm: ControlledArm, program: Program) -> None:
    assert arm.drives is not None
    run = closed_loop_in_c(program(1e-8), arm, perturbed(arm, 1), 24.0)
    assert run.failures == 0
    assert (abs(run.inputs) <= arm.effort).all()
    assert np.isclose(abs(run.inputs), arm.effort).any(axis=0)[0], "joint 1 at its limit"
    assert (run.motor > arm.drives.low).all()
    assert (run.motor < arm.drives.high).all()
    away = np.deg2rad(0.75)
    followed = abs(run.error[run.t < 5.0])
    assert (followed < away).all()


def test_a_plan_takes_less_time_than_with_fatrop_and_a_compiler(
    arm: ControlledArm, program: Program, plant: Plant, tmp_path: Path
) -> None:
    """CPU time of the same closed loop; the faster formulation of CasADi's."""
    fastest = closed_loop(Horizon(arm, "inverse", "fatrop", compiled_in=tmp_path), plant, 2.0)
    mine = closed_loop_in_c(program(1e-8), arm, perturbed(arm, 1), 2.0)
    assert np.median(mine.cpu) <= np.median(fastest.cpu)


@pytest.mark.skipif(shutil.which("ldd") is None, reason="needs ldd")
def test_the_program_needs_nothing_but_the_c_library(program: Program) -> None:
    listed = subprocess.run(["ldd", program(1e-8)], capture_output=True, text=True, check=True).stdout
    names = {line.split()[0].rsplit("/", 1)[-1].split(".")[0] for line in listed.splitlines()}
    assert names <= {"linux-vdso", "libm", "libc", "ld-linux-x86-64", "ld-linux-aarch64"}


def test_what_is_missing_is_said(program: Program, arm: ControlledArm) -> None:
    with pytest.raises(RuntimeError, match="expected 24 parameters of the plant on stdin"):
        closed_loop_in_c(program(1e-8), arm, np.zeros(3), 1.0)
    with pytest.raises(RuntimeError, match=r"at least one period of 0\.05 s"):
        closed_loop_in_c(program(1e-8), arm, np.zeros(24), 0.0)
