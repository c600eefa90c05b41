"""Torque constants from a known payload: Pinocchio's links behind drives that are written anew here."""

from __future__ import annotations

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from arms_support import ARMS
from c_support import Library, flat_c, shared_library
from identification_support import RATE, tapering
from numpy.typing import NDArray
from ruamel.yaml import YAML
from typer.testing import CliRunner
from witness.bodies import Body
from witness.rigid_bodies import RigidBodies

from modelgen.cli.app import app
from modelgen.dataset import Prepared, Record, Settings, prepare
from modelgen.description import Arm, NoDrive, load
from modelgen.errors import InputError
from modelgen.functions import Options, build_model
from modelgen.functions.options import prepared as reduced
from modelgen.identification import identify, verdict

Array = NDArray[np.float64]

RATIO = np.array([100.0, 100.0, 100.0, 50.0, 50.0, 30.0])
DESCRIBED = np.array([0.3, 0.3, 0.3, 0.2, 0.2, 0.2])
TRUE = DESCRIBED * [1.12, 0.91, 1.05, 0.85, 1.2, 0.95]  # N m/A
INERTIA = np.array([4e-4, 4e-4, 3e-4, 1e-4, 1e-4, 1e-4])  # kg m^2, at the motor
VISCOUS = np.array([1e-3, 2e-3, 1e-3, 5e-4, 4e-4, 3e-4])
DRY = np.array([0.3, 0.4, 0.3, 0.1, 0.08, 0.06])
PAYLOAD = (4.0, 0.1, -0.05, 0.25)  # kg, m
OPTIONS = Options(gains="estimated")
FILE = Path(__file__).resolve().parents[2] / "arms.yaml"


def loaded(body: Body) -> Body:
    """The last link with the payload on it, by the theorem of Huygens and Steiner."""
    m, at = PAYLOAD[0], np.array(PAYLOAD[1:])
    mass = body.mass + m
    com = (body.mass * body.com + m * at) / mass
    inertia = body.inertia.copy()
    for size, d in ((body.mass, body.com - com), (m, at - com)):
        inertia = inertia + size * (d @ d * np.eye(3) - np.outer(d, d))
    return Body(mass, com, inertia)


def record(arm: Arm, bodies: list[Body], seed: int, seconds: float = 20.0, noise: float = 0.01) -> Record:
    """Currents of the drives along a motion of several frequencies, with noise as a part of their RMS."""
    t = np.arange(round(seconds * RATE)) / RATE
    n, rng = len(RATIO), np.random.default_rng(seed)
    q, dq, ddq = np.zeros((len(t), n)), np.zeros((len(t), n)), np.zeros((len(t), n))
    for w in 2 * np.pi * np.array([0.11, 0.31, 0.57, 0.83]):
        a, b = rng.uniform(-0.35, 0.35, (2, n))
        s, c = np.sin(w * t)[:, None], np.cos(w * t)[:, None]
        q, dq, ddq = q + a * s + b * c, dq + w * (a * c - b * s), ddq - w * w * (a * s + b * c)
    links = RigidBodies(reduced(arm, Options(without=frozenset({"drives", "effects"}))), bodies)
    joint = np.array([links.effort(*x) for x in zip(q, dq, ddq, strict=True)])
    speed = RATIO * dq
    motor = joint / RATIO + INERTIA * RATIO * ddq + VISCOUS * speed + DRY * np.sign(speed)
    current = motor / TRUE
    current += noise * np.sqrt(np.mean(current**2, axis=0)) * rng.normal(size=current.shape)
    ones = np.ones_like(current)
    return Record(f"run {seed}", t, q, q * RATIO, input=current, gain=ones, effort_unit=("A",) * n, arm=arm)


@pytest.fixture(scope="module")
def records() -> tuple[Arm, list[Body], list[Prepared]]:
    """Without, with, and again with the payload."""
    arm, bodies = ARMS["rx90"], tapering(5)
    heavy = [*bodies[:-1], loaded(bodies[-1])]
    made = [record(arm, b, seed) for seed, b in ((1, bodies), (2, heavy), (3, heavy))]
    return arm, bodies, [prepare(r, Settings(cutoff=8.0)) for r in made]


