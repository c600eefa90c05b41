"""A drive that modelgen does not have, a scotch yoke, goes through every command by its class alone.

The plant is written over the angle of the crank: no inverse, no gain and no derivative of q_m(q) is shared
with the class.
"""

import ctypes
import importlib.util
import json
import math
import re
import subprocess
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import casadi
import numpy as np
import pytest
from c_support import shared_library
from scipy.integrate import solve_ivp

pytestmark = pytest.mark.xdist_group("made_up_drive")

CRANK, RATIO, MIDDLE, CONSTANT = 0.12, 90.0, 0.3, 0.08
MASS, INERTIA, VISCOUS, DRY, GRAVITY = 20.0, 5e-5, 1e-3, 0.03, 9.81
STIFFNESS = 1500.0  # of a spring that the description does not know
RATE, PERIOD, PERIODS = 100.0, 8.0, 3
SERIES = ((1, 0.55), (2, 0.2), (5, 0.08))  # harmonic and amplitude [rad] of the crank's angle
ARMS = f"""
schema: 1
convention: khalil_kleinfinger
arms:
  press:
    symbols: {{crank_length: {CRANK}}}
    joints:
      - name: ram
        type: prismatic
        limits: {{position: [{MIDDLE - 0.11}, {MIDDLE + 0.11}], velocity: 0.3}}
        drive:
          type: scotch_yoke
          crank: crank_length
          ratio: {RATIO}
          offset: {1000 * MIDDLE} mm
          torque_constant: {CONSTANT}
          motor_velocity: 250
          motor_acceleration: 1200
          current: 30
        effects:
          - viscous_friction: {{coefficient: {VISCOUS}}}
          - coulomb_friction: {{magnitude: {DRY}}}
          - drive_inertia: {{inertia: {INERTIA}}}
    links:
      ram: {{mass: {MASS}, com: [0, 0, 0], inertia: [0.1, 0, 0, 0.1, 0, 0.1]}}
"""


OWN = ["FV1", "FC1", "IA1"]  # parameters of the drive, besides the ten of the link
# When the currents act: where nobody says it, the parameters' deviations hold what the data leave open.
HELD = """schema: 1
time: {column: t, unit: s}
hold: following
joints:
  - {position: {column: qm1, unit: rad, side: motor}, effort: {column: i1, unit: A}}
"""
# States at which functions are compared: the crank's angle, its rates, and with them the yoke's.
ANGLE, SPEED, ACCELERATION = np.array([[-1.2, -0.3, 0.4, 1.1], [2.0, -1.0, 3.0, -0.5], [5.0, 9.0, -7.0, 2.0]])
RATES = {
    "dq": (CRANK * np.cos(ANGLE) * SPEED)[:, None].tolist(),
    "ddq": (CRANK * (np.cos(ANGLE) * ACCELERATION - np.sin(ANGLE) * SPEED**2))[:, None].tolist(),
}
POSITION = {"q": (MIDDLE + CRANK * np.sin(ANGLE))[:, None].tolist()}
VALUES = [MASS, VISCOUS, DRY, INERTIA]
INPUTS = {
    "inverse_dynamics": POSITION | RATES | {"parameters": [VALUES] * len(ANGLE)},
    "drive_gain": POSITION,
    "motor_from_joint": POSITION | RATES,
    "joint_from_motor": {
        "q_m": (RATIO * ANGLE)[:, None].tolist(),
        "dq_m": (RATIO * SPEED)[:, None].tolist(),
        "ddq_m": (RATIO * ACCELERATION)[:, None].tolist(),
    },
}
POINTER = ctypes.POINTER(ctypes.c_double)


def current(angle: np.ndarray, speed: np.ndarray, acceleration: np.ndarray, spring: float) -> np.ndarray:
    """Current [A] that moves the crank so: what it takes at the yoke, and at the motor."""
    q = MIDDLE + CRANK * np.sin(angle)
    ddq = CRANK * (np.cos(angle) * acceleration - np.sin(angle) * speed**2)
    force = MASS * (ddq + GRAVITY) + spring * (q - MIDDLE)
    motor = INERTIA * RATIO * acceleration + VISCOUS * RATIO * speed + DRY * np.sign(speed)
    return np.asarray((force * CRANK * np.cos(angle) / RATIO + motor) / CONSTANT)


