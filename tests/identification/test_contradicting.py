"""Parameters that contradict the description's nominal values are named in the verdict."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import modelgen as mg
from modelgen.functions.nominal import known_base
from modelgen.identification import Identification
from modelgen.identification.summary import contradicting, verdict

EXAMPLE = Path(__file__).resolve().parents[2] / "examples" / "diagnosis"


@pytest.fixture(scope="module")
def found() -> Identification:
    arm = mg.load_arms(EXAMPLE / "arms.yaml")["digger"]
    logs = [EXAMPLE / name for name in ("train_a.csv", "train_b.csv", "test.csv")]
    return mg.identify(arm, train=logs[:2], test=logs[2]).outcome.found


def shifted(found: Identification, **away: float) -> Identification:
    """As if each parameter were its nominal value, some so many standard deviations away from it."""
    nominal = known_base(found.model)
    estimates = tuple(
        replace(e, value=nominal[e.name] + away.get(e.name, 0.0) * (e.std or 0.0)) if e.name in nominal else e
        for e in found.estimates
    )
    return replace(found, estimates=estimates)


def test_the_worst_is_named_with_what_it_makes_of_the_effort(found: Identification) -> None:
    """By the change of the predicted effort, in the unit of the log; others by name, and all are counted."""
    names = list(known_base(found.model))
    assert contradicting(shifted(found)) == []
    assert found.test is not None
    assert found.test.sizes is not None
    one = shifted(found, MX2R=200.0)
    (said,) = contradicting(one)
    k = [e.name for e in found.estimates].index("MX2R")
    std, j = found.estimates[k].std, found.test.shown_by(k)
    assert std is not None
    assert j is not None
    effort = 200.0 * std * found.test.sizes[j, k]
    whole = np.sqrt(np.mean(found.test.measured[:, j] ** 2))
    name = found.arm.coordinate_names[j]
    assert said.startswith("MX2R differs from its nominal value by 200 standard deviations")
    assert f"{effort:.2g} {found.test.unit[j]}" in said
    assert f"{100 * effort / whole:.2g} % of the effort of {name}" in said
    assert said in verdict(one)
    (said,) = contradicting(shifted(found, MX2R=200.0, MX1R=-100.0))
    assert said.startswith(f"2 of the {len(names)} parameters")


def test_of_many_poorly_determined_parameters_the_worst_have_their_effort(found: Identification) -> None:
    """Every one is named, those that move the effort most first."""
    poor = replace(found, estimates=tuple(replace(e, std=5.0 * abs(e.value)) for e in found.estimates))
    assert poor.test is not None
    moved = {e.name: poor.test.in_effort(k, e.std or 0.0)[1] for k, e in poor.poor()}
    worst = sorted(moved, key=lambda name: -moved[name])
    assert len(worst) > 5
    text = verdict(poor).partition("Poorly determined: ")[2]
    first, _, rest = text.partition("; less in the effort: ")
    assert [part.split(" (")[0] for part in first.split("), ")] == worst[:5]
    assert rest.partition(".")[0].split(", ") == worst[5:]


def test_what_moves_no_effort_or_may_be_chance_is_not_named(found: Identification) -> None:
    assert contradicting(shifted(found, MX2R=2.9)) == []
    assert found.test is not None
    assert found.test.sizes is not None
    small = replace(found.test, sizes=1e-6 * found.test.sizes)
    assert contradicting(replace(shifted(found, MX2R=200.0), test=small)) == []
    (said,) = contradicting(replace(shifted(found, MX2R=200.0), test=None))
    assert "200 standard deviations" in said
