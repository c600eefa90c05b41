"""The plant of family B obeys mechanics, and hides what it says, as strong as it says."""

from __future__ import annotations

import importlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from blind.case import csv
from blind.family_b import KINDS, equations, fit, kernel, make, world
from blind.family_b.logger import Record
from blind.family_b.plan import Plan
from blind.family_b.world import World

from modelgen.api.description import load_arms
from modelgen.api.identification import identify

maker = importlib.import_module("blind.family_b.make")
REST = {"limit": 1e9, "inductance": 1e-3, "resistance": 1.0, "voltage": 1e9, "filter": 1.0}


def bare(one: World, **values: float) -> World:
    """The arm without friction and with its motors off; `values` of all joints."""
    gone = {"coulomb": 0.0, "viscous": 0.0, "kp": 0.0, "kv": 0.0, "ki": 0.0, "kt": 0.0}
    for number in range(1, len(one.axes) + 1):
        one = one.joint(number, **{**gone, **values})
    return one


def swing(one: World, seconds: float = 2.0, speed: float = 1.0) -> tuple[np.ndarray, np.ndarray]:
    """Angles (N, 3) after a push, and the energy (N - 2) by the links' poses alone."""
    start = np.concatenate([one.centre, speed * np.array([0.0 if one.arm["locked"] else 1.0, 1.0, -1.0])])
    log, _ = kernel.run(one.arm, list(one.joints), np.zeros((int(seconds / kernel.TICK), 6)), start=start)
    return log[:, :3], energy(one, log[:, :3])


def poses(one: World, q: np.ndarray) -> list[tuple[np.ndarray, np.ndarray]]:
    """Rotation and origin of each link over samples, by modified Denavit-Hartenberg parameters."""
    alpha, d = (0.0, np.pi / 2, 0.0), (0.0, one.arm["offset"], one.arm["length"])
    r, p = np.tile(np.eye(3), (len(q), 1, 1)), np.zeros((len(q), 3))
    out = []
    for k in range(3):
        p = p + r[:, :, 0] * d[k]
        c, s = np.cos(alpha[k]), np.sin(alpha[k])
        r = r @ np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
        c, s, z, i = np.cos(q[:, k]), np.sin(q[:, k]), np.zeros(len(q)), np.ones(len(q))
        r = r @ np.stack([c, -s, z, s, c, z, z, z, i], axis=1).reshape(-1, 3, 3)
        out.append((r, p))
    return out


def potential(one: World, q: np.ndarray) -> np.ndarray:
    """Energy of the weights (N)."""
    g = np.array([one.arm.get(k, 0.0) for k in ("gx", "gy", "gz")])
    return -sum(
        b.mass * (p + r @ np.array([b.x, b.y, 0.0])) @ g
        for b, (r, p) in zip(one.bodies, poses(one, q), strict=True)
    )


def energy(one: World, q: np.ndarray) -> np.ndarray:
    """Kinetic and potential energy (N - 2), rates by differences of poses, not by the plant."""
    total = potential(one, q)[1:-1]
    h = 2 * kernel.STEP
    for b, (r, p) in zip(one.bodies, poses(one, q), strict=True):
        com = p + r @ np.array([b.x, b.y, 0.0])
        v = (com[2:] - com[:-2]) / h
        spin = np.swapaxes(r[1:-1], 1, 2) @ (r[2:] - r[:-2]) / h
        w = np.stack([spin[:, 2, 1], spin[:, 0, 2], spin[:, 1, 0]], axis=1)
        total = total + 0.5 * b.mass * (v**2).sum(axis=1)
        total = total + 0.5 * w**2 @ np.array([b.along, b.across, b.turn])
    for axis, joint in enumerate(one.joints):
        m = equations.motor(joint, q[:, axis])[0]
        if axis or not one.arm["locked"]:
            total = total + 0.5 * joint["inertia"] * ((m[2:] - m[:-2]) / h) ** 2
    return total


def drawn(shape: str, seed: int = 5) -> World:
    return world.draw(np.random.default_rng(seed), shape)


@pytest.mark.parametrize("shape", world.SHAPES)
def test_energy_is_kept_without_friction(shape: str) -> None:
    one = bare(drawn(shape))
    q, e = swing(one, 1.0 if "levered" in shape else 3.0, 0.4 if "levered" in shape else 1.0)
    assert np.ptp(q, axis=0)[1:].min() > 0.1
    assert np.ptp(e) < 2e-4 * np.ptp(potential(one, q))


def test_a_spring_and_a_payload_store_energy_and_lose_none() -> None:
    one = bare(drawn("spatial"), spring=30.0, preload=-5.0)
    mass, x, y = 1.5, 0.2, 0.03
    loaded, _ = kernel.run(
        equations.carrying(one.arm, (mass, x, y)), list(one.joints), np.zeros((2000, 6)),
        start=np.concatenate([one.centre, [0.5, 1, -1]]),
    )  # fmt: skip
    q = loaded[:, :3]
    r, p = poses(one, q)[2]
    point = p + r @ np.array([x, y, 0.0])
    v = (point[2:] - point[:-2]) / (2 * kernel.STEP)
    more = 0.5 * mass * (v**2).sum(axis=1) + mass * 9.81 * point[1:-1, 2]
    total = energy(one, q) + more + (15.0 * q**2 - 5.0 * q)[1:-1].sum(axis=1)
    assert one.arm["gz"] == -9.81
    assert np.ptp(total) < 2e-4 * np.ptp(more)


