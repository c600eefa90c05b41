"""Excitation trajectories: limits, derivatives, condition number, what they gain over random ones."""

import json
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from arms_support import ARMS, model
from typer.testing import CliRunner

from modelgen.backends.numpy import NumpyFunction
from modelgen.cli.app import app
from modelgen.description import Limits
from modelgen.description.objects import EffectUse
from modelgen.errors import InputError
from modelgen.excitation import Excitation, determined, excite, random_conditions
from modelgen.functions.nominal import nominal_base
from modelgen.options import ExcitationOptions, box

PAPER = ExcitationOptions(rate=10.0, starts=2, iterations=40, processes=1)


@cache
def ariane4() -> Excitation:
    return excite(ARMS["ariane4"], PAPER)


def evaluated(e: Excitation, name: str, *arguments: np.ndarray) -> np.ndarray:
    (function,) = (f for f in model(e.arm.name).functions if f.name == name)
    return NumpyFunction(function)(*arguments)


def test_the_printed_limits_hold_in_motor_coordinates() -> None:
    """Table III of Leborne et al. (2018), on a grid much finer than that of the optimisation."""
    e = ariane4()
    t = np.arange(0, 80, 0.02)
    x, dx, ddx = e.problem.series(e.z, t)
    assert (x >= 0).all()
    assert (x <= [20850, 6810, 26750]).all()
    assert (np.abs(dx) <= [2000, 600, 2000]).all()
    assert (np.abs(ddx) <= [20000, 6000, 20000]).all()
    assert (np.abs(dx).max(axis=0) > [500, 150, 500]).all()  # and it moves


def test_the_joints_follow_from_the_motors_by_the_law_of_cosines() -> None:
    e = ariane4()
    length = 0.267857 + (0.368385 - 0.267857) * e.signals["qm"][:, 0] / 20850
    inner = np.arccos((0.323**2 + 0.058**2 - length**2) / (2 * 0.323 * 0.058))
    assert e.signals["q"][:, 0] == pytest.approx(inner - np.radians(106.39), abs=1e-9)
    speed = np.degrees(np.abs(e.signals["dq"]).max(axis=0))
    assert (speed <= [28, 9, 25]).all()


@pytest.mark.parametrize(("name", "derivative"), [("q", "dq"), ("dq", "ddq"), ("qm", "dqm"), ("dqm", "ddqm")])
def test_speeds_and_accelerations_are_the_derivatives(name: str, derivative: str) -> None:
    """Of periodic signals, whose derivatives the discrete Fourier transform gives."""
    e = ariane4()
    w = 2j * np.pi * np.fft.rfftfreq(len(e.t), 0.1)
    exact = np.fft.irfft(w[:, None] * np.fft.rfft(e.signals[name], axis=0), len(e.t), axis=0)
    scale = np.abs(exact).max(axis=0)
    assert np.abs(e.signals[derivative] - exact).max(axis=0) / scale == pytest.approx([0, 0, 0], abs=1e-6)


def test_the_condition_number_is_that_of_the_emitted_regressor() -> None:
    e = ariane4()
    y = evaluated(e, "regressor", e.signals["q"], e.signals["dq"], e.signals["ddq"]).reshape(-1, 24)
    assert e.raw == pytest.approx(np.linalg.cond(y), rel=1e-3)
    assert e.condition == pytest.approx(np.linalg.cond(y / np.linalg.norm(y, axis=0)), rel=1e-8)


def test_the_optimum_beats_every_random_trajectory() -> None:
    e = ariane4()
    random = random_conditions(e.problem, 20, seed=3)
    assert e.condition < 0.75 * random.min()


def test_a_d_optimal_trajectory_has_the_larger_determinant() -> None:
    arm = ARMS["gravity_arm"]
    common = {"period": 10.0, "velocity": 3.0, "starts": 2, "processes": 1}
    plain = excite(arm, ExcitationOptions(**common))
    better = excite(arm, ExcitationOptions(criterion="d_optimal", **common))

    def determinant(e: Excitation) -> float:
        y = evaluated(e, "regressor", e.signals["q"], e.signals["dq"], e.signals["ddq"])
        return np.linalg.slogdet(np.einsum("tij,tik->jk", y, y))[1]

    assert determinant(better) > determinant(plain)
    assert plain.condition < better.condition


def test_a_trajectory_at_rest_starts_and_ends_without_speed_and_acceleration() -> None:
    e = excite(ARMS["screw_axis"], ExcitationOptions(period=10.0, rest=True, starts=1, processes=1))
    for name in ("dq", "ddq"):
        assert np.abs(e.signals[name][0]).max() < 1e-9 * np.abs(e.signals[name]).max()


