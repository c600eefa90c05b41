"""Output-error refinement: exact derivatives, values found again, what motions alone cannot tell."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from arms_support import ARMS
from plant import HIDDEN, PUBLISHED
from simulation_support import middle
from typer.testing import CliRunner

from modelgen.cli.app import app
from modelgen.dataset import prepare, read
from modelgen.identification.output_error.sensitivities import Sensitive
from modelgen.simulation import Reference, computed_torque, plant, replay, simulate

pytestmark = pytest.mark.xdist_group("gravity_test")
TRUTH = replace(PUBLISHED, viscous=0.3, coulomb=0.12)


def invoked(*words: str) -> tuple[int, str, str]:
    done = CliRunner().invoke(app, ["refine", *words])
    return done.exit_code, done.stdout, " ".join(done.stderr.split())


@pytest.fixture(scope="module")
def swings(tmp_path_factory: pytest.TempPathFactory) -> list[str]:
    """Two swings of another link 2, of the independent plant: the second held by a hand for half a second."""
    folder, files = tmp_path_factory.mktemp("swings"), []
    random = np.random.default_rng(3)
    t = np.arange(1001) / 200
    for degrees, held in ((25, 0), (40, 100)):
        q = np.concatenate([np.full(held, np.radians(degrees)), TRUTH.swing(np.radians(degrees), t)])
        table = np.column_stack([np.arange(len(q)) / 200, q + 2e-4 * random.standard_normal(len(q))])
        files.append(str(folder / f"{degrees}.csv"))
        np.savetxt(files[-1], table, delimiter=",", header="t,q1", comments="", fmt="%.7g")
    return files


@pytest.mark.parametrize(("name", "q0"), [("gravity_link2", [0.5]), ("gravity_arm", [0.5, 0.3])])
def test_derivatives_through_stick_and_slip(name: str, q0: list[float]) -> None:
    """Against central differences of the same motion, and the motion against variable steps."""
    made = plant(ARMS[name])
    n, t = made.n, np.arange(600) / 200
    s = Sensitive(made, range(len(made.parameters)))
    y0, u = np.concatenate([q0, np.zeros(n)]), np.zeros((len(t), n))
    path, slopes = s.run(y0, t, u, made.parameters)
    exact = simulate(made, q0, 0.0, t[-1], 200.0)
    np.testing.assert_allclose(path[:, :n], exact.q, atol=1e-6)
    assert (np.diff(np.sign(path[:, n])) != 0).sum() > 3
    for k, value in enumerate(made.parameters):
        change = np.zeros(len(made.parameters))
        change[k] = h = 1e-6 * max(1.0, abs(value))
        ahead, back = (s.run(y0, t, u, made.parameters + e * change)[0] for e in (1, -1))
        slope = (ahead - back)[:, :n] / (2 * h)
        np.testing.assert_allclose(slopes[:, :n, 2 * n + k], slope, atol=1e-5 * np.abs(slope).max())


def test_friction_is_found_from_motion_alone(swings: list[str], tmp_path: Path) -> None:
    logs = [word for file in swings for word in ("--log", file)]
    status, out, said = invoked("--arm", "gravity_link2", *logs, "--out", str(tmp_path / "r"), "--json")
    assert status == 0, said
    data = json.loads(out)
    found = {x["name"]: x for x in data["parameters"]}
    for name, truth in (("FV1", 0.3), ("FC1", 0.12)):
        assert abs(found[name]["value"] - truth) < 4 * found[name]["std"] < 0.01 * truth
    assert all(found[name]["std"] is None for name in ("ZZ1", "MX1", "MY1"))
    (joint,) = data["joints"]
    # what remains is the noise
    assert joint["rmse"] == pytest.approx(2e-4, rel=0.1)
    assert joint["f_gof"] > 99.5
    assert joint["rmse_before"] > 10 * joint["rmse"]  # from the initial states that suit it best, too
    assert data["converged"]
    assert sorted(p.name for p in (tmp_path / "r").iterdir()) == [
        "gravity_link2_parameters.yaml",
        "refinement.json",
        "refinement.svg",
        "report.html",
    ]
    call = ["simulate", "--arm", "gravity_link2", "--log", swings[0], "--json"]
    call += ["--parameters", str(tmp_path / "r/gravity_link2_parameters.yaml")]
    done = CliRunner().invoke(app, call)
    assert json.loads(done.stdout)["joints"][0]["f_gof_percent"] > 98


def test_inertia_is_found_where_friction_is_held(swings: list[str], tmp_path: Path) -> None:
    """The user's choice: with friction held, it gives the scale, and ZZ1 is free."""
    words = ["--arm", "gravity_link2", "--log", swings[1], "--free", "ZZ1", "--free", "FV1", "--free", "FC1"]
    status, out, said = invoked(*words, "--out", str(tmp_path / "r"), "--json")
    assert status == 0, said
    found = {x["name"]: x for x in json.loads(out)["parameters"]}
    assert abs(found["ZZ1"]["value"] - TRUTH.inertia) < 4 * found["ZZ1"]["std"] < 0.01 * TRUTH.inertia
    assert found["MX1"]["std"] is None


