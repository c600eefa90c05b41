"""The simulated arms against MuJoCo, closed forms and balances of energy, and what they leave unexplained."""

import math
from pathlib import Path

import mujoco
import numpy as np
import pytest
from numpy.random import default_rng

from hidden import arms, fitting, logs, native, trajectories
from hidden.cases import RECORDS, Bench, Case, Hidden, make, seal, unseal
from hidden.effects import EFFECTS, add_payload, heights, joints_for
from hidden.native import Array, Plant


def mujoco_model(plant: Plant) -> mujoco.MjModel:
    spec = mujoco.MjSpec()
    spec.option.gravity = plant["gravity"].tolist()
    spec.option.timestep = 1e-4
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_RK4
    body = spec.worldbody
    for j in range(int(plant["n"])):
        alpha, theta = plant["alpha"][j], plant["theta"][j]
        turn_x = np.array([math.cos(alpha / 2), math.sin(alpha / 2), 0, 0])
        turn_z = np.array([math.cos(theta / 2), 0, 0, math.sin(theta / 2)])
        turned = np.zeros(4)
        mujoco.mju_mulQuat(turned, turn_x, turn_z)
        place = [plant["d"][j], -math.sin(alpha) * plant["r"][j], math.cos(alpha) * plant["r"][j]]
        body = body.add_body(pos=place, quat=turned)
        body.add_joint(type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0, 0, 1])
        xx, xy, xz, yy, yz, zz = plant["inertia"][j]
        body.mass, body.ipos, body.explicitinertial = plant["mass"][j], plant["com"][j], True
        body.fullinertia = [xx, yy, zz, xy, xz, yz]
    return spec.compile()


def motions(arm: arms.Arm, count: int) -> tuple[Array, Array, Array]:
    random = default_rng(3)
    q = random.uniform(arm.position[:, 0], arm.position[:, 1], size=(count, arm.n))
    return q, random.normal(size=q.shape), random.normal(size=q.shape)


@pytest.mark.parametrize("name", arms.DESIGNS)
def test_rigid_bodies_agree_with_mujoco(name: str) -> None:
    arm = arms.draw(name, default_rng(1))
    model = mujoco_model(arm.plant)
    data = mujoco.MjData(model)
    for q, dq, _ in zip(*motions(arm, 4), strict=True):
        data.qpos, data.qvel = q, dq
        mujoco.mj_forward(model, data)
        full = np.zeros((arm.n, arm.n))
        mujoco.mj_fullM(model, data, full)
        mass, bias = native.mass_and_bias(arm.plant, q, dq)
        np.testing.assert_allclose(mass, full, rtol=1e-9, atol=1e-11)
        np.testing.assert_allclose(bias, data.qfrc_bias, rtol=1e-9, atol=1e-9)
        tip = data.xpos[-1] + data.xmat[-1].reshape(3, 3) @ arm.plant["tip"]
        np.testing.assert_allclose(heights(arm.plant, q[None])[0], tip[2], atol=1e-12)


@pytest.mark.parametrize("name", arms.DRIVEN)
def test_the_regressor_is_the_equation_of_motion(name: str) -> None:
    plant = (arm := arms.draw(name, default_rng(1))).plant
    q, dq, ddq = motions(arm, 4)
    n = arm.n
    drives = np.array([(plant["rotor"][j], plant["viscous"][j], plant["dry"][j]) for j in range(n)]).ravel()
    found = native.regressor(plant, q, dq, ddq) @ np.concatenate([fitting.standard_links(plant), drives])
    for row in range(len(q)):
        mass, bias = native.mass_and_bias(plant, q[row], dq[row])
        links = mass @ ddq[row] + bias
        for j in range(n):
            _, slope, bend = native.drive(plant, j, q[row, j])
            speed = slope * dq[row, j]
            motor = plant["rotor"][j] * (slope * ddq[row, j] + bend * dq[row, j] ** 2)
            motor += plant["viscous"][j] * speed + plant["dry"][j] * np.sign(speed)
            expected = (links[j] / slope + motor) / plant["torque_constant"][j]
            assert found[row, j] == pytest.approx(expected, rel=1e-9)


@pytest.mark.parametrize("name", ["levered2", "mixed3"])
def test_drives_have_the_derivatives_they_claim(name: str) -> None:
    plant = (arm := arms.draw(name, default_rng(1))).plant
    for j in range(arm.n):
        q, step = float(arm.position[j].mean()), 1e-5
        x, slope, bend = native.drive(plant, j, q)
        after, before = native.drive(plant, j, q + step), native.drive(plant, j, q - step)
        assert slope == pytest.approx((after[0] - before[0]) / (2 * step), rel=1e-7)
        assert bend == pytest.approx((after[1] - before[1]) / (2 * step), rel=1e-6, abs=1e-6)
        assert native.joint_from_motor(plant, j, np.array([x]))[0] == pytest.approx(q, abs=1e-9)


