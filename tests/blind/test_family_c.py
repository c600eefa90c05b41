"""The plant of family C obeys mechanics, and hides what it says, as strong as it says."""

from __future__ import annotations

import time
from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from blind.case import csv
from blind.family_c import KINDS, draw, make, measure, plan, plant, records
from blind.family_c.arm_laws import ARM_LAWS
from blind.family_c.arms import Coupling, World
from blind.family_c.hidden import Hidden
from blind.family_c.joint_laws import JOINT_LAWS
from blind.family_c.outside import OUTSIDE

from modelgen.api.description import load_arms
from modelgen.api.identification import identify

OFF = {"coulomb": 0.0, "viscous": 0.0, "kp": 0.0, "kd": 0.0, "ki": 0.0, "forward": 0.0}
SEEDS = (1, 2, 3, 4, 5, 6)


def drawn(seed: int, joints: int = 3, levered: bool | None = False) -> World:
    return draw.draw(np.random.default_rng(seed), joints, levered)


def bare(world: World) -> World:
    """The same without friction, and with its motors off."""
    for k in range(world.count):
        world = world.joint(k, **OFF)
    return world


def swing(world: World, seconds: float = 1.5, speed: float = 0.5, *, carrying: bool = False) -> np.ndarray:
    """Joint coordinates (steps, n) after a push."""
    push = speed * world.speed * np.where(np.arange(world.count) % 2, -1.0, 1.0)
    still = np.zeros((int(seconds / plant.TICK), world.count))
    log = plant.run(world, still, start=world.centre, speed=push, carrying=carrying)
    return np.asarray(log[:, : world.count])


def witness(world: World) -> pin.Model:
    """The arm in Pinocchio, from the Denavit-Hartenberg parameters, without rotors."""
    model = pin.Model()
    model.gravity = pin.Motion(np.array(world.gravity), np.zeros(3))
    parent = 0
    for k, link in enumerate(world.links):
        about_x = pin.SE3(pin.utils.rotate("x", link.alpha), np.array([link.d, 0.0, 0.0]))
        about_z = pin.SE3(pin.utils.rotate("z", link.theta), np.array([0.0, 0.0, link.r]))
        kind = pin.JointModelPZ() if link.slides else pin.JointModelRZ()
        parent = model.addJoint(parent, kind, about_x * about_z, f"q{k}")
        body = pin.Inertia(link.mass, np.array(link.com), np.array(link.inertia))
        model.appendBodyToJoint(parent, body, pin.SE3.Identity())
    return model


def energy(world: World, q: np.ndarray) -> tuple[np.ndarray, float]:
    """Energy of links and rotors (N - 2), rates by central differences; and the most that is kinetic."""
    model = witness(world)
    data = model.createData()
    total, moving = [], 0.0
    v = (q[2:] - q[:-2]) / (2 * plant.STEP)
    turned = np.stack([world.motor(k, q[:, k]) for k in range(world.count)], axis=1)
    spin = (turned[2:] - turned[:-2]) / (2 * plant.STEP)
    for at, rate, turning in zip(q[1:-1], v, spin, strict=True):
        kinetic = pin.computeKineticEnergy(model, data, at, rate) + 0.5 * np.array(world.rotors) @ turning**2
        total.append(kinetic + pin.computePotentialEnergy(model, data, at))
        moving = max(moving, kinetic)
    return np.array(total), moving


@pytest.mark.parametrize("seed", SEEDS)
def test_without_friction_the_plant_is_pinocchio_s(seed: int) -> None:
    """Joint accelerations of a free fall, by forward dynamics of another library with the rotors added."""
    joints = 2 + seed % 5
    world = bare(drawn(seed, joints))
    q = swing(world, 0.4)
    model = witness(world)
    data = model.createData()
    model.armature = np.array(world.rotors) * np.array([n["scale"] ** 2 for n in world.numbers])
    got = np.diff(q, 2, axis=0) / plant.STEP**2
    v = np.diff(q, axis=0)[:-1] / plant.STEP
    zero = np.zeros(joints)
    want = [pin.aba(model, data, at, rate, zero) for at, rate in zip(q[1:-1], v, strict=True)]
    assert np.abs(got - np.array(want)).max() < 1e-5 * np.abs(want).max()


@pytest.mark.parametrize("levered", [False, True])
@pytest.mark.parametrize("seed", SEEDS)
def test_energy_is_kept_without_drives(seed: int, levered: bool) -> None:
    world = bare(drawn(seed, 2 + seed % 3, levered))
    e, moving = energy(world, swing(world, 0.6 if levered else 1.5, 0.3 if levered else 0.5))
    assert np.ptp(e) < 5e-3 * moving


