"""What a description tells of the links is evidence, as far as the records do not contradict it."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from diagnosis_support import system_of
from numpy.random import default_rng

from modelgen.description import Arm, DirectDrive, EffectUse, Inertial, Joint, LeveredDrive
from modelgen.diagnosis.equations.prior import NominalPrior, Unknowns, estimated, told
from modelgen.diagnosis.equations.rows import Rows
from modelgen.diagnosis.evidence import System
from modelgen.diagnosis.options.thresholds import USUAL, SelectionThresholds
from modelgen.functions import Model, build_model, grouped
from modelgen.numeric import Array

LINKS = (
    Inertial(12.0, (0.21, 0.01, 0.0), (0.05, 0.0, 0.01, 0.3, 0.0, 0.31)),
    Inertial(8.0, (0.17, 0.0, 0.02), (0.02, 0.0, 0.0, 0.1, 0.01, 0.1)),
)
OWN = tuple(EffectUse(name) for name in ("drive_inertia", "viscous_friction", "coulomb_friction"))
ARM = Arm(
    "two",
    (
        Joint(
            "a",
            "revolute",
            drive=LeveredDrive(0.35, 0.09, (0.29, 0.42), (0.0, 160.0), 1, -1.4, 0.06),
            effects=OWN,
        ),
        Joint("b", "revolute", d=0.5, antecedent=0, drive=DirectDrive(50.0, 0.1), effects=OWN),
    ),
    LINKS,
)
UNUSED: Any = None


@pytest.fixture(scope="module")
def model() -> Model:
    return build_model(ARM)


def base(model: Model, standard: dict[str, float]) -> Array:
    return np.array(list(grouped(model, [standard.get(p.name, 0.0) for p in model.standard]).values()))


def drawn(link: Inertial, number: int, off: Array) -> dict[str, float]:
    """The link's ten parameters about its frame's origin, each off by so much of what is natural for it."""
    m, c = link.mass, np.array(link.com)
    xx, xy, xz, yy, yz, zz = link.inertia
    tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]) + m * (c @ c * np.eye(3) - np.outer(c, c))
    radius = np.sqrt(c @ c + (xx + yy + zz) / (2 * m))
    found = {f"M{number}": m * (1 + off[0])}
    for k, a in enumerate("XYZ"):
        found[f"M{a}{number}"] = m * (c[k] + radius * off[1 + k])
    for k, (i, j) in enumerate([(0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2)]):
        found["XYZ"[i] + "XYZ"[j] + str(number)] = tensor[i, j] + m * radius**2 * off[4 + k]
    return found


def test_links_that_are_off_by_three_tenths_scatter_by_one(model: Model) -> None:
    said, random = told(model, USUAL.equations), default_rng(3)
    assert said is not None
    left = np.array(
        [
            said.rows
            @ base(
                model,
                {
                    k: v
                    for i, link in enumerate(LINKS, 1)
                    for k, v in drawn(link, i, random.normal(0, 0.3, 10)).items()
                },
            )
            - said.right
            for _ in range(4000)
        ]
    )
    np.testing.assert_allclose(left.mean(axis=0), 0.0, atol=0.08)
    np.testing.assert_allclose(np.cov(left.T), np.eye(len(said.right)), atol=0.12)


def test_nothing_is_told_of_drives_and_friction(model: Model) -> None:
    said = told(model, USUAL.equations)
    assert said is not None
    of_links = {k for i in (1, 2) for k in drawn(LINKS[0], i, np.zeros(10))}
    others = {p.name: 100.0 for p in model.standard if p.name not in of_links}
    assert others
    assert np.abs(base(model, others)).max() > 1.0
    np.testing.assert_allclose(said.rows @ base(model, others), 0.0, atol=1e-6)


def test_links_without_inertials_tell_nothing() -> None:
    arm = replace(ARM, links=(LINKS[0], None))
    assert estimated(build_model(arm), USUAL.equations).said is None


def equations(
    said: NominalPrior | None, seed: int = 1, more: int = 0, off: float = 0.0
) -> tuple[System, list[Array], list[Array]]:
    """One joint with two parameters of its links, 1 and 2, and a force; what is like that force, and what is
    like it but for a good deal of the links.

    more: parameters besides that do nothing in these records. off: of the second parameter.
    """
    random = default_rng(seed)
    x = random.normal(size=(1000, 3))
    force = x[:, 2] + 0.5 * x[:, 0]
    other = x[:, 2] - 0.5 * x[:, 0] + 0.02 * x[:, 1] ** 2
    effort = x[:, :2] @ [1.0, 2.0 + off] + 0.5 * force + random.normal(size=1000)
    columns = np.hstack([x[:, :2], np.zeros((1000, more))])[:, None, :]
    known = Unknowns(np.zeros(2 + more), np.eye(2 + more), said)
    rows = Rows(UNUSED, effort[:, None], columns, np.ones((1000, 1), dtype=bool), known)
    system = system_of([rows], [columns])
    return system, [force[:, None, None]], [other[:, None, None]]


def ahead(said: NominalPrior | None, seed: int, stack: str = "white", **more: Any) -> float:
    """Evidence of the force over what is like it."""
    system, force, other = equations(said, seed, **more)
    one, two = (getattr(system, stack).gain(columns) for columns in (force, other))
    assert one.delta_bic > 100.0
    return float(one.delta_bic - two.delta_bic)


def numbers(values: list[float]) -> NominalPrior:
    """Each parameter's own, to a tenth."""
    return NominalPrior(np.eye(len(values)) / 0.1, np.array(values) / 0.1, USUAL.equations.min_nominal_weight)