@pytest.mark.parametrize("coordinates", ["motor", "joint"])
def test_a_current_limit_holds_with_nominal_parameters(coordinates: str) -> None:
    """A motor of 10 A that a short period would ask for more."""
    e = excite(
        ARMS["screw_axis"],
        ExcitationOptions(period=2.0, rate=100.0, starts=1, processes=1, coordinates=coordinates),
    )
    values = np.array(list(nominal_base(model("screw_axis")).values()))
    current = evaluated(e, "inverse_dynamics", e.signals["q"], e.signals["dq"], e.signals["ddq"], values)
    assert e.signals["input"] == pytest.approx(current)
    assert np.abs(current).max() <= 10.0
    assert np.abs(e.signals["q"]).max() <= 0.25
    assert np.abs(e.signals["dq"]).max() <= 0.5


def test_a_floor_is_kept() -> None:
    """Both links of the planar arm stay on one side of a line; without the box they do not."""
    settings = ExcitationOptions(period=10.0, velocity=3.0, starts=1, iterations=30, processes=1)

    def lowest(e: Excitation) -> float:
        return float((0.538534 * np.cos(e.signals["q"][:, 0])).min())  # x of the second link's frame

    assert lowest(excite(ARMS["gravity_arm"], settings)) < 0.2
    floor = ExcitationOptions(**{**settings.__dict__, "boxes": (box("j2=0.2:,:,:"),)})
    assert lowest(excite(ARMS["gravity_arm"], floor)) >= 0.2


def test_processes_make_no_difference() -> None:
    arm, common = ARMS["gravity_link2"], {"period": 5.0, "velocity": 2.0, "starts": 2, "iterations": 10}
    one, two = (excite(arm, ExcitationOptions(**common, processes=k)) for k in (1, 2))
    assert (one.z == two.z).all()
    assert one.values == two.values


def test_a_worker_keeps_no_other_arm_in_mind() -> None:
    """The same names, other limits, one after the other in the same workers."""
    arm = ARMS["gravity_link2"]
    (i,) = arm.coordinates
    for speed in (2.0, 0.5):
        joints = list(arm.joints)
        joints[i] = replace(joints[i], limits=Limits(velocity=speed))
        slow = replace(arm, joints=tuple(joints))
        one, two = (
            excite(slow, ExcitationOptions(period=5.0, starts=2, iterations=10, processes=k)) for k in (1, 2)
        )
        assert (one.z == two.z).all()
        assert np.abs(two.signals["dq"]).max() <= speed


def run(tmp_path: Path, *arguments: str) -> tuple[int, str, str]:
    result = CliRunner().invoke(app, ["excite", "--out", str(tmp_path / "new" / "a.csv"), *arguments])
    return result.exit_code, result.stdout, result.stderr


def test_the_command_writes_its_files_twice_the_same(tmp_path: Path) -> None:
    given = ("--arm", "gravity_link2", "--velocity", "2", "--starts", "1", "--period", "5", "--json")
    status, out, _ = run(tmp_path, *given)
    assert status == 0
    made = json.loads(out)
    first = {p.name: p.read_bytes() for p in (tmp_path / "new").iterdir()}
    assert set(first) == {"a.csv", "a_set_points.csv", "a.json", "a.svg", "a.html"}
    table = np.genfromtxt(tmp_path / "new" / "a.csv", delimiter=",", names=True)
    assert table.dtype.names == ("t", "q1", "dq1", "ddq1", "qm1", "dqm1")
    assert table["t"][-1] == 5.0
    w, (series,) = 2 * np.pi / 5 * np.arange(1, 6), made["series"]
    q = series["mean"] + np.sin(np.outer(table["t"], w)) @ series["sin"]
    q += np.cos(np.outer(table["t"], w)) @ series["cos"]
    assert table["q1"] == pytest.approx(q, abs=1e-7)
    run(tmp_path, *given)
    assert first == {p.name: p.read_bytes() for p in (tmp_path / "new").iterdir()}


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--arm", "rx90"), "j1 has no speed limit, expected limits: {velocity: ...}"),
        (("--arm", "ariane4", "--period", "-1"), "--period: found -1, expected a positive number"),
        (("--arm", "ariane4", "--criterion", "best"), "found 'best', expected cond or d_optimal"),
        (("--arm", "ariane4", "--box", "j9=:,:,0:"), "found link 'j9', expected one of j1, j2, j3, j4"),
        (("--arm", "ariane4", "--box", "j4=0.1"), "expected LINK=x0:x1,y0:y1,z0:z1"),
        (("--arm", "ariane4", "--rate", "0.1"), "four samples in a period of the highest harmonic"),
        (("--arm", "ariane4", "--harmonics", "1", "--rest"), "expected at least 2 with --rest"),
    ],
)
def test_bad_input_is_one_line_and_nothing_is_written(
    tmp_path: Path, arguments: tuple[str, ...], said: str
) -> None:
    status, out, err = run(tmp_path, *arguments)
    assert (status, out) == (2, "")
    assert said in err
    assert err.count("\n") == 1
    assert list(tmp_path.iterdir()) == []