def test_a_known_payload_shows_the_torque_constants(
    records: tuple[Arm, list[Body], list[Prepared]],
) -> None:
    arm, _, (light, heavy, other) = records
    carried = {1: PAYLOAD, 2: PAYLOAD}
    found = identify([light, heavy], arm, OPTIONS, test=[other], payloads=carried)
    value = np.array([g.value for g in found.gains])
    std = np.array([g.std for g in found.gains])
    assert [g.joint for g in found.gains] == [1, 2, 3, 4, 5, 6]
    assert value == pytest.approx(TRUE, rel=0.02)
    assert np.abs((value - TRUE) / std).max() < 4
    assert found.test is not None
    assert found.test.nrmse_percent.max() < 3.0
    # What is found goes back to the description: the model of the known constants has the same errors.
    known = identify([light, heavy], found.arm, test=[other], payloads=carried)
    assert known.test is not None
    assert known.test.rmse == pytest.approx(found.test.rmse, rel=0.02)
    friction = {e.standard: e.value for e in found.estimates}
    assert [friction[f"FC{j}"] for j in range(1, 7)] == pytest.approx(DRY, rel=0.05)
    # The described constants cannot have the payload's weight and the links' both.
    wrong = identify([light, heavy], arm, test=[other], payloads=carried)
    assert wrong.test is not None
    assert wrong.test.rmse.max() > 2 * found.test.rmse.max()


def write_csv(made: Record, path: Path) -> str:
    """The record as a log of joint positions and currents."""
    assert made.input is not None
    n = made.n
    names = ["t", *(f"q{k + 1}" for k in range(n)), *(f"i{k + 1}" for k in range(n))]
    table = np.column_stack([made.t, made.q, made.input])
    np.savetxt(path, table, fmt="%.10g", delimiter=",", header=",".join(names), comments="")
    return str(path)


@pytest.fixture(scope="module")
def written(tmp_path_factory: pytest.TempPathFactory) -> tuple[list[Body], list[str], Path]:
    """Logs of an arm without, with, and again without the payload, and what identify makes of them."""
    arm, bodies = ARMS["rx90"], tapering(5)
    folder = tmp_path_factory.mktemp("gains")
    heavy = [*bodies[:-1], loaded(bodies[-1])]
    runs = ((1, "light", bodies), (2, "heavy", heavy), (3, "test", bodies))
    logs = [write_csv(record(arm, b, seed, seconds=12.0), folder / f"{name}.csv") for seed, name, b in runs]
    payload = ",".join(map(str, PAYLOAD))
    call = ["identify", str(FILE), "--arm", "rx90", "--train", logs[0], "--train", logs[1], "--test", logs[2]]
    call += ["--cutoff", "8", "--gains", "estimated", "--payload", f"{logs[1]}={payload}"]
    result = CliRunner().invoke(app, [*call, "--out", str(folder / "out")])
    assert result.exit_code == 0, result.output
    assert "torque constants" in result.output
    return bodies, logs, folder / "out"


