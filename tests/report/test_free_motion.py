"""Releases of an arm that nothing drives: what a name is worth there, and what is proposed."""

import json
from pathlib import Path

import numpy as np
import pytest
from command_support import called
from copied_commands import commands, run
from witness.free_swings import Link

# Link 2 of the shipped gravity arm, with its friction.
MOMENT = 6.743220 * 0.193949 * 9.81
BARE = Link(0.056052 + 6.743220 * 0.193949**2, MOMENT, 0.235819, 0.187307)
SPRUNG = Link(BARE.inertia, MOMENT, BARE.viscous, BARE.coulomb, stiffness=0.1 * MOMENT)
SWINGS = [(SPRUNG, 20), (SPRUNG, 30), (SPRUNG, 40), (SPRUNG, 25), (BARE, 30)]
ARM = ("--arm", "gravity_link2")


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Releases with a spring, and one after it was taken off."""
    path = tmp_path_factory.mktemp("releases")
    for k, (link, angle) in enumerate(SWINGS):
        table = link.swing(np.radians(angle), k)
        np.savetxt(path / f"{k}.csv", table, delimiter=",", header="t,q1", comments="", fmt="%.9g")
    return path


@pytest.mark.parametrize(("test", "helps"), [("3.csv", True), ("4.csv", False)])
def test_a_name_says_what_it_is_worth_on_the_test_release(folder: Path, test: str, helps: bool) -> None:
    """A spring that is there lowers the error of the simulated motion; one that was taken off is left out."""
    train = [word for k in range(3) for word in ("--train", f"{k}.csv")]
    words = ["diagnose", *ARM, *train, "--test", test, "--out", f"out{helps}", "--no-experiment"]
    done = called(*words, cwd=folder)
    assert done.returncode == 0, done.stderr
    found = json.loads((folder / f"out{helps}" / "diagnosis.json").read_text(encoding="utf-8"))
    (cause,), (worth,) = found["causes"], found["error"]["by_cause"]
    assert (cause["effect"], cause["joint"]) == ("spring", 1)
    # alone, a cause is worth what the test record gains over all
    assert worth["gain_percent"] == pytest.approx(found["error"]["overall_gain_percent"], abs=0.1)
    assert (worth["gain_percent"] > 0) == helps
    (confirmed,) = (c for c in cause["checks"] if c["name"] == "confirmed")
    assert confirmed["passed"] == helps
    said = " ".join(done.stdout.split())
    assert ("what was found does not carry over" in said) != helps
    assert "excite" not in said
    first, *rest = commands(folder / f"out{helps}" / "report.html")
    assert first[0] == ("generate" if helps else "refine")
    for line in (first, *rest):
        run(line, folder)
    # what the terminal offers last has the motion from its release on, as the page has
    (replay,) = (line[line.index("modelgen ") :] for line in done.stdout.splitlines() if "simulate" in line)
    scores = json.loads(called(*replay.split()[1:], "--json", cwd=folder).stdout)
    assert scores["joints"][0]["f_gof_percent"] > 90.0