def test_limits_that_exclude_each_other_are_refused() -> None:
    settings = ExcitationOptions(period=5.0, velocity=2.0, starts=1, processes=1, boxes=(box("j2=2:3,:,:"),))
    with pytest.raises(InputError, match="exclude each other"):
        excite(ARMS["gravity_arm"], settings)


def test_set_points_come_at_the_controller_s_rate(tmp_path: Path) -> None:
    """100 Hz where nothing else is asked; the motion is the same at any."""
    given = ("--arm", "gravity_link2", "--velocity", "2", "--starts", "1", "--period", "5")
    tables = []
    for more in ((), ("--rate", "10")):
        assert run(tmp_path, *given, *more)[0] == 0
        path = tmp_path / "new" / "a_set_points.csv"
        tables.append(np.genfromtxt(path, delimiter=",", names=True))
    fast, slow = tables
    assert np.diff(fast["t"]) == pytest.approx(0.01)
    assert np.diff(slow["t"]) == pytest.approx(0.1)
    assert fast["qm1"][::10] == pytest.approx(slow["qm1"], abs=1e-7)


def test_what_is_determined_worst_is_what_scatters_most_in_the_effort() -> None:
    """By estimates from many records with noise, with the regressor that is emitted."""
    e = ariane4()
    n, p = e.signals["q"].shape[1], len(e.problem.names)
    y = evaluated(e, "regressor", e.signals["q"], e.signals["dq"], e.signals["ddq"]).reshape(-1, n, p)
    rms = np.sqrt(np.mean((y @ np.array(list(nominal_base(model("ariane4")).values()))) ** 2, axis=0))
    noise = 0.01 * rms
    weighted = (y / noise[:, None]).reshape(-1, p)
    norms = np.linalg.norm(weighted, axis=0)
    random = np.random.default_rng(0)
    draws = random.normal(size=(len(weighted), 400))
    errors = np.linalg.lstsq(weighted / norms, draws, rcond=None)[0].T / norms  # (400, p)
    moved = errors.std(axis=0) * np.sqrt(np.mean(y**2, axis=0))  # (n, p)
    shares = 100.0 * moved / rms[:, None]
    found = determined(e)
    assert [x.name for x in found] != list(e.problem.names)
    for x in found:
        k = e.problem.names.index(x.name)
        assert shares[x.joint, k] == pytest.approx(shares[:, k].max())
        assert x.share == pytest.approx(shares[x.joint, k], rel=0.15)  # of 400 draws
        assert x.size == pytest.approx(moved[x.joint, k], rel=0.15)
    assert [x.share for x in found] == sorted((x.share for x in found), reverse=True)


def test_so_many_periods_determine_it_better() -> None:
    """The deviations of a mean fall with the root of how often it is measured."""
    worst = determined(ariane4())[0]
    assert worst.share is not None
    periods = worst.periods(worst.share / 3.3)
    assert worst.share / np.sqrt(periods) <= worst.share / 3.3 < worst.share / np.sqrt(periods - 1)
    assert worst.periods(2.0 * worst.share) == 1
    assert replace(worst, share=None, size=2.5).periods(1.0) == 7


@pytest.mark.parametrize("weighed", [True, False])
def test_friction_by_the_load_asks_for_no_more_than_the_links_weight(weighed: bool) -> None:
    """Its column follows the nominal links; where none are given it has none, and the others are shown."""
    arm = ARMS["rx90"]
    first = arm.coordinates[1]
    friction = EffectUse("load_dependent_friction", {"coefficient": 0.05})
    joint = replace(arm.joints[first], effects=(*arm.joints[first].effects, friction))
    joints = tuple(joint if k == first else j for k, j in enumerate(arm.joints))
    links = arm.links if weighed else (None,) * len(arm.links)
    bare, loaded = (
        excite(
            replace(arm, joints=x, links=links),
            replace(PAPER, velocity=1.0, period=5.0, starts=1, iterations=1),
        )
        for x in (arm.joints, joints)
    )
    assert np.isfinite(loaded.condition)
    assert (loaded.condition == bare.condition) == (not weighed)
