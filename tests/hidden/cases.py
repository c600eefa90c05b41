"""A case: an arm, records of it, and what is hidden in it, all drawn from a seed."""

from __future__ import annotations

import json
import math
import zlib
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.random import Generator, default_rng

from hidden import arms, fitting, logs, native, trajectories
from hidden.arms import Arm
from hidden.effects import EFFECTS, OUTSIDE, Scales, Site, joints_for, scales
from hidden.logs import Log
from hidden.native import Array, Plant, PlantError

RECORDS = ("train_a", "train_b", "test", "check", "train_c", "train_d", "train_e", "train_f")
TEST, CHECK = RECORDS.index("test"), RECORDS.index("check")
ROTATED = (0, 1, TEST)  # by which a strength is measured, however many records train
TRAIN = 2
FINE, COARSE = 0.25e-3, 0.5e-3  # s, longest step of the integrator with and without contacts
TRIES = 10
SMALL = 1e-3  # magnitude


@dataclass(frozen=True)
class Hidden:
    """One hidden effect. joint counts from 1. strength: wanted; magnitude: known from before, or None.

    carried: see Site.
    """

    effect: str
    joint: int
    strength: float
    magnitude: float | None = None
    carried: bool = False


@dataclass(frozen=True)
class Case:
    """What is drawn. encoder: motor, joint (20 bits) or coarse (14 bits, joint side). train: 2 to 6."""

    arm: str
    seed: int
    hidden: tuple[Hidden, ...] = ()
    encoder: str = "motor"
    rate: float = 500.0
    periods: int = 3
    noise: float = 1.0
    name: str = "arm"
    dry: float = 1.0  # times the usual dry friction
    train: int = TRAIN

    @property
    def training(self) -> list[int]:
        """Numbers of the training records: the first ones are the same whatever their count."""
        return [k for k in range(len(RECORDS)) if k not in (TEST, CHECK)][: self.train]

    @property
    def records(self) -> list[int]:
        """Numbers of all records."""
        return sorted([*self.training, TEST, CHECK])


@dataclass(frozen=True)
class Label:
    """The truth about a case. strength: reached, by effect. floor, with_effect: RMSE (n,) on test.

    shown: what the training records say for the effects, twice the logarithm of a likelihood ratio; nan
    without noise on the current, and of free motions, whose noise is that of their positions.
    """

    case: dict[str, Any]
    strength: list[float]
    magnitude: list[float]
    floor: list[float]
    with_effect: list[float]
    shown: float = 0.0


def _random(case: Case, *more: int) -> Generator:
    return default_rng([case.seed, zlib.crc32(case.arm.encode()), *more])


