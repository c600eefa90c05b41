"""An effect is known by its class alone: one of each kind that no module names goes through every command,
and is named in a plant that has it.
"""

import json
from collections.abc import Iterator
from pathlib import Path

import made_up_plants as plants
import numpy as np
import pytest
from c_support import Library, evaluated, flat_c, shared_library
from command_support import called
from made_up_effects import in_the_catalogue

from modelgen.backends import NumpyFunction
from modelgen.description import load
from modelgen.effects import known_effects
from modelgen.effects.base import BodyEffect, Definition, DescriptionEffect, Effect, InputEffect, LinkEffect
from modelgen.functions import build_model
from modelgen.functions.nominal import nominal_standard

KINDS = {
    "eddy_current_drag": Effect,
    "tool_damping": LinkEffect,
    "geared_counterweight": BodyEffect,
    "link_length_error": DescriptionEffect,
    "amplifier_asymmetry": InputEffect,
}
TRUTH = {
    "eddy_current_drag": {"coefficient": plants.DRAG, "critical": plants.CRITICAL},
    "tool_damping": {"coefficient": plants.DAMPING, "x": plants.TOOL},
    "geared_counterweight": {"ratio": plants.WHEEL_RATIO, "moment": plants.WHEEL_MASS * plants.WHEEL_RADIUS},
    "link_length_error": {"length": plants.LONGER},
    "amplifier_asymmetry": {"error": plants.ASYMMETRY},
}


@pytest.fixture(scope="module", autouse=True)
def effects() -> Iterator[dict[str, type[Definition]]]:
    """The made-up effects, in the catalogue while these tests run."""
    with in_the_catalogue() as added:
        yield added


def diagnosed(plant: plants.Plant, folder: Path) -> dict:  # type: ignore[type-arg]
    """What the whole command says of three logs of a plant."""
    arms = folder / "arms.yaml"
    arms.write_text(plants.description(plant.n), encoding="utf-8")
    a, b, c = (plants.log(folder / f"{k}.csv", plant, k) for k in range(3))
    out = folder / "out"
    done = called(
        "diagnose", arms, "--train", a, "--train", b, "--test", c, "--out", out, "--jobs", "1", "--json"
    )
    assert done.returncode == 0, done.stderr
    assert (out / "made_up_extended.yaml").exists()
    found: dict = json.loads(done.stdout)  # type: ignore[type-arg]
    return found


def test_there_is_one_of_each_kind(effects: dict[str, type[Definition]]) -> None:
    assert effects.keys() == KINDS.keys() == TRUTH.keys() == plants.PLANTS.keys()
    assert all(issubclass(effects[name], kind) for name, kind in KINDS.items())


@pytest.mark.parametrize("n", [1, 2])
def test_an_arm_without_any_lacks_nothing(n: int, tmp_path: Path) -> None:
    found = diagnosed(plants.PLAIN[n], tmp_path)
    assert found["verdict"] == "nothing_missing"
    # two thirds of the noise's band is filtered away: what is left is less than was put in
    assert max(found["error"]["before"]) < plants.NOISE


@pytest.mark.parametrize("name", KINDS)
def test_it_is_named_where_it_is(name: str, tmp_path: Path) -> None:
    plant = plants.PLANTS[name]
    found = diagnosed(plant, tmp_path)
    (cause,) = found["causes"]
    assert (found["verdict"], cause["effect"], cause["joint"]) == ("named", name, plant.n)
    assert max(found["error"]["after"]) < plants.NOISE < max(found["error"]["before"])
    for parameter, value in TRUTH[name].items():
        assert cause["parameters"][parameter]["value"] == pytest.approx(value, rel=0.02)


VALUES = {
    "eddy_current_drag": "{coefficient: 0.003, critical: 40}",
    "tool_damping": "{coefficient: 25, x: 0.3}",
    "geared_counterweight": "{inertia: 0.06, moment: 0.3, ratio: 2}",
    "link_length_error": "{length: 0.05}",
    "amplifier_asymmetry": "{error: 0.06}",
}
LINEAR = {
    "eddy_current_drag": ("FE1", plants.DRAG),
    "tool_damping": ("CT2", plants.DAMPING),
    "geared_counterweight": ("SW1", plants.WHEEL_MASS * plants.WHEEL_RADIUS),
}


