"""Free swings, whose logs have no effort: the scale is that of the described links."""

from __future__ import annotations

from dataclasses import replace
from math import radians
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner
from witness.free_swings import Link

from modelgen.cli.app import app
from modelgen.description import Arm, load
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.diagnosis.pipeline import diagnose, records
from modelgen.diagnosis.result import Diagnosis
from modelgen.effects import known_effects
from modelgen.errors import InputError

ANGLES = (20, 30, 40)  # deg
# Link 2 of the shipped gravity arm: 6.743220 kg at 0.193949 m, 0.056052 kg m^2 about its centre of mass.
MOMENT = 6.743220 * 0.193949 * 9.81
BARE = Link(0.056052 + 6.743220 * 0.193949**2, MOMENT, 0.235819, 0.187307)
STIFF = 0.1 * MOMENT


@pytest.fixture(scope="module")
def arm(checkout: Path) -> Arm:
    return load(checkout / "arms.yaml", known_effects())["gravity_link2"]


def swings(link: Link, folder: Path, count: float) -> tuple[list[str], str]:
    files: list[str] = []
    for angle in (*ANGLES, *ANGLES, 30):
        file = folder / f"{len(files)}.csv"
        table = link.swing(radians(angle + 0.1 * len(files)), len(files), count=count)
        np.savetxt(file, table, delimiter=",", header="t,q1", comments="", fmt="%.9g")
        files.append(str(file))
    return files[:-1], files[-1]


def diagnosed(arm: Arm, link: Link, folder: Path, count: float = 0.0) -> Diagnosis:
    train, test = swings(link, folder, count)
    return diagnose(arm, records(arm, train, [test], None, USUAL.dataset))


def test_nothing_is_named_where_the_arm_is_as_described(arm: Arm, tmp_path: Path) -> None:
    found = diagnosed(arm, BARE, tmp_path)
    assert found.causes == ()
    # a bearing without a drive has neither poles nor teeth
    made_by_drives = ("torque_ripple", "friction_offset")
    assert not any(r.effect in made_by_drives for turn in found.ranking for r in turn)
    assert found.errors.unit == "rad"
    # the swing as a whole follows the description, with friction fitted: a tenth of a degree
    assert found.errors.before[0] < radians(0.2)
    assert found.parameters["FC1"].value == pytest.approx(BARE.coulomb, rel=0.05)
    assert found.parameters["FV1"].value == pytest.approx(BARE.viscous, rel=0.05)


@pytest.mark.parametrize(("moment", "missing"), [(1.0, False), (1.1, True)])
def test_counts_tell_whether_anything_is_left(arm: Arm, tmp_path: Path, moment: float, missing: bool) -> None:
    """Steps of 4096 to a turn are all the noise there is; a link a tenth heavier leaves more than they do."""
    link = replace(BARE, moment=moment * MOMENT)
    found = diagnosed(arm, link, tmp_path, count=2 * np.pi / 4096)
    assert (found.verdict != "nothing_missing") == missing


def test_spring_with_shifted_rest_and_stiction(arm: Arm, tmp_path: Path) -> None:
    link = replace(BARE, stiffness=STIFF, rest=radians(15), excess=0.15, velocity=0.15)
    found = diagnosed(arm, link, tmp_path)
    assert [(c.effect, c.joint) for c in found.causes] == [("spring", 1), ("stribeck_friction", 1)]
    spring = found.causes[0].parameters
    assert spring["stiffness"].value == pytest.approx(STIFF, rel=0.05)
    assert -spring["preload"].value / spring["stiffness"].value == pytest.approx(radians(15), rel=0.05)
    assert found.errors.gain[0] > 85.0
    spring_share, stiction_share = (
        c.share for c in found.causes
    )  # it bends the whole swing, stiction its end
    assert spring_share.low > 50.0
    assert 0.0 < stiction_share.low < stiction_share.gain < spring_share.gain
    before, after = found.simulation
    assert before is not None
    assert after is not None
    assert after.f_gof[0] > 95.0 > before.f_gof[0]


@pytest.mark.parametrize(("samples", "said"), [(1, "q1 changes by .* as noise does"), (5, "all joints rest")])
def test_a_record_that_noise_alone_moves_is_no_release(
    samples: int, said: str, arm: Arm, tmp_path: Path
) -> None:
    """White noise, and what a sensor's own mean over some samples leaves of it."""
    train, test = swings(BARE, tmp_path, 0.0)
    noise = 1e-3 * np.random.default_rng(7).standard_normal(3000 + samples - 1)
    noise = np.convolve(noise, np.full(samples, 1.0 / samples), mode="valid")
    table = np.column_stack([1e-3 * np.arange(3000), noise])
    np.savetxt(tmp_path / "rests.csv", table, delimiter=",", header="t,q1", comments="", fmt="%.9g")
    with pytest.raises(InputError, match=rf"rests\.csv: {said}"):
        diagnose(arm, records(arm, [train[0], str(tmp_path / "rests.csv")], [test], None, USUAL.dataset))
    with pytest.raises(InputError, match="found one release to train on, expected two or more"):
        records(arm, train[:1], [test], None, USUAL.dataset)


def test_links_without_inertials_give_no_scale(checkout: Path, tmp_path: Path) -> None:
    text = (checkout / "examples/case_studies/dfki_arm.yaml").read_text(encoding="utf-8")
    (tmp_path / "arm.yaml").write_text(text, encoding="utf-8")
    files: list[str] = []
    for k in range(3):
        swing = BARE.swing(0.5, k, length=3.0)
        table = np.column_stack([swing, 0.5 * swing[:, 1]])
        np.savetxt(tmp_path / f"{k}.csv", table, delimiter=",", header="t,q1,q2", comments="", fmt="%.6g")
        files.append(str(tmp_path / f"{k}.csv"))
    call = ["diagnose", str(tmp_path / "arm.yaml"), "--arm", "double_pendulum", "--train", files[0]]
    call += ["--train", files[1], "--test", files[2], "--out", str(tmp_path / "out")]
    result = CliRunner().invoke(app, call)
    assert result.exit_code == 2
    said = " ".join(result.stderr.split())
    assert "link shoulder has no nominal inertials" in said
    assert "no effort column" in said
    assert not (tmp_path / "out").exists()