def log(path: Path, seed: int, spring: float) -> Path:
    """A record of the motor: its angle at t, to 2e-4 rad, and its current over the following interval, with
    white noise of 0.02 A.
    """
    rng = np.random.default_rng(seed)
    t = np.arange(0.0, PERIOD * PERIODS, 1 / RATE)
    waves = [(2 * np.pi * k / PERIOD, size, rng.uniform(0, 2 * np.pi)) for k, size in SERIES]
    angle = sum(size * np.sin(w * t + phase) for w, size, phase in waves)
    t = t + 0.5 / RATE
    held = sum(size * np.sin(w * t + phase) for w, size, phase in waves)
    speed = sum(size * w * np.cos(w * t + phase) for w, size, phase in waves)
    acceleration = sum(-size * w**2 * np.sin(w * t + phase) for w, size, phase in waves)
    motor = RATIO * angle + 2e-4 * rng.standard_normal(len(t))
    measured = current(held, speed, acceleration, spring) + 0.02 * rng.standard_normal(len(t))
    table = np.column_stack([t - 0.5 / RATE, motor, measured])
    np.savetxt(path, table, "%.9g", ",", header="t,qm1,i1", comments="")
    return path


@dataclass(frozen=True)
class Answer:
    code: int
    said: str
    error: str


@dataclass(frozen=True)
class Session:
    folder: Path
    answers: dict[str, Answer]

    def json(self, command: str) -> dict[str, Any]:
        found = self.answers[command]
        assert found.code == 0, found.error
        made: dict[str, Any] = json.loads(found.said)
        return made