def described(name: str | None, n: int, path: Path) -> Path:
    """The arm's description with one of the effects as large as the plant has it, or without any."""
    text = plants.description(n, "" if name is None else f"{{{name}: {VALUES[name]}}}")
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize("name", KINDS)
def test_its_law_is_that_of_the_plant(name: str, tmp_path: Path) -> None:
    plant = plants.PLANTS[name]
    arm = load(described(name, plant.n, tmp_path / "arms.yaml"), known_effects())["made_up"]
    model = build_model(arm)
    function = next(f for f in model.functions if f.name == "inverse_dynamics_standard")
    motion = np.random.default_rng(0).uniform(-2, 2, (3, 50, plant.n))
    standard = list(nominal_standard(model).values())
    assert NumpyFunction(function)(*motion, standard) == pytest.approx(plant.currents(*motion), rel=1e-9)


def test_generate_writes_the_laws_in_c(tmp_path: Path) -> None:
    """All of them at one joint, compiled, against NumPy."""
    every = ", ".join(f"{{{name}: {values}}}" for name, values in VALUES.items())
    arms = tmp_path / "arms.yaml"
    arms.write_text(plants.description(2, every), encoding="utf-8")
    done = called("generate", arms, "--out", tmp_path)
    assert done.returncode == 0, done.stderr
    model = build_model(load(arms, known_effects())["made_up"])
    function = next(f for f in model.functions if f.name == "inverse_dynamics_standard")
    library = Library(shared_library(tmp_path / "made_up", "made_up", "double"), model, "double")
    random = np.random.default_rng(1)
    for _ in range(20):
        given = [*random.uniform(-2, 2, (3, 2)), random.uniform(0.1, 2, len(model.standard))]
        status, results = library.call(function.name, *given)
        assert status == 0
        there = evaluated(function, [given])[0]
        assert flat_c(results) == pytest.approx(there, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("name", KINDS)
def test_simulate_moves_otherwise_with_it(name: str, tmp_path: Path) -> None:
    plant = plants.PLANTS[name]
    table = np.loadtxt(plants.log(tmp_path / "log.csv", plant, 0), delimiter=",", skiprows=1)[:101]
    names = ["t", *(f"i{k + 1}" for k in range(plant.n))]
    given = tmp_path / "input.csv"
    columns = table[:, [0, *range(1 + plant.n, 1 + 2 * plant.n)]]
    np.savetxt(given, columns, "%.6g", ",", header=",".join(names), comments="")
    moved = []
    for effect in (name, None):
        arms, out = described(effect, plant.n, tmp_path / "arms.yaml"), tmp_path / "out.csv"
        more = ("--input", given, "--duration", "0.5", "--rate", "200", "--method", "RK45", "--out", out)
        done = called("simulate", arms, *more)
        assert done.returncode == 0, done.stderr
        moved.append(np.loadtxt(out, delimiter=",", skiprows=1)[:, 1 : 1 + plant.n])
    assert np.isfinite(moved).all()
    assert np.abs(moved[0] - moved[1]).max() > 1e-3


@pytest.mark.parametrize("name", KINDS)
def test_identify_fits_the_model_that_has_it(name: str, tmp_path: Path) -> None:
    plant = plants.PLANTS[name]
    logs = [plants.log(tmp_path / f"{k}.csv", plant, k) for k in range(2)]
    arms, out = described(name, plant.n, tmp_path / "arms.yaml"), tmp_path / "out"
    held = plants.held(tmp_path / "held.yaml", plant)
    done = called("identify", arms, "--train", logs[0], "--test", logs[1], "--mapping", held, "--out", out)
    assert done.returncode == 0, done.stderr
    found = json.loads((out / "identification.json").read_text(encoding="utf-8"))
    values = {p["name"]: (p["value"], p["std"]) for p in found["parameters"]}
    symbol, truth = LINEAR.get(name, (f"FV{plant.n}", plants.VISCOUS[plant.n - 1]))
    value, std = values[symbol]
    assert abs(value - truth) < 4 * std < 0.02 * truth