class Bench:
    """Arm and trajectories of a case, and records of it with any effects at any magnitudes."""

    def __init__(self, case: Case) -> None:
        self.case = case
        self.arm: Arm = arms.draw(case.arm, _random(case, 1))
        self.arm.plant["dry"] *= case.dry
        self._encoders(self.arm.plant)
        if any(EFFECTS[hidden.effect].fine for hidden in case.hidden):
            # The speed loop is tuned for one inertia: slower, where a spring parts it in two.
            for gain, value in (("position_gain", 8.0), ("speed_gain", 16.0), ("integral_gain", 60.0)):
                self.arm.plant[gain] = value
        free = case.arm in arms.FREE
        self.paths: dict[int, Plant] = {
            k: self._release(k) if free else trajectories.draw(self.arm, _random(case, 2, k))
            for k in case.records
        }
        self.duration = case.periods / float(self.arm.plant["frequency"])
        q, _, current, _ = native.simulate(self.paths[0], case.rate, self.duration, self._substeps([]))
        times = np.linspace(0.0, 1.0 / float(self.arm.plant["frequency"]), 500)
        # not of further training records: the same effect, whatever their count
        walked = [q] if free else [trajectories.motion(self.paths[k], times)[0] for k in (*ROTATED, CHECK)]
        self.scales: Scales = scales(self.arm.plant, q, current, case.rate, walked)
        self._sizes: dict[int, Array] = {}
        self._records: dict[tuple[int, tuple[tuple[int, float], ...], bool], Log] = {}

    def _encoders(self, plant: Plant) -> None:
        bits = {"motor": None, "joint": 20, "coarse": 14}[self.case.encoder]
        if bits is not None:
            plant["joint_side"][: self.arm.n] = 1.0
            plant["count"][: self.arm.n] = 2 * math.pi / 2**bits

    def _release(self, k: int) -> Plant:
        """Let go at an angle from which no joint swings beyond its limits: no arm turns over its top."""
        duration = self.case.periods / float(self.arm.plant["frequency"])
        for attempt in range(20):
            random = _random(self.case, 2, k, *([attempt] if attempt else []))
            plant = self.arm.plant.copy()
            plant["free"] = 1.0
            for j in range(self.arm.n):
                most = self.arm.position[j][1] * 0.9**attempt
                plant["q0"][j] = random.uniform(0.6, 1.0) * most * random.choice((-1.0, 1.0))
            steps, noise = self._substeps([]), _random(self.case, 4, k)
            taken = logs.take(plant, self.case.rate, duration, noise, steps, np.zeros(self.arm.n))
            q = logs.joints_of(taken, plant)
            if all(
                low <= q[:, j].min() and q[:, j].max() <= high
                for j, (low, high) in enumerate(self.arm.position)
            ):
                return plant
        raise PlantError(f"{self.case.arm} swings beyond its limits from every angle drawn")

    def _substeps(self, hidden: list[str]) -> int:
        longest = FINE if any(EFFECTS[name].fine for name in hidden) else COARSE
        return max(1, math.ceil(1.0 / self.case.rate / longest - 1e-9))

    def record(self, k: int, magnitudes: dict[int, float], noisy: bool = True) -> Log:
        """Record k with effects of the case, by their place in its list, at these magnitudes.

        noisy: with noise on the current. Each is simulated once.
        """
        key = k, tuple(sorted(magnitudes.items())), noisy
        if key not in self._records:
            self._records[key] = self._simulated(k, magnitudes, noisy)
        return self._records[key]

    def _simulated(self, k: int, magnitudes: dict[int, float], noisy: bool) -> Log:
        case, plant = self.case, self.arm.plant.copy()
        names = [case.hidden[place].effect for place in magnitudes]
        for place, magnitude in magnitudes.items():
            hidden = case.hidden[place]
            if EFFECTS[hidden.effect].later and k == 0:
                continue
            random = _random(case, 3, place)
            site = Site(self.arm, hidden.joint - 1, self.scales, random, hidden.carried)
            EFFECTS[hidden.effect].put(plant, site, magnitude)
        plant = trajectories.carry_over(self.paths[k], plant)
        steps = self._substeps(names)
        size = self.noise_scale(k) if noisy else np.zeros(self.arm.n)
        return logs.take(plant, case.rate, self.duration, _random(case, 4, k), steps, size)

    def noise_scale(self, k: int) -> Array:
        """RMS (n,) [A] of the current that record k takes without effects: an effect makes no noise."""
        if k not in self._sizes:
            steps = self._substeps([])
            current = native.simulate(self.paths[k], self.case.rate, self.duration, steps)[2]
            self._sizes[k] = self.case.noise * np.sqrt((current**2).mean(axis=0))
        return self._sizes[k]

    def errors(self, magnitudes: dict[int, float]) -> Array:
        """RMSE (n,) on records that the fit has not seen: train_a, train_b and test, each in its turn.

        With an effect that comes after train_a, on test alone. With one from outside the catalogue, what no
        spring and no constant current at any joint takes up: a hose that is taut throughout is a spring.
        """
        kinds = [EFFECTS[hidden.effect] for hidden in self.case.hidden]
        held_out = (TEST,) if any(kind.later for kind in kinds) else ROTATED
        return fitting.rotated(
            [self.record(k, magnitudes) for k in ROTATED],
            self.arm.plant,
            held_out,
            pulled=any(kind.outside for kind in kinds),
        )

    def strength(self, place: int, floor: Array, found: Array) -> float:
        """Error with over without, on the joint the effect sits at, or on the joint that shows it most."""
        hidden = self.case.hidden[place]
        ratio = found / floor
        return float(ratio.max() if EFFECTS[hidden.effect].whole else ratio[hidden.joint - 1])

    def tune(self, place: int, floor: Array) -> tuple[float, float]:
        """Magnitude at which the effect, alone, has the strength wanted; and the strength it has."""
        wanted = self.case.hidden[place].strength
        goal, close = math.log(wanted**2 - 1.0), 0.05
        tried: list[tuple[float, float]] = []
        best = (math.inf, 1.0, 1.0)
        at = math.log(0.3)
        for _ in range(TRIES):
            try:
                found = self.strength(place, floor, self.errors({place: math.exp(at)}))
                value = math.log(max(found**2 - 1.0, 1e-4))
            except PlantError:
                found, value = math.inf, 6.0
            tried.append((at, value))
            best = min(best, (abs(value - goal), math.exp(at), found))
            if best[0] < close:
                break
            at = min(math.log(EFFECTS[self.case.hidden[place].effect].most), _next(tried, goal))
        return best[1], best[2]


