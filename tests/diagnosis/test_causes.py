"""Which causes stay in the final model, on equations of which everything is known: white noise, no arm."""

import numpy as np
import pytest
from diagnosis_support import BARE, UNUSED, system_of
from numpy.random import Generator, default_rng

from modelgen.diagnosis.candidates.candidate import Candidate
from modelgen.diagnosis.candidates.fitted import FittedCandidate, with_causes
from modelgen.diagnosis.equations.rows import Rows
from modelgen.diagnosis.evidence.system import covariance
from modelgen.diagnosis.selection.backward import backward_elimination
from modelgen.diagnosis.selection.cause import Cause
from modelgen.numeric import Array

LONG = 1500


def record(random: Generator, sizes: Array) -> tuple[Rows, Array]:
    """One joint, noise of unit size, and as many effects as sizes, (LONG, effects)."""
    own = random.normal(size=(LONG, len(sizes)))
    base = random.normal(size=(LONG, 3))
    effort = base.sum(axis=1) + own @ sizes + random.normal(size=LONG)
    return Rows(UNUSED, effort[:, None], base[:, None, :], np.ones((LONG, 1), dtype=bool), BARE), own


def kept(effects: tuple[str, ...], sizes: tuple[float, ...], seed: int) -> list[str]:
    """Of causes that were all taken, those that stay."""
    random = default_rng([11, seed])
    made = [record(random, np.array(sizes)) for _ in range(2)]
    rows = [r for r, _ in made]
    before = system_of(rows, [r.columns for r in rows], [LONG // 3] * 2)
    causes = []
    for k, effect in enumerate(effects):
        columns = [own[:, k, None, None] for _, own in made]
        gain = before.gain(columns)
        assert gain is not None
        causes.append(
            Cause(FittedCandidate(Candidate(effect, 1), {}, columns, gain), gain.delta_bic, 5.0, 5.0)
        )
    system = system_of(rows, with_causes(before.equations, [c.trial for c in causes]), before.periods)
    found, final = backward_elimination(causes, system, 15.0)
    assert final.columns[0].shape[2] == 3 + len(found)
    return [c.trial.candidate.effect for c in found]


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_what_the_others_leave_nothing_to_gain_leaves(seed: int) -> None:
    """0.15 of the noise has evidence in 3000 rows and gains 1.1 %; 0.3 gains 4.2 %."""
    names = ("friction_offset", "asymmetric_viscous_friction")
    assert kept(names, (0.6, 0.3), seed) == list(names)
    assert kept(names, (0.6, 0.15), seed) == ["friction_offset"]
    assert kept(names, (0.15, 0.6), seed) == ["asymmetric_viscous_friction"]


def test_a_value_that_cannot_be_leaves() -> None:
    """A negative Stribeck magnitude, however much it explains."""
    assert kept(("friction_offset", "stribeck_friction"), (0.6, 0.5), 4) == [
        "friction_offset",
        "stribeck_friction",
    ]
    assert kept(("friction_offset", "stribeck_friction"), (0.6, -0.5), 4) == ["friction_offset"]


def test_the_covariance_is_the_scatter_of_estimates() -> None:
    """Over draws of the noise."""
    estimates, stated = [], []
    for seed in range(40):
        rows = [record(default_rng([5, seed, k]), np.zeros(0))[0] for k in range(2)]
        system = system_of(rows, [r.columns for r in rows], [LONG // 3] * 2)
        estimates.append(np.linalg.lstsq(system.white.matrix, system.white.right, rcond=None)[0])
        stated.append(np.sqrt(np.diag(covariance(system))))
    np.testing.assert_allclose(np.std(estimates, axis=0), np.mean(stated, axis=0), rtol=0.35)
