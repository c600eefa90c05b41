"""The next experiment: run by an independent plant, it tells causes apart that the records could not."""

import json
import subprocess
import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hidden import arms, logs
from hidden.cases import Bench, Case, Hidden, make
from numpy.random import default_rng

from modelgen.dataset import Record, choose, drives_of, prepare, read
from modelgen.description import Arm, load
from modelgen.diagnosis.candidates.candidate import Candidate, candidates
from modelgen.diagnosis.candidates.fitted import FittedCandidate
from modelgen.diagnosis.candidates.search import Search
from modelgen.diagnosis.equations import Equations, estimated, settings_for, settled_rows
from modelgen.diagnosis.evidence.system import System
from modelgen.diagnosis.experiment.discrimination import Discriminator, Hypothesis, hypothesis
from modelgen.diagnosis.experiment.experiment import Experiment
from modelgen.diagnosis.experiment.motions import Setup, setup
from modelgen.diagnosis.experiment.trajectory import Proposal, propose, worth
from modelgen.diagnosis.options.thresholds import USUAL, ExperimentThresholds
from modelgen.effects import known_effects
from modelgen.evaluation import Evaluator
from modelgen.excitation.problem import problem
from modelgen.excitation.random_motion import feasible
from modelgen.excitation.writing import data
from modelgen.functions import build_model

PERIOD = 10.0  # s
SEED = 90210
Place = tuple[str, int]