def free_swing(name: str) -> arms.Arm:
    arm = arms.draw(name, default_rng(5))
    plant = arm.plant
    plant["dry"], plant["viscous"], plant["count"], plant["free"] = 0.0, 0.0, 0.0, 1.0
    plant["q0"][: arm.n] = 1.2
    return arm


def test_a_free_swing_follows_mujoco_and_keeps_its_energy() -> None:
    plant = free_swing("pendulum2").plant
    q, _, _, energy = native.simulate(plant, 1000, 5.0, 8, warm_up=0.0, energy=True)
    assert energy is not None
    assert np.ptp(energy) < 2e-5 * (energy.max() - energy.min() + np.abs(energy).max())
    model = mujoco_model(plant)
    data = mujoco.MjData(model)
    data.qpos = plant["q0"][:2]
    for _ in range(10 * 4990):
        mujoco.mj_step(model, data)
    np.testing.assert_allclose(q[4990], data.qpos, atol=2e-4)


def test_dry_friction_stops_where_the_closed_form_says() -> None:
    # A horizontal joint: v falls at dry / inertia, and stays at rest from then on.
    arm = free_swing("pendulum1")
    plant = arm.plant
    plant["gravity"], plant["dry"][0], plant["q0"][0], plant["dq0"][0] = 0.0, 0.5, 0.0, 3.0
    inertia = native.mass_and_bias(plant, np.zeros(1), np.zeros(1))[0][0, 0]
    q = native.simulate(plant, 1000, 6.0, 2, warm_up=0.0)[0][:, 0]
    stop = 3.0 * inertia / 0.5
    assert stop < 5.5
    assert q[-1] == pytest.approx(0.5 * 3.0 * stop, abs=1e-5)
    assert np.ptp(q[round(1000 * stop) + 2 :]) == 0.0


def test_an_elastic_drive_rings_at_its_frequency() -> None:
    arm = free_swing("pendulum1")
    plant = arm.plant
    plant["gravity"], plant["q0"][0] = 0.0, 0.0
    plant["rotor"][0], plant["stiffness"][0], plant["dq0"][0] = 0.3, 900.0, 0.5
    inertia = native.mass_and_bias(plant, np.zeros(1), np.zeros(1))[0][0, 0]
    # Both start at 0.5 rad/s: no stretch. The link alone is then pushed by a spring to the ground.
    plant["spring"][0] = 40.0
    q = native.simulate(plant, 2000, 8.0, 8, warm_up=0.0)[0][:, 0]
    stiffness = np.array([[900.0 + 40.0, -900.0], [-900.0, 900.0]])
    values = np.linalg.eigvals(np.diag([1 / inertia, 1 / 0.3]) @ stiffness)
    crossings = np.flatnonzero((q[1:] > 0) & (q[:-1] <= 0))
    period = (crossings[-1] - crossings[0]) / (len(crossings) - 1) / 2000
    assert period == pytest.approx(2 * math.pi / math.sqrt(values.min().real), rel=0.01)


def test_carried_bodies_keep_the_energy() -> None:
    """Cylinders and fluid come in by Christoffel differences: without friction the balance must close."""
    arm = arms.draw("levered2", default_rng(2))
    plant = arm.plant
    for field in ("dry", "viscous", "rotor", "count", "gravity"):
        plant[field] = 0.0
    plant["cylinder_mass"][:2], plant["cylinder_centre"][:2] = 4.0, 0.15
    plant["cylinder_anchor"][:2], plant["added_mass"][1] = (0.4, 2.0), 12.0
    plant["free"], plant["dq0"][:2] = 1.0, (0.25, -0.3)
    energy = native.simulate(plant, 500, 2.0, 8, warm_up=0.0, energy=True)[3]
    assert energy is not None
    assert np.ptp(energy) < 1e-4 * energy.max()


