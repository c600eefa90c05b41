"""An exported FMU in FMPy moves as `simulate` does, dry friction and levers included."""

from __future__ import annotations

import ctypes
import re
import subprocess
import zipfile
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import fmpy
import numpy as np
import pytest
from exporting_support import Array
from fmpy import extract, read_model_description, simulate_fmu
from fmpy.fmi2 import FMU2Slave
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu

import modelgen as mg
from modelgen.dataset import drives_of
from modelgen.description.objects import EffectUse
from modelgen.native import compiler, library
from modelgen.simulation.plant import plant
from modelgen.simulation.simulate import simulate

ARMS = mg.load_arms(Path(__file__).parents[2] / "arms.yaml")
RATE, SAMPLES = 500.0, 101
VERSIONS = ("2.0", "3.0")

pytestmark = pytest.mark.skipif(compiler() is None, reason="needs a C compiler")


class Unit:
    """A unit in FMPy, initialised."""

    def __init__(self, path: Path, folder: Path) -> None:
        described = read_model_description(str(path), validate=True)
        self.variables = {v.name: v for v in described.modelVariables}
        self.second = described.fmiVersion == "2.0"
        self.slave = (FMU2Slave if self.second else FMU3Slave)(
            guid=described.guid or described.instantiationToken,
            unzipDirectory=extract(str(path), unzipdir=str(folder)),
            modelIdentifier=described.coSimulation.modelIdentifier,
            instanceName="arm",
        )
        self.slave.instantiate()
        self.begin()

    def begin(self, **start: float) -> None:
        if self.second:
            self.slave.setupExperiment(startTime=0.0)
        self.slave.enterInitializationMode()
        for name, value in start.items():
            self[name] = value
        self.slave.exitInitializationMode()

    def __getitem__(self, name: str) -> float:
        get = self.slave.getReal if self.second else self.slave.getFloat64
        return float(get([self.variables[name].valueReference])[0])

    def __setitem__(self, name: str, value: float) -> None:
        put = self.slave.setReal if self.second else self.slave.setFloat64
        put([self.variables[name].valueReference], [float(value)])

    def kept(self) -> bytes:
        if self.second:
            return bytes(self.slave.serializeFMUstate(self.slave.getFMUstate()))
        return bytes(self.slave.serializeFMUState(self.slave.getFMUState()))

    def taken_up(self, kept: bytes) -> None:
        if self.second:
            self.slave.setFMUstate(self.slave.deSerializeFMUstate(kept))
        else:
            self.slave.setFMUState(self.slave.deserializeFMUState(kept))

    def moved(self, names: list[str], inputs: Array, first: int = 0) -> Array:
        """Coordinates (S, n) with inputs (S, n) held from sample to sample, the last of no effect."""
        path = [[self[f"{name}.q"] for name in names]]
        for k, row in enumerate(inputs[:-1], first):
            for name, value in zip(names, row, strict=True):
                self[f"{name}.input"] = value
            self.slave.doStep(k / RATE, 1 / RATE)
            path.append([self[f"{name}.q"] for name in names])
        return np.array(path)


def names_of(arm: mg.Arm) -> list[str]:
    return [arm.joints[i].name for i in arm.coordinates]


def waves(*sizes: float) -> Array:
    t = np.arange(SAMPLES) / RATE
    return np.stack([a * np.sin(2 * np.pi * (2 + k) * t) for k, a in enumerate(sizes)], axis=1)


