"""Two causes of a joint of which neither is found by itself: friction by the load beside a spring."""

import numpy as np
import pytest
from loaded_rod import LOADED, PRELOAD, STIFFNESS, described, log

from modelgen import diagnose
from modelgen.description import loads
from modelgen.effects import known_effects
from modelgen.numeric import Array


def records(reach: float, noise: float) -> list[dict[str, Array]]:
    """Three records of the rod with its spring. noise: of the current [A]."""
    found = [log(seed, spring=True, reach=reach) for seed in range(3)]
    for k, table in enumerate(found):
        table["i1"] = table["i1"] + noise * np.random.default_rng([9, k]).normal(size=len(table["t"]))
    return found


@pytest.mark.parametrize(("reach", "noise"), [(0.8, 0.02), (1.2, 0.02), (1.2, 0.06)])
def test_both_are_found(reach: float, noise: float) -> None:
    """The load that the links are thought to make is the spring's as well: one after the other the spring and
    friction over the position were named.
    """
    arm = loads(described(), "arm.yaml", known_effects())["rod"]
    *train, test = records(reach, noise)
    found = diagnose(arm, train, [test], experiment=False).to_json()
    values = {c["effect"]: {k: x["value"] for k, x in c["parameters"].items()} for c in found["causes"]}
    assert values.keys() == {"load_dependent_friction", "spring"}
    assert values["load_dependent_friction"]["coefficient"] == pytest.approx(LOADED, rel=0.04)
    assert values["spring"]["stiffness"] == pytest.approx(STIFFNESS, rel=0.01)
    assert values["spring"]["preload"] == pytest.approx(PRELOAD, rel=0.01)


def test_what_explains_nearly_as_much_is_a_rival() -> None:
    """In more noise, over a range in which the weight changes as a square of the position."""
    arm = loads(described(), "arm.yaml", known_effects())["rod"]
    *train, test = records(0.8, 0.06)
    found = diagnose(arm, train, [test], experiment=False).to_json()
    for cause in found["causes"]:
        others = {other["effect"] for other in cause["ambiguous_with"]}
        if cause["effect"] == "position_dependent_friction":
            assert "load_dependent_friction" in others
        else:
            assert cause["effect"] in ("load_dependent_friction", "spring")
