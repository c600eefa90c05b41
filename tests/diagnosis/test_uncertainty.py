"""Standard deviations of estimates: what they scatter by over many draws of the noise."""

from dataclasses import replace

import numpy as np
from diagnosis_support import BARE, UNUSED, system_of
from numpy.random import Generator, default_rng
from scipy.optimize import curve_fit
from scipy.signal import lfilter
from threshold_decisions import selected
from threshold_support import real

from modelgen.diagnosis.candidates import Search, candidates
from modelgen.diagnosis.equations.rows import Rows
from modelgen.diagnosis.evidence.system import System
from modelgen.diagnosis.extended import cause_estimates
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.diagnosis.selection import covariance_of, deviations
from modelgen.numeric import Array

PERIOD, PERIODS, DRAWS = 500, 3, 60
TIME = np.arange(PERIOD * PERIODS) * (2 * np.pi / PERIOD)
POLE = 0.9


def coloured(random: Generator) -> Array:
    """Noise that remembers some ten rows."""
    return np.asarray(lfilter([1.0], [1.0, -POLE], random.normal(size=len(TIME) + 200))[200:])


def noisy(columns: Array, effort: Array) -> System:
    moving = np.ones((len(TIME), 1), dtype=bool)
    rows = [Rows(UNUSED, effort[:, None], columns[:, None, :], moving, BARE)]
    return system_of(rows, periods=[PERIOD])


def test_of_slow_columns_in_slow_noise() -> None:
    """White noise of the same size would leave them a third of that."""
    columns = np.column_stack([np.sin(TIME), np.cos(2 * TIME), np.sin(40 * TIME)])
    found, stated = [], []
    for seed in range(DRAWS):
        effort = columns @ np.array([1.0, -2.0, 0.5]) + coloured(default_rng([1, seed]))
        system = noisy(columns, effort)
        found.append(system.theta)
        stated.append(np.sqrt(np.diag(covariance_of(system))))
    np.testing.assert_allclose(np.std(found, axis=0), np.mean(stated, axis=0), rtol=0.25)


def test_what_is_searched_for_is_not_known_to_the_others() -> None:
    """A law c (1 - exp(-|x| / v)), fitted by another program: c would be surer if v were known."""
    x = np.abs(2.0 * np.sin(TIME) + 0.7 * np.sin(3 * TIME))

    def law(_: Array, c: float, v: float) -> Array:
        return c * (1.0 - np.exp(-x / v))

    found, stated, bold = [], [], []
    for seed in range(DRAWS):
        effort = law(x, 3.0, 0.8) + 0.1 * coloured(default_rng([2, seed]))
        (c, v), _ = curve_fit(law, x, effort, p0=(3.0, 0.8))
        system = noisy(law(x, 1.0, v)[:, None], effort)
        slope = (law(x, c, 1.01 * v) - law(x, c, 0.99 * v)) / (0.02 * v)
        found.append((c, v))
        stated.append(np.sqrt(np.diag(covariance_of(system, [slope[:, None, None]]))))
        bold.append(np.sqrt(covariance_of(system)[0, 0]))
    scatter = np.std(found, axis=0)
    np.testing.assert_allclose(scatter, np.mean(stated, axis=0), rtol=0.25)
    assert np.mean(bold) < 0.75 * scatter[0]


def test_what_is_hardly_determined_has_no_interval() -> None:
    """A velocity of Stribeck's law where there is no such friction: more than half of it is its deviation."""
    equations = real(USUAL)
    candidate = next(c for c in candidates(equations) if c.place == ("stribeck_friction", 1))
    trial = Search(System(equations)).trial(candidate)
    assert trial is not None
    selection = selected(equations, trial)
    spread = deviations(selection, equations)
    (raw,), (said,) = spread.causes, cause_estimates(selection, equations, spread)
    assert raw["velocity"] > 0.5 * said["velocity"].value
    assert np.isnan(said["velocity"].std)
    assert said["magnitude"].std == raw["magnitude"]


def test_what_a_bound_holds_at_zero_is_as_unsure_as_elsewhere() -> None:
    """Its columns are zero in the fit; that no less than zero is possible makes nobody sure of zero."""
    equations = real(USUAL)
    candidate = next(c for c in candidates(equations) if c.place == ("load_dependent_friction", 1))
    free = Search(System(equations)).trial(candidate)
    assert free is not None
    held = replace(
        free,
        columns=[np.zeros_like(c) for c in free.columns],
        gain=replace(free.gain, values=np.zeros(1)),
    )
    (stated,) = deviations(selected(equations, free), equations).causes
    spread = deviations(selected(equations, held), equations)
    (bound,) = spread.causes
    assert np.isclose(bound["coefficient"], stated["coefficient"], rtol=0.1)
    assert cause_estimates(selected(equations, held), equations, spread)[0]["coefficient"].std > 0.0