RIGHT, WRONG = numbers([1.0, 2.0]), numbers([40.0, -90.0])


@pytest.mark.parametrize("stack", ["white", "plain"])
def test_of_causes_that_look_alike_the_one_that_leaves_the_links_as_described_is_ahead(stack: str) -> None:
    without = [ahead(None, seed, stack) for seed in range(20)]
    assert abs(np.mean(without)) < 1.0
    assert min(ahead(RIGHT, seed, stack) - without[seed] for seed in range(20)) > 3.0


def test_a_description_that_the_records_contradict_decides_nothing() -> None:
    assert max(abs(ahead(WRONG, seed) - ahead(None, seed)) for seed in range(20)) < 0.5


def test_what_the_records_leave_open_agrees_with_everything_and_says_nothing() -> None:
    for seed in range(5):
        few = ahead(RIGHT, seed)
        assert ahead(numbers([1.0, 2.0, *[7.0] * 30]), seed, more=30) == pytest.approx(few, abs=0.1)


@pytest.mark.parametrize("count", [4, 20, 36])
def test_one_link_that_is_not_as_described_is_not_taken_for_a_cause(count: int) -> None:
    """Of many that are right to a fiftieth, one is off by the whole of it: what takes that up besides the
    force gets less ahead of the force alone than it takes to be named without it as a rival.
    """
    random = default_rng(count)
    x = random.normal(size=(3000, count + 1))
    off = np.append(3.3, 0.06 * random.normal(size=count - 1))
    force = x[:, -1]
    effort = 0.3 * x[:, :-1] @ off + 0.5 * force + random.normal(size=3000)
    columns = x[:, None, :-1]
    known = Unknowns(
        np.zeros(count),
        np.eye(count),
        NominalPrior(np.eye(count) / 0.3, np.zeros(count), USUAL.equations.min_nominal_weight),
    )
    rows = Rows(UNUSED, effort[:, None], columns, np.ones((3000, 1), dtype=bool), known)
    white = system_of([rows], [columns]).white
    true, like = (white.gain([c[:, None, None]]) for c in (force, force + 0.9 * x[:, 0]))
    assert true is not None
    assert like is not None
    assert like.delta_bic - true.delta_bic < SelectionThresholds().rival_margin_bic


def test_what_the_links_parameters_can_do_is_no_cause() -> None:
    """However far from their description that takes them."""
    system, _, _ = equations(RIGHT, off=1.0)
    same = [c[:, :, [1]] for c in system.columns]
    for stack in (system.white, system.plain):
        assert stack.gain(same) is None