def test_the_error_in_energy_goes_with_the_step(monkeypatch: pytest.MonkeyPatch) -> None:
    world = bare(drawn(2, 3))
    lost = []
    for step in (5e-4, 1.25e-4):
        monkeypatch.setattr(plant, "STEP", step)
        monkeypatch.setattr(plant, "TICK", 2 * step)
        lost.append(np.ptp(energy(world, swing(world, 1.0))[0]))
    assert lost[1] == pytest.approx(lost[0] / 4, rel=0.1)


@pytest.mark.parametrize("seed", SEEDS)
def test_the_regressor_is_the_plant_s(seed: int) -> None:
    world = drawn(seed, 2 + seed % 5)
    n = world.count
    q, v, a = np.random.default_rng(seed).normal(size=(3, 7, n))
    columns = []
    for link in world.links:
        m, c = link.mass, np.array(link.com)
        about = np.array(link.inertia) + m * (c @ c * np.eye(3) - np.outer(c, c))
        columns += [m, *(m * c), *about[np.triu_indices(3)]]
    by_columns = measure.regressor(world, q, v, a) @ np.array(columns)
    assert by_columns == pytest.approx(draw.efforts(plant.build(world), q, v, a), rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("rev", [1, -1])
def test_a_lever_is_a_triangle(rev: int) -> None:
    lever = draw._lever(np.random.default_rng(3), 0.4)
    lever = replace(lever, rev=rev, angle=0.4 - rev * 1.55)
    u = np.linspace(0.4, 2.7, 20)
    q = lever.angle + rev * u
    by_cosines = np.sqrt(lever.l1**2 + lever.l2**2 - 2 * lever.l1 * lever.l2 * np.cos(u))
    assert lever.length(q) == pytest.approx(by_cosines)
    assert lever.joint(by_cosines) == pytest.approx(q)
    assert lever.arm(q) == pytest.approx((lever.length(q + 1e-6) - lever.length(q - 1e-6)) / 2e-6, rel=1e-6)
    world = bare(drawn(1, 2, True))
    log = plant.run(world, np.zeros((100, 2)), start=world.centre, speed=0.1 * world.speed)
    for k in range(2):
        assert log[:, 2 + k] == pytest.approx(world.motor(k, log[:, k]), abs=1e-6)


FRICTIONS: dict[str, dict[str, float]] = {
    "coulomb": {"coulomb": 1.0},
    "viscous": {"viscous": 0.02},
    "stribeck_friction": {"excess": 5.0, "sped": 60.0},
    "load_dependent_friction": {"by_load": 1.0, "load_floor": 0.1},
    "nonlinear_viscous_friction, asinh": {"bent": 1.0, "bent_speed": 30.0, "bent_form": 0.0},
    "nonlinear_viscous_friction, square": {"bent": 1.0, "bent_speed": 30.0, "bent_form": 1.0},
    "nonlinear_viscous_friction, cube": {"bent": 1.0, "bent_speed": 30.0, "bent_form": 2.0},
    "position_dependent_friction": {"coulomb": 1.0, "worn": 0.9, "wide": 0.8},
    "friction_warm_up": {"cold_dry": 1.0, "cold_viscous": 0.01, "warm_time": 1.0, "warm_speed": 20.0},
    "presliding, Dahl": {"bristle": 1.0, "distance": 0.2},
    "presliding, Iwan": {"bristle": 1.0, "distance": 0.2, "elements": 1.0},
    "run_in": {"strange": 1.0, "strange_size": 60.0, "a": 0.3, "b": 0.01},
    "clutch": {"strange": 4.0, "strange_size": 60.0, "a": 1.0, "b": 0.01},
    "loaded_oil": {"strange": 5.0, "strange_size": 20.0, "a": 0.3, "b": 10.0},
}


SCALED = ("coulomb", "viscous", "excess", "worn", "cold_dry", "cold_viscous", "bent", "bristle")


@pytest.mark.parametrize("law", FRICTIONS)
def test_friction_dissipates(law: str) -> None:
    world = bare(drawn(4, 3))
    values = dict(FRICTIONS[law])
    for k in range(3):
        unit = 0.3 * float(world.scale[k])
        scaled = {
            name: x * unit if name in SCALED else x for name, x in values.items()
        }  # fmt: skip
        world = world.joint(k, **scaled)
    e, moving = energy(world, swing(world, 1.0))
    stored = sum(0.6 * float(s) * 0.2 for s in world.scale) if "presliding" in law else 0.0
    assert e[-1] < e[0] - 0.05 * moving
    assert np.max(e - np.minimum.accumulate(e)) < stored + 5e-3 * moving


def hidden(kind: str, world: World, k: int = 1) -> Hidden:
    """An effect of the catalogue, drawn."""
    made = {**JOINT_LAWS, **ARM_LAWS, **{f"outside:{n}": m for n, m in OUTSIDE.items()}}[kind]
    return made(np.random.default_rng(5), world, plan.draw(np.random.default_rng(1), "two", world.count), k)


@pytest.mark.parametrize("kind", ["fluid_drag", "transmission_coupling"])
def test_the_fluid_and_the_coupling_dissipate(kind: str) -> None:
    world = bare(drawn(4, 3))
    e, moving = energy(world, swing(hidden(kind, world).put(2.0), 1.0))
    assert e[-1] < e[0] - 0.05 * moving
    assert np.max(e - np.minimum.accumulate(e)) < 5e-3 * moving


def test_the_drag_of_a_turning_rod_is_its_integral() -> None:
    """Moment of c |v| v along a rod that turns about its end: c w^2 l^4 / 4."""
    world = bare(drawn(4, 2))
    length, c, w = 0.5, 3.0, 2.0
    links = tuple(replace(link, alpha=0.0, d=0.0, r=0.0, theta=0.0, slides=False) for link in world.links)
    world = replace(world, links=links, gravity=(0.0, 0.0, 0.0)).around(tip_x=length)
    rates = []
    for drag in (0.0, c):
        log = plant.run(
            world.around(drag=drag), np.zeros((2, 2)), start=np.zeros(2), speed=np.array([w, 0.0])
        )
        rates.append((log[1, :2] - log[0, :2]) / plant.STEP)
    inertia = [
        (draw.efforts(plant.build(world), *(np.zeros((1, 2)),) * 2, np.eye(2)[k : k + 1]))[0]
        for k in range(2)
    ]
    mass = np.array(inertia) + np.diag(np.array(world.rotors) * [n["scale"] ** 2 for n in world.numbers])
    lost = mass @ (rates[0] - rates[1]) / plant.STEP
    assert lost == pytest.approx([c * w**2 * length**4 / 4] * 2, rel=0.02)


@pytest.mark.parametrize("kind", ["outside:magnet", "outside:tether", "outside:gyroscope", "spring"])
def test_what_conserves_energy_does_no_work_over_a_closed_path(kind: str) -> None:
    """Thrown, and thrown back with its speed and its wheel reversed: the way back is the way."""
    world = bare(drawn(4, 3))
    with_it = hidden(kind, world).put(0.5)
    there = swing(with_it, 0.5)
    back_world = with_it.around(spin=-dict(with_it.space).get("spin", 0.0))
    still = np.zeros((len(there) // plant.PER_TICK, 3))
    end = (there[-1] - there[-2]) / plant.STEP
    back = plant.run(back_world, still, start=there[-1], speed=-end)[:, :3]
    assert np.abs(swing(world, 0.5) - there).max() > 1e-3
    assert np.abs(back[: len(there)] - there[::-1]).max() < 0.02 * np.ptp(there, axis=0).max()


def test_at_rest_the_currents_bear_the_weight() -> None:
    for seed, levered in ((4, False), (6, True)):
        world = drawn(seed, 3, levered)
        for k in range(3):
            world = world.joint(k, coulomb=0.0, grain=1e-9)
        goal = np.array([world.motor(k, world.centre[k : k + 1])[0] for k in range(3)])
        log = plant.run(world, np.tile(goal, (4000, 1)), start=world.centre)
        gear = [float(world.gear(k, world.centre[k : k + 1])[0]) for k in range(3)]
        borne = [world.numbers[k]["kt"] * gear[k] * log[-1, 6 + k] for k in range(3)]
        model = witness(world)
        weight = pin.computeGeneralizedGravity(model, model.createData(), world.centre)
        assert borne == pytest.approx(weight, abs=2e-3 * np.abs(weight).max())


def test_dry_friction_sticks() -> None:
    world = bare(drawn(4, 3))
    for k in range(3):
        world = world.joint(k, coulomb=50 * float(world.scale[k]))
    q = swing(world, 1.0, 0.0)
    assert np.ptp(q, axis=0).max() < 5e-6  # in a second: less than an increment of the finest encoder


def test_tilting_and_carrying_change_the_weight_as_they_say() -> None:
    world = drawn(5, 3)
    model = witness(world)
    tilted = hidden("base_tilt", world)
    x, values = 0.1, tilted.values(0.1)
    turn = pin.exp3(np.array([values["x"], values["y"], 0.0]))
    assert tilted.put(x).gravity == pytest.approx(turn.T @ np.array(world.gravity))
    load = hidden("payload_change", world)
    values = load.values(0.5)
    at = pin.SE3(np.eye(3), np.array([values["x"], values["y"], values["z"]]))
    model.appendBodyToJoint(3, pin.Inertia(values["mass"], np.zeros(3), np.zeros((3, 3))), at)
    want = pin.computeGeneralizedGravity(model, model.createData(), world.centre)
    still = np.zeros((1, 3))
    got = draw.efforts(plant.build(load.put(0.5), carrying=True), world.centre[None], still, still)[0]
    assert got == pytest.approx(want, rel=1e-6)


def test_a_stiff_joint_moves_as_a_rigid_one_and_a_gap_lets_it_fall() -> None:
    world = drawn(3, 2)
    t = np.arange(3000) * plant.TICK
    q = world.centre + 0.3 * np.sin(2 * np.pi * 0.7 * t)[:, None] * [1, -1]
    m = np.stack([world.motor(k, q[:, k]) for k in range(2)], axis=1)
    rigid = plant.run(world, m, start=q[0])
    inertia = draw.inertias(world)
    away = []
    for hertz in (40.0, 80.0):
        k = float(inertia[1]) * (2 * np.pi * hertz) ** 2
        stiff = world.joint(1, stiffness=k, damping=0.2 * np.sqrt(k * inertia[1]))
        log = plant.run(replace(stiff, elastic=1), m, start=q[0])
        away.append(np.abs(log[:, 1] - rigid[:, 1])[1000:].max())
    assert away[1] < 2e-3
    assert away[1] < 0.4 * away[0]  # the bend goes with the compliance, a quarter
    loose = hidden("backlash", world)
    log = plant.run(loose.put(3.0), m, start=q[0])
    lost = log[1000:, 1] - world.place(1, log[1000:, 3])
    assert 0.9 * loose.values(3.0)["gap"] / 2 < np.abs(lost).max() < 3 * loose.values(3.0)["gap"]


def test_a_coupling_brakes_both_joints_by_one_speed() -> None:
    world = bare(drawn(4, 3))
    held = replace(world, coupling=Coupling(2, 1, -1.0, 0.0, 0.0, 1e4))
    q = swing(held, 1.0)
    rate = np.diff(q, axis=0)[500:] / plant.STEP
    free = np.diff(swing(world, 1.0), axis=0)[500:] / plant.STEP
    assert np.abs(rate[:, 2] - rate[:, 1]).max() < 0.05 * np.abs(free[:, 2] - free[:, 1]).max()


OF_DRIVES = (
    "friction_offset", "asymmetric_viscous_friction", "torque_ripple", "torque_constant_saturation",
    "drive_gain_error", "outside:dragged_along", "outside:duhem", "outside:fan", "outside:beats",
    "outside:supply_wave", "outside:wander", "outside:waves_of_gain",
)  # fmt: skip


@pytest.mark.parametrize("kind", OF_DRIVES)
def test_what_is_hidden_in_a_drive_asks_for_another_current_there_alone(kind: str) -> None:
    """The motion takes, at one joint, another current than by inverse dynamics; at the others the same."""
    world = drawn(4, 3)
    for k in range(3):
        world = world.joint(k, coulomb=0.0, grain=1e-9)
    asked = plan.draw(np.random.default_rng(1), "two", 3)
    strength = 20.0 if kind == "torque_constant_saturation" else 0.5
    log = records.flown(hidden(kind, world).put(strength), asked, 0, records.command(world, asked, 3, 0))[
        4000:
    ]
    q, current = log[:, :3], log[1:-1, 6:]
    v, a = np.diff(q, axis=0)[:-1] / plant.STEP, np.diff(q, 2, axis=0) / plant.STEP**2
    rows = slice(None, None, 200)
    links = draw.efforts(plant.build(world), q[1:-1][rows], v[rows], a[rows])
    for k in range(3):
        n = world.numbers[k]
        asks = (
            links[:, k] / n["scale"]
            + world.rotors[k] * n["scale"] * a[rows, k]
            + n["viscous"] * n["scale"] * v[rows, k]
        )
        away = np.sqrt(np.mean((current[rows, k] * n["kt"] - asks) ** 2)) / float(world.scale[k])
        assert away > 0.05 if k == 1 else away < 2e-3


def test_the_wave_of_an_encoder_is_in_its_reading() -> None:
    world = drawn(4, 3)
    asked = replace(
        plan.draw(np.random.default_rng(1), "two", 3), motor_side=(False,) * 3, bits=(24,) * 3, seconds=2.0
    )
    off = hidden("outside:eccentric_scale", world).put(1.0)
    shifted = hidden("encoder_offset", world).put(1.0)
    motion = records.command(world, asked, 3, 0)
    true, waves, reads = (
        records.record(w, world, asked, 3, 0, motion, np.zeros(3)).q for w in (world, off, shifted)
    )
    assert off.eccentric is not None
    _, size, phase = off.eccentric
    assert waves[:, 1] - true[:, 1] == pytest.approx(size * np.sin(true[:, 1] + phase), abs=1e-5)
    assert true[:, 1] - reads[:, 1] == pytest.approx(shifted.offset[1], abs=1e-5)
    assert np.abs(waves - true)[:, [0, 2]].max() < 1e-6


def test_every_kind_is_tested_or_is_there_from_the_start() -> None:
    assert len(set(KINDS)) == len(KINDS)
    assert sum(k.startswith("outside:") for k in KINDS) >= 10


def test_the_same_seed_gives_the_same_bytes_in_a_few_seconds() -> None:
    begin = time.process_time()
    first, again = (make(3, "torque_ripple", size=1.3, setting="two") for _ in range(2))
    assert (time.process_time() - begin) / 2 < 20.0
    assert (first.arms, first.mapping, first.truth) == (again.arms, again.mapping, again.truth)
    assert {k: csv(t) for k, t in first.tables.items()} == {k: csv(t) for k, t in again.tables.items()}
    assert first.truth.size == pytest.approx(1.3, abs=0.03)
    assert make(4, "nothing", setting="two").arms != make(5, "nothing", setting="two").arms


def test_what_is_no_kind_no_size_or_no_setting_is_refused() -> None:
    with pytest.raises(ValueError, match="above 1"):
        make(0, "spring", size=1.0, setting="two")
    with pytest.raises(ValueError, match="unknown kind 'rust'"):
        make(0, "rust", size=1.1, setting="two")
    with pytest.raises(ValueError, match="unknown setting 'five'"):
        make(0, "spring", size=1.1, setting="five")


@pytest.mark.parametrize("seed", [0, 1])
def test_of_a_plain_arm_nothing_is_left_but_the_noise(seed: int) -> None:
    """A fit of the user's model leaves what the noise alone leaves in the same band."""
    rng = np.random.default_rng(seed)
    asked = plan.draw(rng, "two", 3)
    asked = replace(asked, white=0.03, coloured=0.0, bits=(24,) * 3, motor_side=(False,) * 3)
    world = drawn(seed + 4, 3, bool(seed))
    for k in range(3):  # the loop answers to the increments of its encoder, which is noise too
        world = world.joint(k, grain=1e-9)
    noise = records.levels(world, asked, seed)
    taken = [
        records.record(world, world, asked, seed, k, records.command(world, asked, seed, k), noise)
        for k in range(2)
    ]
    left = measure.errors(world, asked, taken)
    passed = measure._low(
        np.random.default_rng(1).normal(size=(20000, 1)), asked.rate, measure.band(asked)
    ).std()
    assert left == pytest.approx(0.03 * noise * passed, rel=0.12)


def test_modelgen_s_own_fit_finds_what_is_hidden(tmp_path: Path) -> None:
    """Other equations, from the written description and records, give the value back."""
    case = make(1, "friction_offset", size=1.3, setting="two")
    (joint,) = case.truth.joints
    lines = case.arms.splitlines(keepends=True)
    at = [k for k, line in enumerate(lines) if "effects:" in line][joint - 1]
    lines[at] = lines[at].replace("]", ", friction_offset]")
    case.write(tmp_path)
    (tmp_path / "arms.yaml").write_text("".join(lines))
    found = identify(
        load_arms(tmp_path / "arms.yaml")[case.arm],
        [tmp_path / f"{name}.csv" for name in case.train],
        [tmp_path / "test.csv"],
        mapping=tmp_path / "mapping.yaml",
        cutoff=8.0,
    ).parameters[f"FO{joint}"]
    assert found.value == pytest.approx(case.truth.values["bias"], abs=4 * found.std)
    assert abs(found.value) > 10 * found.std
