"""Friction in proportion to the load, which the parameters make that are looked for."""

from pathlib import Path

import numpy as np
import pytest
from loaded_rod import DRY, LOADED, MOMENT, PRELOAD, STIFFNESS, VISCOUS, described, log

from modelgen import identify
from modelgen.description import loads
from modelgen.effects import known_effects


@pytest.mark.parametrize("spring", [False, True], ids=["alone", "beside a spring"])
def test_the_friction_is_that_of_the_load_that_is_found(spring: bool, tmp_path: Path) -> None:
    """With columns of the load of the fit before it was off by dozens of its deviations."""
    mapping = tmp_path / "mapping.yaml"
    joint = "{position: {column: q1, unit: rad}, effort: {column: i1, unit: A}}"
    mapping.write_text(f"schema: 1\ntime: {{column: t}}\nhold: instant\njoints:\n  - {joint}\n")
    more = ("load_dependent_friction", *(["spring"] if spring else []))
    arm = loads(described(*more), "arm.yaml", known_effects())["rod"]
    logs = log(0, spring=spring), log(1, spring=spring)
    found = identify(arm, *logs, mapping=mapping).parameters
    wanted = {"FL1": LOADED, "FC1": DRY / 100.0, "FV1": VISCOUS / 1e4, "MX1": MOMENT}
    wanted |= {"KS1": STIFFNESS, "KO1": PRELOAD} if spring else {}
    for name, value in wanted.items():
        e = found[name]
        assert e.std is not None
        assert abs(e.value - value) < max(4.0 * e.std, 0.002 * abs(value)), (name, e)
    friction = found["FL1"].std
    assert friction is not None
    assert friction < (0.01 if spring else 0.002)


def test_the_friction_is_that_of_a_load_with_its_inertia(tmp_path: Path) -> None:
    """A load that is followed within a time is a state, and follows from what is looked for as well."""
    law = "load_dependent_friction: {rise: 0.0001}"
    arm = loads(described(law).replace("drive_inertia, ", ""), "arm.yaml", known_effects())["rod"]
    away = []
    for seed in range(2):
        logs = [log(2 * seed + k, spring=False, reach=1.5, inertia=True, loaded=0.5) for k in (0, 1)]
        mapping = tmp_path / "mapping.yaml"
        mapping.write_text("schema: 1\nhold: instant\n")
        found = identify(arm, *logs, mapping=mapping).parameters
        for name, value in {"FL1": 0.5, "FC1": DRY / 100.0}.items():
            e = found[name]
            assert e.std is not None
            away.append((e.value - value) / e.std)
    # Four deviations of unit size: their mean square is above 4.6 in one run of a thousand.
    assert np.mean(np.square(away)) < 4.6, away