@pytest.fixture(scope="module")
def session(tmp_path_factory: pytest.TempPathFactory) -> Session:
    folder = tmp_path_factory.mktemp("press")
    (folder / "arms.yaml").write_text(ARMS, encoding="utf-8")
    # Phases at which the speed crosses zero steeply: dry friction where it grazes is another subject.
    plain = [str(log(folder / f"plain_{k}.csv", k, 0.0)) for k in range(3)]
    sprung = [str(log(folder / f"sprung_{k}.csv", k, STIFFNESS)) for k in range(3)]

    def records(names: list[str]) -> list[str]:
        return ["--train", names[0], "--train", names[1], "--test", names[2]]

    far = folder / "far.csv"
    # several readings: a lone one is mended
    text = re.sub(r"\n(0\.[0-4]\d*),-?", r"\n\1,-9999", Path(plain[0]).read_text(encoding="utf-8"))
    far.write_text(text, encoding="utf-8")
    bad = folder / "bad.yaml"
    bad.write_text(ARMS.replace(f"crank_length: {CRANK}", "crank_length: -0.1"), encoding="utf-8")
    held = folder / "held.yaml"
    held.write_text(HELD, encoding="utf-8")
    arms, out = folder / "arms.yaml", folder / "out"
    commands: dict[str, list[Any]] = {
        "generate": [arms, "--out", folder / "generated", "--jobs", "1", "--json"],
        "evaluate": [arms, json.dumps(INPUTS)],
        "show": [arms, "--json"],
        "simulate": [arms, "--q0", "0.35", "--dq0", "0", "--duration", "0.3", "--out", folder / "fall.csv"],
        "excite": [
            *(arms, "--out", folder / "excitation.csv", "--period", "10", "--harmonics", "3"),
            *("--starts", "1", "--iterations", "15", "--jobs", "1"),
        ],
        "identify": [arms, *records(plain), "--mapping", held, "--out", out / "identified", "--json"],
        "calibrate": [arms, "--joint", "1", plain[0], "--out", out / "calibrated"],
        "diagnose": [arms, *records(sprung), "--out", out / "diagnosed", "--jobs", "1", "--json"],
        "show bad": [bad],
        "identify far": [arms, *records([str(far), *plain[1:]]), "--out", out / "far"],
    }
    words = [[name.split()[0], *map(str, more)] for name, more in commands.items()]
    script = [sys.executable, str(Path(__file__).with_name("scotch_yoke.py")), json.dumps(words)]
    done = subprocess.run(script, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[-3000:]
    answers = [Answer(*answer) for answer in json.loads(done.stdout)]
    return Session(folder, dict(zip(commands, answers, strict=True)))


def test_generated_code_is_the_drive_s(session: Session) -> None:
    """C, CasADi and NumPy against the plant over the crank's angle."""
    session.json("generate")
    folder = session.folder / "generated" / "press"
    library = ctypes.CDLL(str(shared_library(folder, "press", "double")))
    spec = importlib.util.spec_from_file_location("press_casadi", folder / "press_casadi.py")
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    functions = module.functions()
    numpy = session.json("evaluate")
    expected = {
        "inverse_dynamics": [current(ANGLE, SPEED, ACCELERATION, 0.0)],
        "drive_gain": [CONSTANT * RATIO / (CRANK * np.cos(ANGLE))],
        "motor_from_joint": [RATIO * ANGLE, RATIO * SPEED, RATIO * ACCELERATION],
        "joint_from_motor": [INPUTS["drive_gain"]["q"], RATES["dq"], RATES["ddq"]],
    }
    for name, values in expected.items():
        for true, found in zip(values, numpy[name], strict=True):
            assert np.allclose(np.ravel(found), np.ravel(true), rtol=1e-9, atol=1e-9), name
        for k in range(len(ANGLE)):
            given = [np.array(x[k]) for x in INPUTS[name].values()]
            outputs = [np.zeros(1) for _ in values]
            status = getattr(library, f"press_{name}")(
                *(x.ctypes.data_as(POINTER) for x in [*given, *outputs])
            )
            assert status == 0, name
            symbolic = functions[f"press_{name}"].call([casadi.DM(x) for x in given])
            for true, out, other in zip(values, outputs, symbolic, strict=True):
                assert out[0] == pytest.approx(np.ravel(true)[k], rel=1e-9, abs=1e-9), name
                assert float(other) == pytest.approx(out[0], rel=1e-12, abs=1e-12), name


def test_the_drive_s_inertia_is_told_from_the_mass(session: Session) -> None:
    """Its ratio varies, so that no motion of the yoke has both in the same proportion."""
    shown = session.json("show")
    assert [p["name"] for p in shown["base_parameters"]] == ["M1", "FV1", "FC1", "IA1"]
    assert shown["standard_parameters"][10:] == OWN


def test_a_fall_is_that_of_the_crank(session: Session) -> None:
    """Lagrange's equation over the crank's angle a: T = (MASS (CRANK cos a)^2 + INERTIA RATIO^2) a'^2 / 2."""
    assert session.answers["simulate"].code == 0, session.answers["simulate"].error

    def rates(_: float, state: np.ndarray) -> tuple[float, float]:
        a, speed = state
        c, s = math.cos(a), math.sin(a)
        inertia = MASS * (CRANK * c) ** 2 + INERTIA * RATIO**2
        force = MASS * CRANK**2 * c * s * speed**2 - MASS * GRAVITY * CRANK * c
        return speed, (force - VISCOUS * RATIO**2 * speed + DRY * RATIO) / inertia

    table = np.loadtxt(session.folder / "fall.csv", delimiter=",", skiprows=1)
    t, q, dq = table.T
    start = [math.asin((0.35 - MIDDLE) / CRANK), 0.0]
    true = solve_ivp(rates, (0.0, t[-1]), start, t_eval=t, rtol=1e-10, atol=1e-12)
    assert q[-1] < 0.34
    assert np.allclose(q, MIDDLE + CRANK * np.sin(true.y[0]), atol=2e-5)
    assert np.allclose(dq, CRANK * np.cos(true.y[0]) * true.y[1], atol=5e-4)


def test_an_excitation_keeps_the_limits_of_joint_and_motor(session: Session) -> None:
    assert session.answers["excite"].code == 0, session.answers["excite"].error
    path = session.folder / "excitation.csv"
    names = path.read_text(encoding="utf-8").splitlines()[0].split(",")
    found = dict(zip(names, np.loadtxt(path, delimiter=",", skiprows=1).T, strict=True))
    motor = RATIO * np.arcsin((found["q1"] - MIDDLE) / CRANK)
    assert np.abs(found["q1"] - MIDDLE).max() <= 0.11 + 1e-6
    assert np.abs(found["dq1"]).max() <= 0.3 + 1e-6
    assert np.abs(np.gradient(motor, found["t"])).max() <= 250
    assert np.ptp(found["q1"]) > 0.05


def test_its_parameters_are_identified(session: Session) -> None:
    found = {p["name"]: p for p in session.json("identify")["parameters"]}
    true = {"M1": MASS, "FV1": VISCOUS, "FC1": DRY, "IA1": INERTIA}
    assert set(found) == set(true)
    for name, p in found.items():
        assert abs(p["value"] - true[name]) < 4 * p["std"] + 2e-3 * true[name], name
        assert p["std"] < 0.05 * true[name]


def test_a_spring_at_its_joint_is_named(session: Session) -> None:
    found = session.json("diagnose")
    assert found["verdict"] == "named"
    (cause,) = found["causes"]
    assert (cause["effect"], cause["joint"]) == ("spring", 1)
    stiffness = cause["parameters"]["stiffness"]
    assert abs(stiffness["value"] - STIFFNESS) < 4 * stiffness["std"] + 2e-3 * STIFFNESS


@pytest.mark.parametrize(
    ("command", "said"),
    [
        ("calibrate", "joint 1 (ram) has no lever to calibrate (the arm has no levered drive)"),
        ("show bad", "press.joints.0.drive: expected a crank above 0 and a ratio other than 0"),
        ("identify far", "the limits or the drive's crank, ratio, offset in the description"),
    ],
)
def test_what_it_cannot_do_is_said_in_a_line(session: Session, command: str, said: str) -> None:
    answer = session.answers[command]
    assert answer.code == 2
    assert said in answer.error
    assert len(answer.error.splitlines()) == 1
