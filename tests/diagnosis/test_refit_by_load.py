"""Friction that grows with the load is found beside a spring that looks like the load."""

from loaded_rod import LOADED, described, log

from modelgen import diagnose
from modelgen.description import loads
from modelgen.effects import known_effects


def test_the_load_is_found_with_its_friction() -> None:
    """With the load of the fit before, and known as if it were certain, it was 17 deviations off."""
    arm = loads(described("spring"), "arm.yaml", known_effects())["rod"]
    records = [log(seed, spring=True, reach=0.45) for seed in range(3)]
    asked = ["load_dependent_friction:shoulder"]
    found = diagnose(arm, records[:2], [records[2]], effects=asked, experiment=False).to_json()
    (cause,) = (*found["causes"], *found["suspects"])
    e = cause["parameters"]["coefficient"]
    assert abs(e["value"] - LOADED) < 3.0 * e["std"], e
    assert e["std"] < 0.03 * LOADED, e