def _next(tried: list[tuple[float, float]], goal: float) -> float:
    """Log magnitude to try next: within a bracket where there is one, else by a square law."""
    at, value = tried[-1]
    below = [item for item in tried if item[1] < goal]
    above = [item for item in tried if item[1] >= goal]
    if below and above:
        low, high = max(below), min(above, key=lambda item: item[0])
        share = (goal - low[1]) / (high[1] - low[1]) if high[1] > low[1] else 0.5
        nxt = low[0] + min(0.85, max(0.15, share)) * (high[0] - low[0])
    else:
        nxt = at + max(-2.5, min(2.5, (goal - value) / 2.0))
    return max(math.log(SMALL), nxt)


def make(case: Case, folder: Path) -> Label:
    """Writes arms.yaml and the case's records as CSV into the folder.

    Raises PlantError where an effect cannot sit at that joint of that arm.
    """
    bench = Bench(case)
    for hidden in case.hidden:
        if hidden.effect not in EFFECTS:
            raise PlantError(f"no effect {hidden.effect!r}; there are {', '.join(EFFECTS)}")
        possible = [j + 1 for j in joints_for(hidden.effect, bench.arm)]
        if hidden.joint not in possible:
            raise PlantError(f"{hidden.effect} sits at joint {possible} of {case.arm}, not {hidden.joint}")
    folder.mkdir(parents=True, exist_ok=True)
    floor = bench.errors({})
    magnitudes, strengths = {}, []
    for place, hidden in enumerate(case.hidden):
        if hidden.magnitude is not None:
            magnitudes[place] = hidden.magnitude
            strengths.append(math.nan)
        else:
            magnitudes[place], reached = bench.tune(place, floor)
            strengths.append(reached)
    kept = {k: bench.record(k, magnitudes) for k in case.records}
    if len(case.hidden) == 1:
        strengths = [bench.strength(0, floor, bench.errors(magnitudes))]
    for k, log in kept.items():
        logs.write(folder / f"{RECORDS[k]}.csv", log)
    free = case.arm in arms.FREE
    entry = arms.describe(bench.arm, _random(case, 5), exact_links=free)
    arms.write_description(folder / "arms.yaml", case.name, entry)
    clean = {k: bench.record(k, {}) for k in ROTATED}
    return Label(
        asdict(case),
        strengths,
        [magnitudes[place] for place in range(len(case.hidden))],
        _test(bench, clean),
        _test(bench, kept),
        math.nan if free or not case.noise else _shown(bench, magnitudes),
    )


def _test(bench: Bench, records: dict[int, Log]) -> list[float]:
    rotated = fitting.rotated([records[k] for k in ROTATED], bench.arm.plant, (TEST,))
    return [float(value) for value in rotated]


def _shown(bench: Bench, magnitudes: dict[int, float]) -> float:
    if not magnitudes:
        return 0.0
    numbers = bench.case.training
    records = [[bench.record(k, by, noisy=False) for k in numbers] for by in (magnitudes, {})]
    return fitting.shown(*records, [bench.noise_scale(k) for k in numbers], bench.arm.plant)


def seal(label: Label, path: Path) -> None:
    """The label, packed: nothing that reads text comes across it."""
    path.write_bytes(zlib.compress(json.dumps(asdict(label)).encode()))


def unseal(path: Path) -> Label:
    """The label that was sealed."""
    data: dict[str, Any] = json.loads(zlib.decompress(path.read_bytes()))
    case = data["case"]
    case["hidden"] = tuple(case["hidden"])
    return Label(**data)


def kind(label: Label) -> str:
    """null, single, pair or outside."""
    names = [hidden["effect"] for hidden in label.case["hidden"]]
    if any(name in OUTSIDE for name in names):
        return "outside"
    return ("null", "single", "pair")[len(names)]