FRICTIONS: dict[str, dict[str, float]] = {
    "coulomb": {"coulomb": 0.02},
    "viscous": {"viscous": 2e-4},
    "stribeck": {"excess": 0.03, "sped": 50.0, "shape": 1.0},
    "load": {"load": 0.1},
    "power": {"power": 0.01, "power_scale": 30.0, "exponent": 2.0},
    "dahl": {"bristle": 0.02, "distance": 0.05},
    "maxwell": {"bristle": 0.02, "distance": 0.05, "slip": 1.0},
    "warm": {"cold_dry": 0.02, "warm_time": 5.0, "warm_speed": 50.0},
}


@pytest.mark.parametrize("law", FRICTIONS)
def test_friction_dissipates(law: str) -> None:
    _, e = swing(bare(drawn("planar"), **FRICTIONS[law]))
    stored = 0.02 * 0.05 * 2 if law in ("dahl", "maxwell") else 0.0  # bristles give back what they hold
    assert e[-1] < e[0] - 0.05
    assert np.max(e - np.minimum.accumulate(e)) < stored + 2e-3 * (e[0] - e[-1])


def test_drag_dissipates() -> None:
    _, e = swing(bare(drawn("spatial")).whole(drag2=5.0, drag3=5.0))
    assert e[-1] < e[0] - 0.05
    assert np.max(e - np.minimum.accumulate(e)) < 2e-3 * (e[0] - e[-1])


def test_dry_friction_holds_the_weight_without_creeping() -> None:
    one = bare(drawn("planar"), coulomb=10.0)
    q, _ = swing(one, 1.0, 0.0)
    assert np.ptp(q, axis=0).max() < 1e-12


@pytest.mark.parametrize("shape", ["spatial", "planar_levered"])
def test_at_rest_the_currents_bear_the_weight(shape: str) -> None:
    one = drawn(shape)
    for number in range(1, len(one.axes) + 1):
        one = one.joint(number, coulomb=0.0, resolution=0.0)
    q = one.centre
    m = np.array([equations.motor(j, q[k : k + 1])[0][0] for k, j in enumerate(one.joints)])
    g = np.array([equations.motor(j, q[k : k + 1])[1][0] for k, j in enumerate(one.joints)])
    log, _ = kernel.run(
        one.arm, list(one.joints), np.tile(np.concatenate([m, np.zeros(3)]), (6000, 1)),
        start=np.concatenate([q, np.zeros(3)]),
    )  # fmt: skip
    step = 1e-5 * np.eye(3)
    weight = (potential(one, q + step) - potential(one, q - step)) / 2e-5
    for axis in one.axes:
        borne = one.joints[axis]["kt"] * g[axis] * log[-1, 6 + axis]
        assert borne == pytest.approx(weight[axis], abs=1e-4 * np.abs(weight).max())


def test_a_stiff_joint_moves_as_a_rigid_one() -> None:
    one = drawn("planar", 7)
    t = np.arange(3000) * kernel.TICK
    q = one.centre + 0.3 * np.sin(2 * np.pi * 0.7 * t)[:, None] * [0, 1, -1]
    m = q * [j["ratio"] for j in one.joints]
    reference = np.concatenate([m, np.gradient(m, kernel.TICK, axis=0)], axis=1)
    start = np.concatenate([q[0], np.zeros(3)])
    rigid, _ = kernel.run(one.arm, list(one.joints), reference, start=start)
    inertia = equations.still(one.arm, one.centre, one.reach)[0]
    away = []
    for hertz in (60.0, 120.0):
        stiff = one
        for number, axis in enumerate(one.axes, start=1):
            k = inertia[axis] * (2 * np.pi * hertz) ** 2
            stiff = stiff.joint(number, elastic=1.0, stiffness=k, damping=0.2 * np.sqrt(k * inertia[axis]))
        log, _ = kernel.run(one.arm, list(stiff.joints), reference, start=start)
        away.append(np.abs(log[:, :3] - rigid[:, :3])[1000:].max())
    assert away[1] < 1e-3
    assert away[1] < 0.4 * away[0]  # the bend goes with the compliance, a quarter


