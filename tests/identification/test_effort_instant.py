"""When efforts were read is found from the data, whatever the log's convention, or said not to be told."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import made_up_plants as plants
import numpy as np
import pytest
from identification_support import model_of

import modelgen as mg
from modelgen.dataset.processing.instants import EffortInstant
from modelgen.description import loads
from modelgen.effects import known_effects
from modelgen.identification.effort_instant import effort_instant

TWO = """
schema: 1
convention: khalil_kleinfinger
arms:
  two:
    gravity: [0, -9.81, 0]
    joints:
      - {name: shoulder, alpha: 0, d: 0, r: 0, drive: {type: direct, ratio: 50, torque_constant: 0.1},
         effects: [{viscous_friction: {coefficient: 0.002}}, {coulomb_friction: {magnitude: 0.02}}]}
      - {name: elbow, alpha: 0, d: 0.4, r: 0, drive: {type: direct, ratio: 30, torque_constant: 0.05},
         effects: [{viscous_friction: {coefficient: 0.001}}, {coulomb_friction: {magnitude: 0.01}}]}
    links:
      shoulder: {mass: 4, com: [0.2, 0.01, 0], inertia: [0.01, 0, 0, 0.06, 0, 0.06]}
      elbow: {mass: 2, com: [0.15, 0.02, 0], inertia: [0.005, 0, 0, 0.02, 0, 0.02]}