def test_what_is_found_reaches_the_compiled_functions(
    written: tuple[list[Body], list[str], Path], tmp_path: Path
) -> None:
    bodies, _, out = written
    found = load(out / "rx90_identified.yaml")["rx90"]
    constants = [j.drive.torque_constant for j in found.joints]  # type: ignore[union-attr]
    assert constants == pytest.approx(TRUE, rel=0.02)
    data = json.loads((out / "identification.json").read_text(encoding="utf-8"))
    assert [x["value"] for x in data["torque_constants"]] == pytest.approx(constants)
    # The parameters lie beside that description: generate takes them without being told.
    call = ["generate", str(out / "rx90_identified.yaml"), "--out", str(tmp_path), "-j", "1"]
    result = CliRunner().invoke(app, call)
    assert result.exit_code == 0, result.output
    names = yaml(out / "rx90_parameters.yaml")["parameters"]
    model = build_model(found, Options(identified=names))
    library = Library(shared_library(tmp_path / "rx90", "rx90", "double"), model, "double")
    links = RigidBodies(reduced(found, Options(without=frozenset({"drives", "effects"}))), bodies)
    rng = np.random.default_rng(9)
    got, true = [], []
    for _ in range(50):
        q, dq, ddq = rng.uniform(-0.8, 0.8, 6), rng.uniform(-1.5, 1.5, 6), rng.uniform(-4, 4, 6)
        status, outputs = library.call("inverse_dynamics_identified", q, dq, ddq)
        assert status == 0
        got.append(flat_c(outputs))
        motor = links.effort(q, dq, ddq) / RATIO + INERTIA * RATIO * ddq
        true.append((motor + VISCOUS * RATIO * dq + DRY * np.sign(dq)) / TRUE)
    error = np.linalg.norm(np.array(got) - true, axis=0) / np.linalg.norm(true, axis=0)
    assert error.max() < 0.03


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--gains", "estimated"], "share a scale that no record shows"),
        (["--gains", "estimated", "--method", "iv"], "expected ols, wls, gls or robust"),
        (["--gains", "estimated", "--payload", "none.csv=2"], "expected LOG=KG"),
        (["--gains", "estimated", "--payload", "{log}"], "expected LOG=KG"),
        (["--gains", "estimated", "--payload", "{log}="], "expected a mass above 0 kg"),
        (["--gains", "estimated", "--payload", "{log}=-1"], "expected a mass above 0 kg"),
        (["--gains", "estimated", "--payload", "{log}=1,2"], "expected MASS or MASS,X,Y,Z"),
        (["--gains", "estimated", "--payload", "{log}=heavy"], "'heavy'"),
        (["--gains", "row_wise", "--consistent"], "no common scale"),
        (["--gains", "row_wise", "--instrument", "simulated"], "without a common scale cannot be simulated"),
        (["--gains", "row_wise", "--payload", "{log}=2"], "no common scale"),
        (["--stream", "--gains", "estimated"], "needs all rows at once"),
        (["--stream", "--essential"], "needs all rows at once"),
        (["--method", "iv", "--instrument", "period"], "found no motion that repeats"),
        (["--method", "iv", "--instrument", "none"], "expected auto, period, simulated"),
        (["--method", "iv", "--bandwidth", "0"], "--bandwidth: found 0"),
        (["--method", "iv", "--control", "lqr"], "--control lqr"),
        (["--method", "iv", "--reference", "none.csv"], "none.csv"),
        (["--method", "2sls"], "found '2sls'"),
    ],
)
def test_options_that_make_no_sense_get_one_line(
    written: tuple[list[Body], list[str], Path], tmp_path: Path, options: list[str], message: str
) -> None:
    _, logs, _ = written
    call = ["identify", str(FILE), "--arm", "rx90", "--train", logs[0], "--test", logs[2], "--cutoff", "8"]
    call += [o.format(log=logs[0]) for o in options]
    result = CliRunner().invoke(app, [*call, "--out", str(tmp_path / "out")])
    assert result.exit_code == 2, result.output
    assert message in result.output
    assert result.output.count("\n") == 1
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda text: text.replace("FV1: ", "FV1: .nan #"), "FV1 is nan"),
        (lambda text: text.replace("FV1: ", "FV1: 1.0.0 #"), "a number by each name"),
        (lambda text: text.replace("FV1: ", "FV9: "), "missing FV1; unknown FV9"),
        (lambda text: text + "  FV1: 0.1\n", "DuplicateKeyError"),
        (lambda text: text.replace("arm: rx90", "arm: other"), "belongs to the arm 'other'"),
        (lambda _: "- 1\n", "a number by each name"),
    ],
)
def test_parameters_beside_the_description_that_do_not_fit_are_refused(
    written: tuple[list[Body], list[str], Path],
    tmp_path: Path,
    change: Callable[[str], str],
    message: str,
) -> None:
    _, _, out = written
    for name in ("rx90_identified.yaml", "rx90_parameters.yaml"):
        text = (out / name).read_text(encoding="utf-8")
        (tmp_path / name).write_text(change(text) if "parameters" in name else text, encoding="utf-8")
    call = ["generate", str(tmp_path / "rx90_identified.yaml"), "--out", str(tmp_path / "code"), "-j", "1"]
    result = CliRunner().invoke(app, call)
    assert result.exit_code == 2, result.output
    assert message in result.output
    assert result.output.count("\n") == 1
    assert not (tmp_path / "code").exists()