@pytest.fixture(scope="module", params=VERSIONS)
def made(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Iterator[Unit]:
    folder = tmp_path_factory.mktemp("unit")
    mg.export(ARMS["gravity_arm"], to="fmu", out=folder / "arm.fmu", fmi=request.param)
    made = Unit(folder / "arm.fmu", folder / "unit")
    yield made
    made.slave.freeInstance()


@pytest.fixture
def unit(made: Unit) -> Unit:
    made.slave.reset()
    made.begin()
    return made


@pytest.mark.parametrize(
    ("name", "sizes", "fmi"),
    [
        ("gravity_arm", (4.0, 1.5), "3.0"),
        ("ariane4", (2.0, 2.5, 1.5), "2.0"),
        ("ariane4", (2.0, 2.5, 1.5), "3.0"),
    ],
)
def test_the_motion_is_that_of_simulate(
    name: str, sizes: tuple[float, ...], fmi: str, tmp_path: Path
) -> None:
    arm, path = ARMS[name], tmp_path / "arm.fmu"
    model = mg.export(arm, to="fmu", out=path, fmi=fmi)
    assert {row.status for row in model.rows} == {"exact"}
    assert validate_fmu(str(path)) == []
    names, inputs = names_of(arm), waves(*sizes)
    made = Unit(path, tmp_path / "unit")
    q0 = [made[f"{joint}.q"] for joint in names]
    found = made.moved(names, inputs)
    expected = simulate(plant(arm), q0, 0.0, (SAMPLES - 1) / RATE, RATE, inputs, method="DOP853")
    assert expected.ended == ""
    assert np.ptp(expected.q, axis=0).min() > 1e-3
    assert np.abs(found - expected.q).max() <= 1e-9
    for n, (joint, drive) in enumerate(zip(names, drives_of(arm), strict=True)):
        q, dq = found[-1:, n], made[f"{joint}.dq"]
        assert made[f"{joint}.motor"] == pytest.approx(drive.motor(q)[0], rel=1e-12)
        assert made[f"{joint}.motor_rate"] == pytest.approx(drive.k1(q)[0] * dq, rel=1e-9)
    made.slave.freeInstance()


@pytest.mark.parametrize("fmi", VERSIONS)
def test_states_of_effects_move_along(fmi: str, tmp_path: Path) -> None:
    uses = (
        EffectUse("joint_flexibility", {"stiffness": 0.5, "damping": 1e-3}),
        EffectUse("drive_inertia", {"inertia": 3e-4}),
        EffectUse("coulomb_friction", {"magnitude": 0.02, "smoothing": 0.1}),
        EffectUse("friction_warm_up", {"dry": 0.01, "viscous": 1e-4, "time": 2.0, "speed": 10.0}),
    )
    link, geared = ARMS["gravity_link1"], ARMS["puma560"].joints[0].drive
    arm = replace(link, joints=(replace(link.joints[0], drive=geared, effects=uses),))
    model = mg.export(arm, to="fmu", out=tmp_path / "arm.fmu", fmi=fmi)
    assert [row.status for row in model.rows] == ["exact", "exact", "approximated", "exact"]
    made, inputs = Unit(tmp_path / "arm.fmu", tmp_path / "unit"), waves(6.0)
    found = made.moved(["j1"], inputs)
    duration = (SAMPLES - 1) / RATE
    expected = simulate(plant(arm), 0.0, 0.0, duration, RATE, inputs, method="LSODA", rtol=1e-11, atol=1e-12)
    assert np.abs(found - expected.q).max() <= 1e-9
    states = [made[name] for name in made.variables if name.startswith("state.")]
    assert states == pytest.approx(expected.states[-1].tolist(), abs=1e-7)
    assert min(np.abs(states)) > 1e-4
    made.slave.freeInstance()


@pytest.mark.parametrize("fmi", VERSIONS)
def test_model_exchange_finds_where_an_arm_comes_to_rest(fmi: str, tmp_path: Path) -> None:
    arm, path = ARMS["gravity_link1"], tmp_path / "arm.fmu"
    mg.export(arm, to="fmu", out=path, fmi=fmi)
    found = simulate_fmu(
        str(path),
        fmi_type="ModelExchange",
        solver="CVode",
        relative_tolerance=1e-12,
        stop_time=16.0,
        output_interval=0.05,
        start_values={"j1.q_start": 0.4},
        output=["j1.q", "j1.dq"],
    )
    duration = float(found["time"][-1])
    expected = simulate(plant(arm), 0.4, 0.0, duration, 20.0, method="DOP853", rtol=1e-12, atol=1e-13)
    at = np.searchsorted(found["time"], expected.t + 1e-9, side="right") - 1
    assert np.abs(found["j1.q"][at] - expected.q[:, 0]).max() <= 1e-9
    # it has swung several times, and rests where dry friction holds it
    assert np.count_nonzero(np.diff(np.sign(expected.dq[:, 0]))) > 4
    assert found["j1.dq"][-1] == 0.0


def test_parameters_are_tuned_while_it_moves(unit: Unit) -> None:
    arm, inputs = ARMS["gravity_arm"], waves(4.0, 1.5)
    nominal = mg.build_model(arm).nominal
    assert nominal is not None
    assert {f"parameter.{name}": value for name, value in nominal.items()} == pytest.approx(
        {v: unit[v] for v in unit.variables if v.startswith("parameter.")}
    )
    names = names_of(arm)
    unit.slave.reset()
    unit.begin(**{"j1.q_start": 0.3, "j2.dq_start": -0.2})
    unit["parameter.FC1"] = 1.5
    found = unit.moved(names, inputs)
    changed = plant(arm, {**nominal, "FC1": 1.5})
    duration = (SAMPLES - 1) / RATE
    expected = simulate(changed, [0.3, 0.0], [0.0, -0.2], duration, RATE, inputs, method="DOP853")
    assert np.abs(found - expected.q).max() <= 1e-9


def test_a_state_is_kept_and_taken_up_again(unit: Unit) -> None:
    names, inputs = names_of(ARMS["gravity_arm"]), waves(4.0, 1.5)
    unit.moved(names, inputs[:50])
    kept = unit.kept()
    first = unit.moved(names, inputs[50:], 50)
    unit.taken_up(kept)
    assert np.array_equal(unit.moved(names, inputs[50:], 50), first)


def test_what_it_refuses(unit: Unit) -> None:
    for name, value in (("j1.q", 1.0), ("step", 0.0), ("j1.q_start", 1.0), ("j1.input", float("nan"))):
        with pytest.raises(Exception, match=r"fmi2SetReal|fmi3SetFloat64|status"):
            unit[name] = value


def same_but_for(text: str, name: str) -> str:
    """A description from this element on: what stands before may say that there is no library."""
    return text.partition(f"<{name}")[2]


@pytest.mark.parametrize("fmi", VERSIONS)
def test_it_compiles_elsewhere_and_is_the_same_there(
    fmi: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    here = mg.export(ARMS["ariane4"], to="fmu", out=tmp_path / "here.fmu", fmi=fmi)
    monkeypatch.setattr(library, "compiler", lambda: None)
    there = mg.export(ARMS["ariane4"], to="fmu", out=tmp_path / "there.fmu", fmi=fmi)
    assert any("no compiled library" in note for note in there.notes)
    with zipfile.ZipFile(tmp_path / "here.fmu") as a, zipfile.ZipFile(tmp_path / "there.fmu") as b:
        sources = [name for name in b.namelist() if name.startswith("sources/")]
        assert {name: a.read(name) for name in sources} == {name: b.read(name) for name in sources}
        assert not any(name.startswith("binaries/") for name in b.namelist())
        code = [name for name in sources if not name.endswith(".xml")]
        assert all(b"SPDX-License-Identifier: 0BSD" in b.read(name) for name in code)
        b.extractall(tmp_path / "there")
    assert same_but_for(here.text, "CoSimulation") == same_but_for(there.text, "CoSimulation")
    assert compiled(tmp_path / "there" / "sources", "-Wall", "-Wextra", "-Werror") == ""


def compiled(folder: Path, *flags: str) -> str:
    """What the compiler has to say about a unit's sources."""
    tool = compiler()
    assert tool is not None
    command = [tool, "-std=c99", *flags, "-fPIC", "-shared", "fmu.c", "-o", "x.so", "-lm"]
    return subprocess.run(command, cwd=folder, capture_output=True, text=True, check=False).stderr


@pytest.mark.parametrize("fmi", VERSIONS)
def test_every_function_is_there_as_the_standards_own_header_declares_it(fmi: str, tmp_path: Path) -> None:
    mg.export(ARMS["gravity_link1"], to="fmu", out=tmp_path / "arm.fmu", fmi=fmi)
    with zipfile.ZipFile(tmp_path / "arm.fmu") as unit:
        unit.extractall(tmp_path)
    main, number = tmp_path / "sources" / "fmu.c", fmi[0]
    before, _, after = main.read_text(encoding="utf-8").partition(f"typedef void *fmi{number}")
    # the unit's own declarations make room for the header's
    kept = after[after.index("typedef struct {\n    State state;") :]
    main.write_text(f'{before}#include "fmi{number}Functions.h"\n{kept}', encoding="utf-8")
    headers = Path(fmpy.__file__).parent / "c-code"
    assert compiled(main.parent, "-Wall", "-Wextra", "-Werror", "-isystem", str(headers)) == ""
    made = ctypes.CDLL(str(main.parent / "x.so"))
    types = (headers / f"fmi{number}FunctionTypes.h").read_text(encoding="utf-8")
    names = set(re.findall(rf"\b(fmi{number}\w+)TYPE\b", types))
    assert len(names) > 40
    assert [name for name in sorted(names) if not hasattr(made, name)] == []


def test_what_has_no_value_begins_at_zero_and_it_is_said() -> None:
    rows = mg.export(ARMS["screw_axis"], to="fmu").rows
    assert {row.status for row in rows} == {"exact"}
    joint = ARMS["screw_axis"].joints[0]
    effects = tuple(replace(use, values={}) for use in joint.effects)
    bare = replace(ARMS["screw_axis"], joints=(replace(joint, effects=effects),))
    assert {(row.status, row.error) for row in mg.export(bare, to="fmu").rows} == {("left out", None)}