"""
RATE = 200.0
STEP = 1 / RATE
Table = dict[str, np.ndarray]
Law = Callable[[np.ndarray, np.ndarray], np.ndarray]


@pytest.fixture(scope="module")
def arm() -> mg.Arm:
    return loads(TWO, "arms.yaml", known_effects())["two"]


class Motion:
    """A smooth motion of the arm, and the currents that it takes, at any time."""

    def __init__(self, arm: mg.Arm, seed: int) -> None:
        random = np.random.default_rng(seed)
        self.w = 2 * np.pi * np.outer([0.2, 0.7, 1.3, 2.1], [1.0, 1.1])
        self.size, self.phase = random.uniform(0.05, 0.25, self.w.shape), random.uniform(0, 6, self.w.shape)
        model = model_of(arm)
        self.dynamics = model.functions["inverse_dynamics"]
        self.values = np.array(list(model.nominal.values()))
        self.besides: Law | None = None
        self.turns_late = 0.0  # s, dry friction of 0.2 A

    def q(self, t: np.ndarray, order: int = 0) -> np.ndarray:
        angle = t[:, None, None] * self.w + self.phase + order * np.pi / 2
        return np.asarray((self.size * self.w**order * np.sin(angle)).sum(axis=1))

    def current(self, t: np.ndarray) -> np.ndarray:
        q, dq, ddq = (self.q(t, k) for k in range(3))
        more = 0.2 * (np.sign(self.q(t - self.turns_late, 1)) - np.sign(dq))
        if self.besides is not None:
            more = more + self.besides(q, dq)
        return np.asarray(self.dynamics(q=q, dq=dq, ddq=ddq, parameters=self.values)) + more


def log(
    arm: mg.Arm,
    hold: str | float,
    seed: int,
    noise: float = 2e-3,
    late: float = 0.0,
    besides: Law | None = None,
    turns_late: float = 0.0,
    reading_lag: float = 0.0,
) -> Table:
    """20 s of readings of 16 bits. late: samples by which the elbow's current comes later. besides: current
    [A] that the model lacks, by positions and speeds. turns_late: time [s] after which dry friction reverses.
    reading_lag: time constant [s] of a filter through which the currents are read.
    """
    motion, random = Motion(arm, seed), np.random.default_rng(seed)
    motion.besides, motion.turns_late = besides, turns_late
    t = np.arange(int(20 * RATE)) * STEP

    def held(at: np.ndarray) -> np.ndarray:  # the mean over the interval that follows, as a hold has it
        return np.mean([motion.current(at + STEP * (k + 0.5) / 8) for k in range(8)], axis=0)

    at = {"following": held, "previous": lambda t: held(t - STEP), "instant": motion.current}
    made = at[hold] if isinstance(hold, str) else lambda t: motion.current(t + hold)
    current = made(t) if not reading_lag else filtered(made, t, reading_lag)
    if late:
        current[:, 1] = made(t + late * STEP)[:, 1]
    current = current + noise * random.normal(size=current.shape)
    q = 2 * np.pi / 65536 * np.rint(motion.q(t) / (2 * np.pi / 65536))
    return {"t": t, "q1": q[:, 0], "q2": q[:, 1], "i1": current[:, 0], "i2": current[:, 1]}


def filtered(made: Callable[[np.ndarray], np.ndarray], t: np.ndarray, lag: float) -> np.ndarray:
    """What a first-order filter reads: the mean of what was, weighted by how long ago it was."""
    ago = lag * np.linspace(0.0, 10.0, 401)
    weights = np.exp(-ago / lag)
    weights[[0, -1]] /= 2
    return np.asarray(sum(w * made(t - a) for w, a in zip(weights / weights.sum(), ago, strict=True)))


@pytest.mark.parametrize(
    ("hold", "samples"),
    [("following", 0.5), ("instant", 0.0), ("previous", -0.5), (0.8 * STEP, 0.8), (1.3 * STEP, 1.3)],
)
def test_the_convention_of_a_log_is_found(hold: str | float, samples: float, arm: mg.Arm) -> None:
    result = mg.identify(arm, log(arm, hold, 1), log(arm, hold, 2))
    found = result.to_json()["log"]
    about = found["effort_instant"]
    assert about["std_samples"] < 0.05
    assert about["delay_samples"] == pytest.approx(samples, abs=4 * about["std_samples"])
    if isinstance(hold, str):
        assert found["hold"] == about["fits"] == hold
    else:
        assert about["data"] == "found"
        assert found["hold"] == pytest.approx(hold, abs=4 * about["std_samples"] * STEP)
    lines = [x for x in result.shown() if isinstance(x, str) and "the effort counts as" in x]
    assert len(lines) == 1
    # Readings of the right instants leave noise alone: parameters lie within their deviations.
    truth = model_of(arm).nominal
    for name, e in result.parameters.items():
        assert abs(e.value - truth[name]) < 5 * e.std, name


def test_a_diagnosis_finds_the_same_and_names_no_delay(arm: mg.Arm) -> None:
    train, test = [log(arm, "instant", 1), log(arm, "instant", 3)], log(arm, "instant", 2)
    found = mg.diagnose(arm, train, test, experiment=False, effects=["time_delay", "friction_offset"])
    data = found.to_json()
    assert data["log"]["hold"] == "instant"
    assert data["log"]["effort_instant"]["known_from"] == "data"
    assert not data["causes"]
    same = mg.identify(arm, train, test).to_json()["log"]["effort_instant"]
    assert data["log"]["effort_instant"] == same


def test_one_late_joint_is_no_convention_of_the_log(arm: mg.Arm) -> None:
    found = mg.identify(arm, log(arm, "following", 1, late=0.7), log(arm, "following", 2, late=0.7))
    about = found.to_json()["log"]["effort_instant"]
    assert about["hold"] == "following"
    assert about["fits"] is None
    assert about["data"] == "joints_differ"


def test_a_delay_of_several_samples_stays_in_the_log(arm: mg.Arm) -> None:
    found = mg.identify(arm, log(arm, 3 * STEP, 1), log(arm, 3 * STEP, 2)).to_json()["log"]["effort_instant"]
    assert found["hold"] == "following"
    assert found["delay_samples"] == pytest.approx(3.0, abs=0.1)
    assert found["data"] == "beyond_a_sample"


@pytest.mark.parametrize("late", [-12, 7])
def test_efforts_far_from_their_positions_are_asked_about_and_the_hold_that_is_named_mends_them(
    late: int, arm: mg.Arm, tmp_path: Path
) -> None:
    truth = model_of(arm).nominal
    train, test = (log(arm, late * STEP, seed, noise=0.02) for seed in (1, 2))
    found = mg.identify(arm, train, test)
    assert found.to_json()["log"]["effort_instant"]["data"] == "beyond_a_sample"
    (asked,) = (x for x in found.to_json()["doubts"] if "older than" in x)
    assert ("efforts" if late < 0 else "positions") in asked.split(" are ")[0]
    hold = asked.split("`")[1].removeprefix("hold: ")
    assert float(hold) == pytest.approx(late * STEP, abs=0.5 * STEP)
    mended = mg.identify(arm, train, test, mapping=stating(hold, tmp_path))
    assert not [x for x in mended.to_json()["doubts"] if "older than" in x]
    assert mended.to_json()["log"]["effort_instant"]["data"] == "agree"
    for name, e in mended.parameters.items():
        assert abs(e.value - truth[name]) < 5 * e.std, name


def test_one_joint_far_from_its_positions_is_named(arm: mg.Arm) -> None:
    train, test = (log(arm, "following", seed, late=-9.0) for seed in (1, 2))
    (asked,) = (x for x in mg.identify(arm, train, test).to_json()["doubts"] if "older than" in x)
    assert asked.startswith(f"The efforts at {arm.coordinate_names[1]} are")
    assert "hold" not in asked


@pytest.mark.parametrize("names", [("i2",), ("i1",), ("i1", "i2")])
def test_efforts_that_are_very_late_are_asked_about(names: tuple[str, ...]) -> None:
    """By an eighth of a second, many samples of a fast log."""
    rate, late = 500.0, 62
    text = plants.description(2, "{coulomb_friction: {magnitude: 0.01}}")
    subject = loads(text, "arms.yaml", known_effects())["made_up"]

    def table(seed: int) -> Table:
        random = np.random.default_rng(seed)
        t = np.arange(int(16 * rate)) / rate
        q, dq, ddq = plants.motion(t, random.uniform(0, 6.28, (2, len(plants.WAVES))))
        current = plants.PLAIN[2].currents(q, dq, ddq)
        current[:, 1] += 0.01 / plants.CONSTANT[1] * np.sign(dq[:, 1])
        motor = np.rint(q * plants.RATIO / 1e-3) * 1e-3
        made = {"t": t, "qm1": motor[:, 0], "qm2": motor[:, 1], "i1": current[:, 0], "i2": current[:, 1]}
        for name in names:
            made[name] = np.concatenate([np.full(late, made[name][0]), made[name][:-late]])
            made[name] = made[name] + 0.01 * random.normal(size=len(t))
        return made

    asked = [x for x in mg.identify(subject, table(1), table(2)).to_json()["doubts"] if "older than" in x]
    joints = ", ".join(f"j{name[1:]}" for name in names)
    assert len(asked) == 1
    assert asked[0].startswith(f"The efforts at {joints} are")
    assert float(asked[0].split(" are ")[1].split(" ms")[0]) == pytest.approx(1e3 * late / rate, rel=0.1)


def test_what_noise_hides_is_said_to_be_hidden(arm: mg.Arm) -> None:
    result = mg.identify(arm, log(arm, "instant", 1, noise=3.0), log(arm, "instant", 2, noise=3.0))
    about = result.to_json()["log"]["effort_instant"]
    assert about["hold"] == "following"
    assert about["known_from"] == "default"
    assert about["fits"] is None
    assert about["data"] == "cannot_tell"
    assert any("the data cannot tell" in x for x in result.shown() if isinstance(x, str))


def stating(hold: str, folder: Path) -> Path:
    """A mapping file that says `hold`."""
    joints = ", ".join(
        f"{{position: {{column: q{k}, unit: rad}}, effort: {{column: i{k}, unit: A}}}}" for k in (1, 2)
    )
    mapping = folder / "m.yaml"
    mapping.write_text(f"schema: 1\nhold: {hold}\njoints: [{joints}]\n", encoding="utf-8")
    return mapping


@pytest.mark.parametrize("stated", ["instant", "previous"])
def test_what_the_mapping_says_is_used_and_checked(stated: str, arm: mg.Arm, tmp_path: Path) -> None:
    mapping = stating(stated, tmp_path)
    result = mg.identify(arm, log(arm, "instant", 1), log(arm, "instant", 2), mapping=mapping)
    about = result.to_json()["log"]["effort_instant"]
    assert about["hold"] == stated
    assert about["known_from"] == "mapping"
    assert about["fits"] == "instant"
    assert about["data"] == ("agree" if stated == "instant" else "disagree")
    (line,) = [x for x in result.shown() if isinstance(x, str) and "the effort counts as" in x]
    assert ("but the data say" in line) == (stated != "instant")


def test_another_convention_than_the_mapping_says_is_no_cause(arm: mg.Arm, tmp_path: Path) -> None:
    train, test = [log(arm, "instant", 1), log(arm, "instant", 3)], log(arm, "instant", 2)
    mapping = stating("following", tmp_path)
    found = mg.diagnose(
        arm, train, test, mapping=mapping, experiment=False, effects=["time_delay", "friction_offset"]
    )
    data = found.to_json()
    assert data["log"]["effort_instant"]["hold"] == "following"
    assert data["log"]["effort_instant"]["fits"] == "instant"
    assert not data["causes"]
    (suspect,) = data["suspects"]
    assert (suspect["effect"], suspect["joint"]) == ("time_delay", None)
    (check,) = [c for c in suspect["checks"] if c["passed"] is False]
    assert check["name"] == "admissible"
    assert "which a log may have by when it reads them" in check["text"]


def test_a_stream_is_read_as_the_whole_is(arm: mg.Arm, tmp_path: Path) -> None:
    paths = []
    for seed in (1, 2):
        table = log(arm, "instant", seed)
        paths.append(tmp_path / f"{seed}.csv")
        rows = np.column_stack(list(table.values()))
        np.savetxt(paths[-1], rows, delimiter=",", header=",".join(table), comments="")
    whole, streamed = (mg.identify(arm, *map(str, paths), stream=s) for s in (False, True))
    assert streamed.to_json()["log"]["effort_instant"]["hold"] == "instant"
    for name, e in whole.parameters.items():
        assert streamed.parameters[name].value == pytest.approx(e.value, abs=0.1 * e.std)


LACKING: dict[str, Law] = {
    "drag": lambda q, dq: 0.05 * dq * np.abs(dq),
    "stribeck": lambda q, dq: 0.15 * np.sign(dq) * np.exp(-((dq / 0.3) ** 2)),
    "spring": lambda q, dq: 0.15 * np.sin(3 * q),
}


@pytest.mark.parametrize("hold", ["instant", "following"])
@pytest.mark.parametrize("what", LACKING)
def test_its_deviation_holds_what_the_model_lacks(what: str, hold: str, arm: mg.Arm) -> None:
    """Without that it was off by up to four deviations."""
    apart = []
    for seed in (1, 2):
        record = mg.read_log(log(arm, hold, seed, besides=LACKING[what]), arm)
        found = effort_instant([record], arm)
        assert found.fits == hold
        apart.append((found.delay - (0.5 if hold == "following" else 0.0)) / found.std)
    assert np.abs(apart).max() < 2.5


@pytest.mark.parametrize("turns_late", [0.01, 0.03])
def test_friction_that_turns_late_is_no_delay_of_the_efforts(turns_late: float, arm: mg.Arm) -> None:
    """A joint that creeps before it goes, as in MuJoCo: without that law it was off by up to four."""
    for seed in (1, 2):
        found = effort_instant([mg.read_log(log(arm, "instant", seed, turns_late=turns_late), arm)], arm)
        assert abs(found.delay) < 2.5 * found.std


def test_free_laws_cost_nothing_where_the_model_is_complete(arm: mg.Arm) -> None:
    found = effort_instant([mg.read_log(log(arm, "instant", 1), arm)], arm)
    assert found.std < 0.003


OF_THE_OTHER_JOINT: dict[str, Law] = {
    "friction": lambda q, dq: np.sign(dq[:, ::-1]),
    "drag": lambda q, dq: 0.3 * dq[:, ::-1],
}


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize("what", OF_THE_OTHER_JOINT)
def test_a_delay_that_stands_for_what_the_model_lacks_is_not_given(what: str, seed: int, arm: mg.Arm) -> None:
    """Of some samples, with a deviation of a tenth of one, it leaves most of what is left without it."""
    found = effort_instant(
        [mg.read_log(log(arm, "following", seed, besides=OF_THE_OTHER_JOINT[what]), arm)], arm
    )
    assert found is not None
    said = found.to_json()
    assert said.keys() >= {"hold", "known_from", "delay_samples", "std_samples", "fits", "data"}
    assert (said["hold"], said["fits"], said["data"]) == ("following", None, "cannot_tell")
    assert said["delay_samples"] is said["std_samples"] is None
    assert found.line().endswith("; the data cannot tell while the model lacks causes")
    assert found.questions() == ()


@pytest.mark.parametrize("what", LACKING)
def test_a_true_delay_is_given_beside_what_the_model_lacks(what: str, arm: mg.Arm) -> None:
    record = mg.read_log(log(arm, -12 * STEP, 1, besides=LACKING[what]), arm)
    found = effort_instant([record], arm)
    assert found.to_json()["data"] == "beyond_a_sample"
    assert found.delay == pytest.approx(-12.0, abs=0.1)
    assert len(found.questions()) == 1


def test_what_identify_cannot_tell_a_diagnosis_finds_in_its_own_band(
    arm: mg.Arm, monkeypatch: pytest.MonkeyPatch
) -> None:
    unknown = EffortInstant("following", "", STEP)
    monkeypatch.setattr("modelgen.diagnosis.equations.study.effort_instant", lambda *_: unknown)
    a, b, c = (log(arm, "instant", seed) for seed in (1, 2, 3))
    data = mg.diagnose(arm, train=[a, b], test=c, experiment=False).to_json()
    assert not data["causes"]
    assert not data["suspects"]
    instant = data["log"]["effort_instant"]
    assert (instant["hold"], instant["data"]) == ("instant", "found")
    assert abs(instant["delay_samples"]) < 0.02


def test_currents_that_are_read_through_a_filter_lag_and_no_joint_is_elastic(arm: mg.Arm) -> None:
    """A pure delay leaves what looks like springs in the drives. Half a sample of the lag is the hold's."""
    a, b, c = (log(arm, "instant", seed, reading_lag=0.02) for seed in (1, 2, 3))
    data = mg.diagnose(arm, train=[a, b], test=c, experiment=False).to_json()
    (cause,) = data["causes"]
    assert (cause["effect"], cause["joint"]) == ("time_delay", None)
    assert cause["parameters"]["order"]["value"] == 1.0
    assert cause["parameters"]["delay"]["value"] == pytest.approx(-0.02 - STEP / 2, rel=0.03)
    assert not data["suspects"]