def test_a_payload_is_a_point_mass() -> None:
    arm = arms.draw("direct3", default_rng(2))
    q, dq = np.array([0.3, 0.8, -0.9]), np.array([0.4, -0.2, 0.7])
    before, torque = native.mass_and_bias(arm.plant, q, dq)
    add_payload(arm.plant, 0.7)
    after, more = native.mass_and_bias(arm.plant, q, dq)
    step = 1e-6
    lift = [
        (heights(arm.plant, (q + step * e)[None])[0] - heights(arm.plant, (q - step * e)[None])[0])
        / (2 * step)
        for e in np.eye(3)
    ]
    static = native.mass_and_bias(arm.plant, q, 0 * dq)[1]
    add_payload(arm.plant, -0.7)
    np.testing.assert_allclose(
        static - native.mass_and_bias(arm.plant, q, 0 * dq)[1], 0.7 * 9.81 * np.array(lift), atol=1e-6
    )
    np.testing.assert_allclose(native.mass_and_bias(arm.plant, q, dq)[0], before, atol=1e-10)
    assert np.linalg.eigvalsh(after - before).min() > -1e-10
    assert not np.allclose(torque, more)


@pytest.mark.parametrize("name", arms.DRIVEN)
def test_without_a_hidden_effect_only_the_noise_is_left(name: str) -> None:
    """Against a run without noise: what is left then comes from the encoders' counts, and is far less."""
    quiet, loud = (Bench(Case(name, 4, noise=level)) for level in (0.0, 1.0))
    model, noisy = quiet.errors({}), loud.errors({})
    assert (model < 0.4 * noisy).all()
    squares = []
    for k in range(3):
        current = quiet.record(k, {}).current
        assert current is not None
        size = np.sqrt((current**2).mean(axis=0))
        drawn = fitting.low_pass(logs.noise(len(current), size, 500.0, default_rng(k)), fitting.BAND, 500.0)
        squares.append((drawn**2).mean(axis=0))
    expected = np.sqrt(np.mean(squares, axis=0))
    # The estimates' own errors come on top.
    assert (noisy > 0.85 * expected).all()
    assert (noisy < 1.3 * expected).all()


def test_an_effect_makes_no_noise() -> None:
    """Friction that doubles the current leaves the noise as it was: it is no part of what an effect costs."""
    hidden = (Hidden("friction_offset", 1, 1.3),)
    quiet, loud = (Bench(Case("levered2", 4, hidden, noise=level)) for level in (0.0, 1.0))
    for magnitudes in ({}, {0: 30.0}):
        silent, noisy = (bench.record(1, magnitudes).current for bench in (quiet, loud))
        assert silent is not None
        assert noisy is not None
        if not magnitudes:
            alone, was = noisy - silent, np.abs(silent).mean(axis=0)
    assert np.abs(silent).mean(axis=0)[0] > 1.5 * was[0]
    np.testing.assert_allclose(noisy - silent, alone, atol=1e-12)


@pytest.mark.parametrize("name", ["mixed3", "direct3"])
def test_without_counts_and_noise_nothing_is_left(name: str) -> None:
    """The stepping, the log of a held current and the regressor are one model, to a part in a thousand."""
    noise = Bench(Case(name, 4)).errors({})
    exact = Bench(Case(name, 4, noise=0.0))
    exact.arm.plant["count"] = 0.0
    assert (exact.errors({}) < 0.005 * noise).all()


def test_trajectories_reach_their_limits_and_repeat() -> None:
    arm = arms.draw("mixed3", default_rng(1))
    plant = trajectories.draw(arm, default_rng(2))
    t = np.linspace(0, 10, 2000, endpoint=False)
    q, dq, ddq = trajectories.motion(plant, t)
    assert (q >= arm.position[:, 0]).all() and (q <= arm.position[:, 1]).all()  # noqa: PT018
    used = np.max(
        [
            np.ptp(q, axis=0) / np.ptp(arm.position, axis=1),
            np.abs(dq).max(axis=0) / arm.velocity,
            np.abs(ddq).max(axis=0) / arm.acceleration,
        ],
        axis=0,
    )
    assert (used > 0.9).all() and (used <= 1.0).all()  # noqa: PT018
    np.testing.assert_allclose(trajectories.motion(plant, t + 10.0)[0], q, atol=1e-12)


@pytest.mark.parametrize(
    ("effect", "name", "joint"),
    [
        ("stribeck_friction", "direct2", 2),
        ("actuator_mass", "levered2", 2),
        ("joint_flexibility", "direct2", 1),
        ("payload_change", "mixed2", 2),
        ("hard_spot", "direct2", 2),
        ("spring", "pendulum1", 1),
    ],
)
def test_an_effect_reaches_the_strength_asked_for(effect: str, name: str, joint: int) -> None:
    bench = Bench(Case(name, 103, (Hidden(effect, joint, 1.3),)))
    floor = bench.errors({})
    magnitude, reached = bench.tune(0, floor)
    assert reached == pytest.approx(1.3, abs=0.02)
    assert bench.strength(0, floor, bench.errors({0: 0.3 * magnitude})) < 1.2


