"""Positions of a joint that are older than the rest of a log, alone or with its efforts, are asked about."""

from __future__ import annotations

from collections.abc import Callable

import made_up_plants as plants
import mujoco_arm
import numpy as np
import pytest

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects
from modelgen.identification.effort_instant import effort_instant

RATE, SECONDS = 500.0, 16.0
FRICTION = (0.35, 0.22)  # A
POSITIONS, EFFORTS, BOTH = (1, 0), (0, 1), (1, 1)  # which channels of the joint are late
WHAT = {POSITIONS: "positions", BOTH: "positions and efforts"}
Table = dict[str, np.ndarray]
Law = Callable[[np.ndarray, np.ndarray], np.ndarray]


@pytest.fixture(scope="module")
def arm() -> mg.Arm:
    """The planar arm, with dry friction at both joints."""
    text = plants.description(2, "{coulomb_friction: {magnitude: 0.011}}")
    first = f"{{drive_inertia: {{inertia: {plants.ROTOR[0]}}}}}"
    text = text.replace(first, first + ", {coulomb_friction: {magnitude: 0.021}}")
    return loads(text, "arms.yaml", known_effects())["made_up"]


def log(
    seed: int,
    joint: int = 0,
    late: tuple[int, int] = (0, 0),
    samples: float = 0.0,
    rate: float = RATE,
    besides: Law | None = None,
    ordinary: bool = False,
) -> Table:
    """A log by Lagrange's equations, efforts at the positions' instants. late: whether a joint's position and
    its effort are so many samples older. besides: current [A] that the model lacks. ordinary: a motion that
    does not repeat.
    """
    random = np.random.default_rng(seed)
    t = np.arange(int(rate * SECONDS)) / rate
    phase = random.uniform(0, 6.28, (2, len(plants.WAVES)))

    def state(at: np.ndarray) -> plants.Motion:
        q, dq, ddq = plants.motion(at, phase)
        if ordinary:  # each joint slowly away from its middle besides
            more = 0.3 * np.sin(0.37 * at[:, None] + phase[:, 0])
            q, ddq = q + more, ddq - 0.37**2 * more
            dq = dq + 0.3 * 0.37 * np.cos(0.37 * at[:, None] + phase[:, 0])
        return q, dq, ddq

    def efforts(at: np.ndarray) -> np.ndarray:
        q, dq, ddq = state(at)
        found = plants.PLAIN[2].currents(q, dq, ddq) + FRICTION * np.sign(dq)
        return found if besides is None else found + besides(q, dq)

    q, current = state(t)[0], efforts(t)
    then = t - samples / rate
    if late[0]:
        q[:, joint] = state(then)[0][:, joint]
    if late[1]:
        current[:, joint] = efforts(then)[:, joint]
    current = current + 0.01 * random.normal(size=q.shape)
    motor = np.rint(q * plants.RATIO / 1e-3) * 1e-3
    return {"t": t, "qm1": motor[:, 0], "qm2": motor[:, 1], "i1": current[:, 0], "i2": current[:, 1]}


def questions(found: mg.Identification | mg.Diagnosis) -> list[str]:
    return [x for x in found.to_json()["doubts"] if "than all other channels" in x]


@pytest.mark.parametrize("samples", [5, 10, 20, 50, 80])
@pytest.mark.parametrize("late", [POSITIONS, BOTH])
@pytest.mark.parametrize("joint", [0, 1])
def test_a_late_joint_is_named_with_its_delay(
    joint: int, late: tuple[int, int], samples: int, arm: mg.Arm
) -> None:
    train, test = (log(seed, joint, late, samples) for seed in (1, 2))
    found, sound = mg.identify(arm, train, test), mg.identify(arm, log(1), log(2))
    off = [abs(e.value - sound.parameters[name].value) / e.std for name, e in found.parameters.items()]
    assert max(off) > 3.0  # without a word it would be silent
    (asked,) = questions(found)
    assert asked.startswith(f"The {WHAT[late]} at j{joint + 1} are ")
    said, deviation = asked.split("(")[1].split(" samples")[0].split(" ± ")
    assert float(said) == pytest.approx(samples, abs=max(0.5, 3 * float(deviation)))
    assert float(deviation) <= 0.4 * samples
    assert "older than all other channels" in asked
    assert found.to_json()["log"]["effort_instant"]["data"] == "joints_differ"


@pytest.mark.parametrize("samples", [2, 3])
@pytest.mark.parametrize("late", [POSITIONS, BOTH])
@pytest.mark.parametrize("joint", [0, 1])
def test_positions_that_are_late_by_few_samples_are_asked_about(
    joint: int, late: tuple[int, int], samples: int, arm: mg.Arm
) -> None:
    records = [mg.read_log(log(seed, joint, late, samples, rate=100.0), arm) for seed in (1, 2)]
    found = effort_instant(records, arm)
    assert found is not None
    (x,) = found.channels
    assert (x.name, x.what) == (f"j{joint + 1}", WHAT[late])
    assert x.samples == pytest.approx(samples, abs=3 * x.deviation)
    assert x.deviation < 0.3


def test_the_rows_that_it_says_mend_the_log(arm: mg.Arm) -> None:
    def moved(table: Table, rows: int) -> Table:
        return {name: x[rows:] if name == "qm2" else x[: len(x) - rows] for name, x in table.items()}

    train, test = (log(seed, 1, POSITIONS, 20) for seed in (1, 2))
    (asked,) = questions(mg.identify(arm, train, test))
    rows = int(asked.split(" up by ")[1].split(" rows")[0])
    mended, sound = mg.identify(arm, moved(train, rows), moved(test, rows)), mg.identify(arm, log(1), log(2))
    assert not questions(mended)
    for name, e in mended.parameters.items():
        assert abs(e.value - sound.parameters[name].value) < 5 * e.std, name


