"""An effect is known by its class alone: one of each kind that no module names goes through every command,
and is named in a plant that has it.
"""

import json
from collections.abc import Iterator
from pathlib import Path

import made_up_plants as plants
import pytest
from command_support import called
from made_up_effects import in_the_catalogue

from modelgen.effects.base import BodyEffect, Definition, DescriptionEffect, Effect, InputEffect, LinkEffect

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