@pytest.mark.parametrize("slip", [0.0, 1.0])
def test_bristles_hold_dry_friction_once_bent(slip: float) -> None:
    one = bare(drawn("planar", 8), bristle=0.03, distance=0.05, slip=slip).whole(gz=0.0, gx=0.0)
    one = one.joint(2, kt=0.05, kv=0.05, ki=1.0, **REST, current_p=1.0, current_i=1000.0)
    t = np.arange(4000) * kernel.TICK
    ratio = one.of(2)["ratio"]
    reference = np.zeros((len(t), 6))
    reference[:, 2], reference[:, 5] = 0.2 * t * ratio, 0.2 * ratio
    one = one.joint(1, coulomb=100.0)
    log, _ = kernel.run(one.arm, list(one.joints), reference, start=np.zeros(6))
    assert 0.05 * log[-1, 8] == pytest.approx(0.03, rel=0.01)


def test_the_inverse_is_the_plant_s() -> None:
    one = bare(drawn("spatial"))
    q, _ = swing(one, 0.5)
    v, a = np.gradient(q, kernel.STEP, axis=0), np.diff(q, 2, axis=0) / kernel.STEP**2
    effort = equations.efforts(one.arm, q[1:-1], v[1:-1], a)
    rotor = np.array([j["inertia"] * j["ratio"] ** 2 for j in one.joints]) * a
    assert np.abs(effort + rotor)[1:-1].max() < 1e-3 * np.abs(effort).max()


def test_the_same_seed_gives_the_same_bytes() -> None:
    first, again = (make(3, "torque_ripple", size=None, setting="two") for _ in range(2))
    assert first.arms == again.arms
    assert first.mapping == again.mapping
    assert {k: csv(t) for k, t in first.tables.items()} == {k: csv(t) for k, t in again.tables.items()}
    assert first.truth == again.truth
    assert (
        make(4, "nothing", size=None, setting="two").arms != make(5, "nothing", size=None, setting="two").arms
    )


def test_a_size_that_is_no_size_is_refused() -> None:
    with pytest.raises(ValueError, match="above 1"):
        make(0, "spring", size=1.0, setting="two")
    with pytest.raises(ValueError, match="unknown kind 'rust'"):
        make(0, "rust", size=1.1, setting="two")
    with pytest.raises(ValueError, match="unknown setting 'five'"):
        make(0, "spring", size=1.1, setting="five")
    assert len(set(KINDS)) == len(KINDS)


def test_what_is_hidden_has_the_size_that_was_asked_for(monkeypatch: pytest.MonkeyPatch) -> None:
    """The error of the user's model, over the noise that was put into the currents."""
    taken: dict[str, Any] = {}

    def errors(one: World, plan: Plan, records: list[Record]) -> np.ndarray:
        taken.update(world=one, plan=plan, left=fit.errors(one, plan, records))
        return np.array(taken["left"])

    monkeypatch.setattr(maker, "errors", errors)
    for kind, size in (("friction_offset", 1.3), ("outside:slow_wave", 1.1)):
        case = make(1, kind, size=size, setting="two")
        assert case.truth.size == pytest.approx(size, abs=0.05 * (size - 1))
        one, plan = taken["world"], taken["plan"]
        noise = [plan.noise * j["limit"] / 6 for j in one.joints]
        low = fit.low_pass(4000, plan.rate, fit.cutoff(plan)).toarray()
        passed = np.sqrt((low**2).sum(axis=1)[0])
        over = [taken["left"][a] / noise[a] / passed for a in one.axes]
        got = over[case.truth.joints[0] - 1] if case.truth.joints else max(over)
        assert got == pytest.approx(size, rel=0.06)


def test_modelgen_s_own_fit_finds_what_is_hidden(tmp_path: Path) -> None:
    """Other equations, from the written description and records, give the value back."""
    case = make(1, "asymmetric_viscous_friction", size=1.3, setting="two")
    (joint,) = case.truth.joints
    lines = case.arms.splitlines(keepends=True)
    at = [k for k, line in enumerate(lines) if "effects:" in line][joint - 1]
    lines[at] = lines[at].replace("]", ", asymmetric_viscous_friction]")
    case.write(tmp_path)
    (tmp_path / "arms.yaml").write_text("".join(lines))
    found = identify(
        load_arms(tmp_path / "arms.yaml")[case.arm],
        [tmp_path / f"{name}.csv" for name in case.train],
        [tmp_path / "test.csv"],
        mapping=tmp_path / "mapping.yaml",
        cutoff=8.0,
    ).parameters[f"FA{joint}"]
    assert found.value == pytest.approx(case.truth.values["skew"], abs=4 * found.std)
    assert abs(found.value) > 10 * found.std


def test_a_locked_column_stands_where_the_description_has_its_base() -> None:
    """In every record of a planar arm that is mounted aslant: else gravity would turn between records."""
    rng = np.random.default_rng(3)
    one = world.draw(rng, "planar")
    for seed, period in ((1, 6.0), (2, None)):
        plan = Plan(1, 100, 6.0, period, ("joint",) * 3, (20,) * 3, "instant", 0.0, 0.0, 1, False, None)
        angles = [maker.command(one, plan, seed, k) for k in range(2)]
        assert all(float(abs(a[:, 0]).max()) == 0.0 for a in angles)
        assert all(float(np.ptp(a[:, 1:], axis=0).min()) > 0.1 for a in angles)