def yaml(path: Path) -> dict[str, dict[str, float]]:
    """A file of parameters."""
    found: dict[str, dict[str, float]] = YAML(typ="safe").load(path.read_text(encoding="utf-8"))
    return found


def test_without_a_payload_the_scale_is_refused(records: tuple[Arm, list[Body], list[Prepared]]) -> None:
    arm, _, (light, heavy, _) = records
    with pytest.raises(InputError, match="share a scale"):
        identify([light, heavy], arm, OPTIONS)


def test_a_payload_that_shows_nothing_is_refused(records: tuple[Arm, list[Body], list[Prepared]]) -> None:
    arm, _, (light, heavy, _) = records
    with pytest.raises(InputError, match="do not determine the gain of joint j"):
        identify([light, heavy], arm, OPTIONS, payloads={0: (1e-4,)})


def test_without_drives_there_is_no_gain(records: tuple[Arm, list[Body], list[Prepared]]) -> None:
    arm, _, (light, *_) = records
    bare = replace(arm, joints=tuple(replace(j, drive=NoDrive()) for j in arm.joints))
    with pytest.raises(InputError, match="no joint has a drive"):
        identify([light], bare, OPTIONS, payloads={0: (1.0,)})


def test_rows_of_their_own_predict_as_well_whatever_the_constants(
    records: tuple[Arm, list[Body], list[Prepared]],
) -> None:
    arm, _, (_, heavy, other) = records
    found = identify([heavy], arm, Options(gains="row_wise"), test=[other])
    assert found.test is not None
    assert found.test.nrmse_percent.max() < 5.0
    common = identify([heavy], arm, test=[other])
    assert common.test is not None
    assert (found.test.rmse < common.test.rmse).any()
    assert len(found.estimates) > len(common.estimates)
    for more in ({"physical": True}, {"payloads": {0: (1.0,)}}):
        with pytest.raises(InputError, match="no common scale"):
            identify([heavy], arm, Options(gains="row_wise"), **more)  # type: ignore[arg-type]


def test_a_fit_with_the_essential_parameters_alone(
    records: tuple[Arm, list[Body], list[Prepared]],
) -> None:
    arm, bodies, (*_, other) = records
    arm = with_true_constants(arm)
    noisy = prepare(record(arm, bodies, 4, seconds=12.0, noise=0.3), Settings(cutoff=8.0))
    whole = identify([noisy], arm, test=[other])
    few = identify([noisy], arm, test=[other], essential_only=True)
    kept = [e for e in few.estimates if not e.dropped]
    assert len(kept) < len(whole.estimates)
    assert all(e.essential for e in kept)
    assert all(e.value == 0.0 and e.std is None for e in few.estimates if e.dropped)
    assert whole.test is not None
    assert few.test is not None
    assert (few.test.rmse < 1.1 * whole.test.rmse).all()
    assert "Left out" in verdict(few)


def with_true_constants(arm: Arm) -> Arm:
    """The description with the true torque constants."""
    joints = tuple(
        replace(j, drive=replace(j.drive, torque_constant=float(k)))  # type: ignore[call-arg]
        for j, k in zip(arm.joints, TRUE, strict=True)
    )
    return replace(arm, joints=joints)