@pytest.mark.parametrize("samples", [2, 3, 4])
@pytest.mark.parametrize("joint", [0, 1])
def test_efforts_of_a_joint_that_are_late_by_few_samples_are_asked_about(
    joint: int, samples: int, arm: mg.Arm
) -> None:
    found = mg.identify(arm, *(log(seed, joint, EFFORTS, samples) for seed in (1, 2)))
    (asked,) = (x for x in found.to_json()["doubts"] if "older than" in x)
    assert asked.startswith(f"The efforts at j{joint + 1} are ")
    said, deviation = asked.split("(")[1].split(" samples")[0].split(" ± ")
    assert float(said) == pytest.approx(samples, abs=max(0.2, 4 * float(deviation)))


@pytest.mark.parametrize("joint", [0, 1])
def test_efforts_that_are_late_say_nothing_of_the_others(joint: int, arm: mg.Arm) -> None:
    found = effort_instant([mg.read_log(log(seed, joint, EFFORTS, 3), arm) for seed in (1, 2)], arm)
    assert found is not None
    assert (found.hold, found.known) == ("instant", "data")
    ((name, delay, deviation),) = found.late
    assert name == f"j{joint + 1}"
    assert delay == pytest.approx(-3.0, abs=4 * deviation)


LACKING: dict[str, Law] = {
    "drag": lambda q, dq: 0.05 * dq * np.abs(dq),
    "stribeck": lambda q, dq: 0.15 * np.sign(dq) * np.exp(-((dq / 0.2) ** 2)),
    "spring": lambda q, dq: 0.15 * np.sin(3 * q),
    "of the other joint": lambda q, dq: 0.1 * np.sign(dq[:, ::-1]),
    "of its own load": lambda q, dq: 0.15 * np.sign(dq) * np.abs(np.sin(q)),
}
# Seeds in which delays far away fit as well as no delays do.
MISLED = [("spring", 1000.0, 22), ("spring", 1000.0, 25), ("of its own load", 1000.0, 23)]
MISLED += [
    ("of its own load", 250.0, 34),
    ("of the other joint", 100.0, 32),
    ("of the other joint", 100.0, 34),
]


@pytest.mark.parametrize("rate", [100.0, 500.0])
@pytest.mark.parametrize("ordinary", [False, True])
@pytest.mark.parametrize("what", ["nothing", *LACKING])
def test_nothing_is_said_of_sound_channels(what: str, ordinary: bool, rate: float, arm: mg.Arm) -> None:
    for seed in (3, 4):
        table = log(seed, rate=rate, besides=LACKING.get(what), ordinary=ordinary)
        found = effort_instant([mg.read_log(table, arm)], arm)
        assert found is not None
        assert not found.channels
        assert not found.late


@pytest.mark.parametrize(("what", "rate", "seed"), MISLED)
def test_delays_that_fit_far_away_are_not_believed(what: str, rate: float, seed: int, arm: mg.Arm) -> None:
    found = effort_instant([mg.read_log(log(seed, rate=rate, besides=LACKING[what]), arm)], arm)
    assert found is not None
    assert not found.channels


@pytest.mark.parametrize("stiffness", [0.5, 2.0])
@pytest.mark.parametrize("seed", range(4))
def test_a_spring_that_the_model_lacks_is_no_delay(seed: int, stiffness: float, arm: mg.Arm) -> None:
    def spring(q: np.ndarray, _: np.ndarray) -> np.ndarray:
        return stiffness * (q - 0.3) * [0.0, 1.0]

    found = effort_instant([mg.read_log(log(seed, rate=200.0, besides=spring), arm)], arm)
    assert found is not None
    assert not found.channels
    assert not found.late


def test_a_late_joint_is_named_beside_what_the_model_lacks(arm: mg.Arm) -> None:
    for law in (LACKING["drag"], LACKING["stribeck"], LACKING["spring"]):
        found = effort_instant([mg.read_log(log(1, 1, POSITIONS, 20, besides=law), arm)], arm)
        assert found is not None
        assert [(x.name, x.what) for x in found.channels] == [("j2", "positions")]


@pytest.mark.parametrize("which", [("qm2",), ("qm3", "i3")])
def test_an_arm_of_three_joints_in_mujoco(which: tuple[str, ...]) -> None:
    subject = loads(mujoco_arm.description(), "arms.yaml", known_effects())["arm"]
    table = mujoco_arm.log(1)
    sound = effort_instant([mg.read_log(table, subject)], subject)
    assert sound is not None
    assert not sound.channels
    rows = 10
    delayed = {name: x[:-rows] if name in which else x[rows:] for name, x in table.items()}
    found = effort_instant([mg.read_log(delayed, subject)], subject)
    assert found is not None
    (channel,) = found.channels
    assert channel.name == f"j{which[0][-1]}"
    assert channel.what == ("positions" if len(which) == 1 else "positions and efforts")
    assert channel.samples == pytest.approx(rows, abs=max(1.0, 3 * channel.deviation))


def test_inspect_and_diagnose_say_it_too(arm: mg.Arm) -> None:
    train, test = (log(seed, 1, POSITIONS, 20) for seed in (1, 2))
    shown = [x for x in mg.inspect_log(train, arm).shown() if isinstance(x, str)]
    assert sum("The positions at j2 are" in x for x in shown) == 1
    found = mg.diagnose(arm, train, test, experiment=False, effects=["friction_offset"])
    (asked,) = questions(found)
    assert asked.startswith("The positions at j2 are")
    assert found.next_steps("found")[0][0] == asked