def test_with_efforts_everything_is_tuned(tmp_path: Path) -> None:
    """Given efforts fix the scale: the links' parameters come back from values that are 15 % off."""
    made = plant(ARMS["gravity_link2"])
    t = np.arange(801) / 200
    effort = (4.0 * np.sin(3.0 * t) + 2.0 * np.sin(7.3 * t + 1.0))[:, None]
    run = simulate(made, 0.3, 0.0, 4.0, 200.0, effort)
    random = np.random.default_rng(0)
    table = np.column_stack([t, run.q + 1e-4 * random.standard_normal(run.q.shape), effort])
    log, start = tmp_path / "log.csv", tmp_path / "start.yaml"
    np.savetxt(log, table, delimiter=",", header="t,q1,tau1", comments="", fmt="%.8g")
    names = [b.name for b in made.model.grouping.base]
    values = dict(zip(names, made.parameters, strict=True))
    text = "".join(f"  {k}: {1.15 * v!s}\n" for k, v in values.items())
    start.write_text(f"schema: 1\narm: gravity_link2\nparameters:\n{text}", encoding="utf-8")
    words = ["--arm", "gravity_link2", "--log", str(log), "--parameters", str(start)]
    status, out, said = invoked(*words, "--out", str(tmp_path / "r"), "--json")
    assert status == 0, said
    for x in json.loads(out)["parameters"]:
        assert abs(x["value"] - values[x["name"]]) < max(5 * x["std"], 2e-3), x
        assert x["std"] < 0.02


def test_friction_of_levered_drives_by_windows(tmp_path: Path) -> None:
    """Under currents, with windows of half a second, from values 30 % too high."""
    made = plant(ARMS["ariane4"])
    t, q0 = np.arange(401) / 200, middle(made)
    sway = np.stack([np.sin(3 * t), np.sin(2 * t), np.sin(4 * t)], axis=1)
    run = simulate(made, q0, 0.0, 2.0, 200.0, computed_torque(made, Reference(t, q0 + 0.1 * sway), 5.0))
    assert not run.ended
    q = run.q + 1e-5 * np.random.default_rng(0).standard_normal(run.q.shape)
    log, start = tmp_path / "log.csv", tmp_path / "start.yaml"
    table = np.column_stack([t, q, run.input])
    np.savetxt(log, table, delimiter=",", header="t,q1,q2,q3,i1,i2,i3", comments="", fmt="%.9g")
    names = [b.name for b in made.model.grouping.base]
    truth = dict(zip(names, made.parameters, strict=True))
    free = [name for name in names if name[:2] in ("FC", "FV")]
    text = "".join(f"  {k}: {v * (1.3 if k in free else 1.0)!s}\n" for k, v in truth.items())
    start.write_text(f"schema: 1\narm: ariane4\nparameters:\n{text}", encoding="utf-8")
    words = ["--arm", "ariane4", "--log", str(log), "--parameters", str(start), "--window", "0.5"]
    words += [word for name in free for word in ("--free", name)]
    status, out, said = invoked(*words, "--out", str(tmp_path / "r"), "--json")
    assert status == 0, said
    found = {x["name"]: x["value"] for x in json.loads(out)["parameters"]}
    assert len(free) == 6
    for name in free:
        assert found[name] == pytest.approx(truth[name], rel=0.01)


def test_a_replay_holds_the_efforts_as_they_were_held(tmp_path: Path) -> None:
    """At 50 samples per second, half a sample of delay would leave errors of 0.02 rad."""
    made = plant(ARMS["gravity_link2"])
    t = np.arange(201) / 50
    effort = (4.0 * np.sin(3.0 * t) + 2.0 * np.sin(7.3 * t + 1.0))[:, None]
    run = simulate(made, 0.3, 0.0, 4.0, 50.0, effort)
    log = tmp_path / "log.csv"
    table = np.column_stack([t, run.q, effort])
    np.savetxt(log, table, delimiter=",", header="t,q1,tau1", comments="", fmt="%.12g")
    prepared = prepare(read(str(log), ARMS["gravity_link2"]))
    found = replay(made, prepared, start=(np.array([0.3]), np.zeros(1)))
    assert found.scores.rmse[0] < 5e-4


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (["--free", "FX9"], "--free FX9: found no such base parameter"),
        (["--free=ZZ1", "--free=MX1", "--free=FV1", "--free=FC1"], "do not tell"),
        (["--window", "0.01"], "samples in a window"),
        (["--log", "missing.csv"], "missing.csv"),
    ],
)
def test_bad_input_is_one_line(words: list[str], expected: str, swings: list[str], tmp_path: Path) -> None:
    out = tmp_path / "r"
    status, _, said = invoked("--arm", "gravity_link2", "--log", swings[0], *words, "--out", str(out))
    assert status == 2
    assert expected in said
    assert "Traceback" not in said
    assert not out.exists()