def test_a_spring_and_an_offset_are_not_outside_the_catalogue() -> None:
    """Of either nothing is left for what the strength of an effect from outside is; of a spot most is."""
    for effect, least, most in (
        ("spring", 0.97, 1.03),
        ("friction_offset", 0.97, 1.03),
        ("hard_spot", 1.2, 1.4),
    ):
        bench = Bench(Case("levered2", 103, (Hidden(effect, 2, 1.3),)))
        magnitude = bench.tune(0, bench.errors({}))[0]
        clean, hidden = ([bench.record(k, given) for k in range(3)] for given in ({}, {0: magnitude}))
        left = [fitting.rotated(logs, bench.arm.plant, (0, 1, 2), pulled=True) for logs in (hidden, clean)]
        assert least < (left[0] / left[1])[1] < most


def test_the_noise_has_the_covariance_that_its_filters_give() -> None:
    """Of the mean of two samples, low-passed: every 14th, against draws."""
    step, rate = 14, 500.0
    found = fitting.noise_covariance(8, step, rate)
    drawn = []
    for k in range(40):
        current = logs.noise(20000, np.ones(1), rate, default_rng([5, k]))
        current[1:] = 0.5 * (current[1:] + current[:-1])
        kept = fitting.low_pass(current, fitting.BAND, rate)[500:-500:step, 0]
        drawn.append([np.mean(kept[lag:] * kept[: len(kept) - lag]) for lag in range(8)])
    np.testing.assert_allclose(found[0], np.mean(drawn, axis=0), atol=0.05 * found[0, 0])


def test_what_the_training_records_show_of_an_effect() -> None:
    """Nothing of one that is not there. Of one that is, about what so much less error in as many independent
    samples is, and with the square of its size over that of the noise, and the number of records.
    """
    hidden = (Hidden("stribeck_friction", 2, 1.3),)

    def shown(size: float, train: int = 2, noise: float = 1.0) -> float:
        bench = Bench(Case("direct2", 103, hidden, noise=noise, train=train))
        records = [[bench.record(k, by, noisy=False) for k in bench.case.training] for by in ({0: size}, {})]
        scale = [bench.noise_scale(k) for k in bench.case.training]
        assert fitting.shown(records[1], records[1], scale, bench.arm.plant) == 0.0
        return fitting.shown(*records, scale, bench.arm.plant)

    bench = Bench(Case("direct2", 103, hidden))
    magnitude = bench.tune(0, bench.errors({}))[0]
    found = shown(magnitude)
    samples = 2 * bench.duration * 2 * fitting.BAND
    assert 0.5 < found / (samples * math.log(1.3**2)) < 2.0
    assert 2.0 < found / shown(0.5 * magnitude) < 6.0
    assert 2.0 < found / shown(magnitude, noise=2.0) < 6.0
    assert 1.5 < shown(magnitude, train=4) / found < 4.0  # a fit to few motions takes up more of it


def test_every_effect_has_a_place() -> None:
    for effect in EFFECTS:
        assert any(joints_for(effect, arms.draw(name, default_rng(0))) for name in arms.DESIGNS)


def test_a_case_is_written_whole_and_its_label_packed(tmp_path: Path) -> None:
    case = Case("direct2", 3, (Hidden("spring", 1, 1.3, magnitude=0.5),))
    label = make(case, tmp_path)
    seal(label, tmp_path / "label.sealed")
    assert b"spring" not in (tmp_path / "label.sealed").read_bytes()
    assert unseal(tmp_path / "label.sealed").case["hidden"][0]["effect"] == "spring"
    names = {path.name for path in tmp_path.iterdir()}
    assert names == {"arms.yaml", "label.sealed", *(f"{RECORDS[k]}.csv" for k in case.records)}
    for name in RECORDS[:4]:
        lines = (tmp_path / f"{name}.csv").read_text().splitlines()
        assert lines[0] == "t,qm1,qm2,i1,i2"
        assert len(lines) == 1 + 15000
    quiet = Case("direct2", 3, (Hidden("spring", 1, 1.3, magnitude=0.5),), noise=0.0)
    assert math.isnan(make(quiet, tmp_path / "quiet").shown)
    again = tmp_path / "again"
    make(case, again)
    assert (again / "test.csv").read_bytes() == (tmp_path / "test.csv").read_bytes()