class Scene:
    """One arm whose records are those of the plant."""

    def __init__(self, pair: tuple[Place, Place], magnitudes: tuple[float, float], folder: Path) -> None:
        hidden = tuple(Hidden(e, j, 1.1, m) for (e, j), m in zip(pair, magnitudes, strict=True))
        self.bench = Bench(Case("direct2", SEED, hidden, periods=3))
        self.magnitudes, self.pair, self.folder = magnitudes, pair, folder
        folder.mkdir(exist_ok=True)
        arms.write_description(folder / "arms.yaml", "arm", arms.describe(self.bench.arm, default_rng(5)))
        self.arm: Arm = load(folder / "arms.yaml", known_effects())["arm"]
        self.model, self.evaluator = build_model(self.arm), Evaluator(self.arm)

    def record(self, name: str, k: int, true: int) -> Record:
        """Path k of the bench with one member of the pair hidden in it."""
        path = self.folder / f"{name}_{true}.csv"
        logs.write(path, self.bench.record(k, {true: self.magnitudes[true]}))
        return read(str(path), self.arm)

    def small(self, k: int, amplitude: float) -> None:
        """Makes path k smaller about its middle."""
        plant = self.bench.paths[k].copy()
        for name in ("sine", "cosine"):
            plant[name] *= amplitude
        self.bench.paths[k] = plant

    def follow(self, k: int, found: Proposal) -> None:
        """Path k becomes that of a proposal, which is written in motor coordinates."""
        plant = self.bench.paths[k].copy()
        for j, series in enumerate(data(found.excitation)["series"]):
            (ratio,) = drives_of(self.arm)[j].motor(np.ones(1))
            plant["centre"][j] = series["mean"] / ratio
            plant["sine"][j], plant["cosine"][j] = (
                np.array(series["sin"]) / ratio,
                np.array(series["cos"]) / ratio,
            )
        plant["frequency"] = 1.0 / found.excitation.problem.settings.period
        self.bench.paths[k] = plant

    def trials(self, records: list[Record]) -> tuple[list[FittedCandidate], System, Setup]:
        """Both members fitted to the records."""
        chosen = choose(records, settings_for(records, None, USUAL))
        prepared = [prepare(r, chosen) for r in records]
        rows = settled_rows(self.evaluator, self.model, prepared, estimated(self.model, USUAL.equations))
        period = round(PERIOD / records[0].step)
        periods = [period // chosen.factor if period % chosen.factor == 0 else None for _ in records]
        equations = Equations(self.model, self.evaluator, rows, periods, USUAL)
        system = System(equations)
        search = Search(system)
        pool = {(c.effect, c.joint): c for c in candidates(equations)}
        found = [search.trial(pool[place]) for place in self.pair]
        assert found[0] is not None
        assert found[1] is not None
        return [found[0], found[1]], system, setup(self.arm, equations, system.base)


@dataclass(frozen=True)
class Set:
    """Two causes with the magnitudes at which the plant has them. true: which of the two the records hold,
    in motions of `amplitude` of the arm's range and speed.
    """

    pair: tuple[Place, Place]
    magnitudes: tuple[float, float]
    true: int
    amplitude: float


SETS = {
    "offset": Set((("friction_offset", 1), ("asymmetric_viscous_friction", 1)), (0.29, 0.22), 0, 0.3),
    "asymmetric": Set((("friction_offset", 1), ("asymmetric_viscous_friction", 1)), (0.29, 0.22), 1, 0.3),
    "stribeck": Set((("stribeck_friction", 2), ("presliding", 2)), (0.15, 0.005), 0, 0.05),
    "backlash": Set((("backlash", 1), ("joint_flexibility", 1)), (0.17, 0.97), 0, 0.25),
}
CONVINCING = 10.0  # delta BIC: very strong evidence (Kass and Raftery 1995)


def beyond(found: list[FittedCandidate], true: int) -> float:
    """Evidence for the truth over the other."""
    return found[true].gain.delta_bic - found[1 - true].gain.delta_bic


def judged(scene: Scene, true: int) -> tuple[list[FittedCandidate], Setup, Discriminator]:
    """Both members fitted to the record of the scene."""
    found, system, planned = scene.trials([scene.record("old", 0, true)])
    named = [
        np.concatenate([r.columns, c], axis=2) for r, c in zip(system.rows, found[true].columns, strict=True)
    ]
    return (
        found,
        planned,
        Discriminator(System(system.equations, named), system.equations, planned.base),
    )


def proposed(scene: Scene, true: int) -> tuple[float, Proposal]:
    """Evidence that the record of the scene gives for the truth, and the trajectory proposed after it."""
    found, planned, judge = judged(scene, true)
    result = propose(
        planned, judge, [hypothesis(t, ExperimentThresholds()) for t in found], round(PERIOD / planned.step)
    )
    assert result is not None
    return beyond(found, true), result


@pytest.mark.parametrize("name", SETS)
def test_the_plant_on_the_proposed_trajectory_tells_apart_what_its_record_did_not(
    name: str, tmp_path: Path
) -> None:
    case = SETS[name]
    scene = Scene(case.pair, case.magnitudes, tmp_path)
    scene.small(0, case.amplitude)
    before, found = proposed(scene, case.true)
    assert before < CONVINCING
    scene.follow(1, found)
    for truth in (0, 1):
        trials, _, _ = scene.trials([scene.record("new", 1, truth)])
        assert beyond(trials, truth) > CONVINCING


@pytest.mark.parametrize("times", [12, 20])
def test_what_is_expected_of_a_motion_is_what_its_record_tells(times: int, tmp_path: Path) -> None:
    """Also where the causes are so large that the evidence grows no longer with their power."""
    case = SETS["backlash"]
    scene = Scene(case.pair, (times * case.magnitudes[0], times * case.magnitudes[1]), tmp_path)
    found, _, judge = judged(scene, case.true)
    members = [hypothesis(t, ExperimentThresholds()) for t in found]
    expected = judge.evidence(members, judge.system.rows)[case.true, 1 - case.true]
    assert expected == pytest.approx(beyond(found, case.true), rel=0.2)


@pytest.mark.parametrize("beside", [False, True])
def test_a_slow_trajectory_is_worth_as_much_at_a_sixth_of_the_samples(tmp_path: Path, beside: bool) -> None:
    """Also beside a law that changes within fewer samples."""
    case = SETS["offset"]
    found, planned, judge = judged(Scene(case.pair, case.magnitudes, tmp_path), case.true)
    if beside:
        law = Candidate("stribeck_friction", 1, {"exponent": 1.0})
        there = Hypothesis(law, {"velocity": 5.0}, np.array([1.0]), ())
        judge = Discriminator(judge.system, judge.equations, judge.base, [there])
    members = [hypothesis(t, ExperimentThresholds()) for t in found]
    p = problem(planned.arm, planned.settings(round(PERIOD / planned.step)))
    rng = default_rng(3)
    assert planned.coarse.every == 6
    for z in (feasible(p, rng, ExperimentThresholds().limit_margin) for _ in range(5)):
        every, sixth = (worth(s, judge, members, p, z) for s in (planned, planned.coarse))
        assert sixth == pytest.approx(every, rel=0.15)


def test_the_trajectory_keeps_the_limits_and_ends_where_it_begins(tmp_path: Path) -> None:
    case = SETS["offset"]
    scene = Scene(case.pair, case.magnitudes, tmp_path)
    _, found = proposed(scene, case.true)
    made = found.excitation
    period = round(PERIOD * made.problem.settings.rate)
    assert np.abs(np.diff(found.q[[0, period]], axis=0)).max() < 1e-12
    for j, joint in enumerate(scene.arm.joints):
        low, high = joint.limits.position or (-np.inf, np.inf)
        q, t = found.q[:, j], made.t[1] - made.t[0]
        assert low <= q.min()
        assert q.max() <= high
        assert np.abs(np.gradient(q, t)).max() <= joint.limits.velocity
        assert np.abs(np.gradient(np.gradient(q, t), t)).max() <= joint.limits.acceleration


def test_a_trajectory_that_tells_too_little_is_run_more_often(tmp_path: Path) -> None:
    """Evidence grows with the rows: three periods with 5 of it want nine until there are 15."""
    case = SETS["offset"]
    _, found = proposed(Scene(case.pair, case.magnitudes, tmp_path), case.true)
    for evidence, periods in ((5.0, 9), (40.0, 3)):
        table = np.array([[np.nan, evidence], [evidence + 1.0, np.nan]])
        planned = Experiment((), (), replace(found, evidence=table), (), (), USUAL)
        assert planned.periods == periods
        assert f"{periods} times over" in planned.best


@pytest.fixture(scope="module")
def answered(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, dict[str, Any]]:
    """The command line on short records: friction that grows with the load, or a drive that saturates."""
    folder = tmp_path_factory.mktemp("load")
    make(Case("direct2", 31, (Hidden("load_dependent_friction", 2, 1.1, 0.2345),)), folder)
    command = [
        sys.executable,
        "-m",
        "modelgen",
        "diagnose",
        str(folder / "arms.yaml"),
        "--arm",
        "arm",
        "--json",
    ]
    for name in ("train_a", "train_b"):
        command += ["--train", f"{folder / name}.csv@0:10"]
    command += ["--test", str(folder / "test.csv"), "--out", str(folder / "out")]
    done = subprocess.run(command, capture_output=True, text=True, check=True, timeout=200)
    return folder, json.loads(done.stdout)


def test_the_next_experiment_is_in_the_answer_with_its_files(answered: tuple[Path, dict[str, Any]]) -> None:
    folder, answer = answered
    (cause,) = answer["causes"]
    rivals = {(c["effect"], c["joint"]) for c in cause["ambiguous_with"]}
    assert rivals == {("torque_constant_saturation", 2)}
    said = answer["next_experiment"]
    assert {(c["effect"], c["joint"]) for c in said["separates"]} == rivals | {(cause["effect"], 2)}
    trajectory = said["trajectory"]
    assert trajectory["expected_delta_bic"] > cause["ambiguous_with"][0]["delta_bic"]
    assert max(trajectory["limits_used"].values()) <= 1
    table = np.genfromtxt(folder / "out" / trajectory["file"], delimiter=",", names=True)
    points = np.genfromtxt(folder / "out" / trajectory["set_points"], delimiter=",", names=True)
    assert points.dtype.names == ("t", "qm1", "qm2")
    assert np.abs(table["qm2"] - points["qm2"]).max() < 1e-9
    assert abs(points["t"][-1] - trajectory["period_s"]) < 1e-9
    page = (folder / "out" / "report.html").read_text(encoding="utf-8")
    assert "Next experiment" in page
    assert said["do"] in page.replace("&#39;", "'").replace("The trajectory", "the trajectory")


def test_a_payload_tells_load_from_current_better_than_a_motion(
    answered: tuple[Path, dict[str, Any]],
) -> None:
    said = answered[1]["next_experiment"]
    first = said["tests"][0]
    assert "payload" in first["test"]
    assert first["expected_delta_bic"] > said["trajectory"]["expected_delta_bic"]
    assert said["do"] == first["test"]