LINK = """schema: 1
convention: khalil_kleinfinger
arms:
  link:
    gravity: [9.81, 0, 0]
    joints:
    - name: j2
      drive: {type: none}
      effects: [viscous_friction: {coefficient: 0.2358}, coulomb_friction: {magnitude: 0.1873},
        spring: {stiffness: 1.02, preload: -0.322}%s]
    links: {j2: {mass: 6.74322, com: [0.193949, 0, 0], inertia: [0.01, 0, 0, 0.056, 0, 0.056052]}}
"""


def test_stiction_is_found_in_swings_that_end_beside_the_rest_angle(tmp_path: Path) -> None:
    """The plant's static friction, of another form, shows in the motion as lower friction at speed."""
    random, logs, t = np.random.default_rng(4), [], np.arange(1001) / 200
    for degrees in (20, 30, 40):
        q = HIDDEN.swing(np.radians(degrees), t) + 2e-4 * random.standard_normal(len(t))
        file = str(tmp_path / f"{degrees}.csv")
        np.savetxt(file, np.column_stack([t, q]), delimiter=",", header="t,q1", comments="", fmt="%.7g")
        logs += ["--log", file]
    found = {}
    for name, more in (("without", ""), ("with", ", stribeck_friction: {velocity: 0.14, magnitude: 0.05}")):
        arms = tmp_path / f"{name}.yaml"
        arms.write_text(LINK % more, encoding="utf-8")
        status, out, said = invoked(
            str(arms), "--arm", "link", *logs, "--out", str(tmp_path / name), "--json"
        )
        assert status == 0, said
        found[name] = json.loads(out)
    assert found["with"]["joints"][0]["rmse"] < found["without"]["joints"][0]["rmse"] / 3
    values = {x["name"]: x for x in found["with"]["parameters"]}
    assert values["FS1"]["value"] > 10 * values["FS1"]["std"]
    assert values["FC1"]["value"] == pytest.approx(HIDDEN.coulomb, rel=0.05)
    assert values["KS1"]["value"] == pytest.approx(HIDDEN.stiffness, rel=0.02)


def test_a_bound_holds_its_parameter_and_not_the_others(tmp_path: Path) -> None:
    """A link that is driven a little: its viscous friction would be negative, the dry one is there."""
    made, log = plant(ARMS["gravity_link2"]), tmp_path / "log.csv"
    names = [b.name for b in made.model.grouping.base]
    values = made.parameters.copy()
    values[names.index("FV1")], values[names.index("FC1")] = -0.02, 0.12
    run = simulate(plant(ARMS["gravity_link2"], dict(zip(names, values, strict=True))), 0.5, 0.0, 3.0, 200.0)
    q = run.q + 1e-4 * np.random.default_rng(2).standard_normal(run.q.shape)
    np.savetxt(log, np.column_stack([run.t, q]), delimiter=",", header="t,q1", comments="", fmt="%.7g")
    words = ["--arm", "gravity_link2", "--log", str(log), "--out", str(tmp_path / "r"), "--json"]
    status, out, said = invoked(*words)
    assert status == 0, said
    both = json.loads(out)
    assert both["converged"]
    assert both["steps"] < 15
    # The same as where there is no viscous friction to begin with.
    start = tmp_path / "start.yaml"
    without = dict(zip(names, made.parameters, strict=True)) | {"FV1": 0.0}
    text = "".join(f"  {k}: {v!s}\n" for k, v in without.items())
    start.write_text(f"schema: 1\narm: gravity_link2\nparameters:\n{text}", encoding="utf-8")
    status, out, said = invoked(*words, "--parameters", str(start), "--free", "FC1")
    assert status == 0, said
    found, alone = ({x["name"]: x["value"] for x in d["parameters"]} for d in (both, json.loads(out)))
    assert 0 <= found["FV1"] < 1e-3
    assert found["FC1"] == pytest.approx(alone["FC1"], rel=0.02)


def test_a_motion_that_the_arm_cannot_make_ends_with_exit_code_1(tmp_path: Path) -> None:
    """A link that wanders at random: steps promise much and bring nothing."""
    random, log = np.random.default_rng(5), tmp_path / "log.csv"
    t = np.arange(601) / 200
    q = 0.3 + 0.02 * np.cumsum(random.standard_normal(len(t)))
    np.savetxt(log, np.column_stack([t, q]), delimiter=",", header="t,q1", comments="", fmt="%.7g")
    words = ["--arm", "gravity_link2", "--log", str(log), "--out", str(tmp_path / "r")]
    status, out, said = invoked(*words, "--json")
    assert status == 1
    assert said.startswith("not converged: step")
    data = json.loads(out)
    assert not data["converged"]
    assert data["stopped"] in said
