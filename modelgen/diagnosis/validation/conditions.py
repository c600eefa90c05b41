"""What a cause with evidence must show: it helps and matters on rows that its fit has not seen.

The cause is fitted on one part of the records and carried to the other, then the other way round (`folds`);
the squares of all parts count together.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.diagnosis.candidates import Candidate, FittedCandidate, with_causes
from modelgen.diagnosis.equations import feigned, repeating_errors
from modelgen.diagnosis.evidence import Pairs, System
from modelgen.diagnosis.options.thresholds import in_band
from modelgen.diagnosis.validation.agreement import agreement
from modelgen.diagnosis.validation.cross_validation import Split, folds, left_unseen
from modelgen.diagnosis.validation.form_error import Forms
from modelgen.effects import Family, Presence, Shows
from modelgen.numeric import Array
from modelgen.regression.weighted import moving_rows, rmse, stacked, weighted_fit


@dataclass(frozen=True)
class Judgement:
    """gain: percent of the RMSE measured on rows that the fit has not seen; expected: what the value found in
    all records must gain there, nan where that was not asked; refused: what it lacks, empty where
    it lacks nothing.
    """

    gain: float
    expected: float
    refused: str


class Conditions:
    """Validation at one step of the selection.

    system: with the causes that were chosen `before`; last: what is judged was chosen before those, which
    cannot have left it anything of theirs.
    """

    def __init__(self, system: System, before: Sequence[FittedCandidate], *, last: bool = False) -> None:
        self.system, self.before, self.last = system, before, last
        self.equations, self.rows = system.equations, system.rows
        self.limits = system.equations.thresholds.validation
        self.blur = np.broadcast_to(self.equations.blur, system.n)
        self.stepped = np.broadcast_to(self.equations.stepped, system.n)
        self.old = with_causes(self.equations, before)
        self.counts = moving_rows(self.rows)
        formed = [t.candidate for t in before if not _known_form(t.candidate)]
        own = [] if last else [c.joint for c in formed]
        self.taken = {j for j in range(system.n) if None in own or j + 1 in own}  # joints of causes
        self._known: dict[Split, Array] = {}
        self.forms = Forms(before, system)

    def judged(self, trial: FittedCandidate) -> Judgement:
        """Whether the cause helps and matters at a joint that it is judged by.

        Gains are measured of the whole prediction, and where the rest of the model is fitted anew to the
        unseen rows with and without the cause, which takes up much of what is slow; the larger one counts.
        That the cause matters is asked of the gain to be expected: what a model without it gets wrong on
        unseen rows if the cause is there as found, against the noise. That has the scatter of one value,
        where a measured gain has that of all parameters of a part. A share of it must be measured, or the
        parts must agree on the cause as far as each can tell: what they contradict is no cause. What errors
        of the positions could feign the gain where the rest is fitted anew must well exceed, unless the
        estimate by instruments is not zero. By that gain must pass what such errors look like most;
        everything where no period repeats, since slow noise, of a size that nobody knows, looks like a slow
        cause; joints where errors of the positions could feign what counts; and causes at a joint of another,
        to which its form may leave some. Friction beside friction, and anything beside what a fluid does,
        must be more than the form of that may leave.
        """
        new = with_causes(self.equations, [*self.before, trial])
        # what shows between records, or in some of them alone: halves of all are tried instead
        effect = trial.candidate.definition
        halves = trial.candidate.coming or self._somewhere(trial)
        within = (trial.candidate.joint or 1) - 1 if Shows.PLACES in effect.shows else None
        split = Split(self.limits.max_records_one_by_one, halves, within)
        whole, again = np.stack([self._without(split), self._with(new, split)], axis=1)
        places = [j for j in trial.candidate.joints(self.system.n) if self.counts[j] > 0]
        refitted = _gains(again)[places]
        least = np.full(len(places), in_band(self._least(trial), self.equations.narrowed))
        least = np.maximum(least, self.forms.least(trial.candidate)[places])
        left = (again[0] / self._tried(split))[places]
        could = feigned(self.blur[places], left)
        if (could > least).any() and instrumented(trial, self.system):
            could = feigned(self.stepped[places], left)  # which no instrument is free of
        doubtful = not self.system.noise_known or _feignable(trial.candidate)
        strict = np.array([doubtful or j in self.taken for j in places], dtype=bool) | (could > least)
        anew = strict & (refitted >= np.maximum(least, self.limits.position_error_factor * could))
        if strict.all() and not anew.any():
            shut = "gain" if (refitted < least).all() else "positions"
            return Judgement(float(refitted.max(initial=-np.inf)), np.nan, shut)
        expected = self._expected(new, split)[places]
        hoped = float(expected.max(initial=0.0))
        gains = np.where(strict, refitted, np.maximum(refitted, _gains(whole)[places]))
        due = ~strict & (expected >= least)
        carried = due & (gains >= self.limits.min_measured_share * expected)
        agreed = bool(due.any()) and not carried.any() and self._agreed(new, split)
        if agreed:
            carried = due
        if not (anew | carried).any():
            return Judgement(float(gains.max(initial=-np.inf)), hoped, "gain")
        if carried.any():
            most = 1.0 + self.limits.max_rise
            worse = not agreed and min(self._total(s) for s in (again, whole)) > most
        else:
            worse = self._total(again) >= 1.0
        shut = "other joints" if worse else ""
        return Judgement(float(gains[anew | carried].max()), hoped, shut)

    def _somewhere(self, trial: FittedCandidate) -> bool:
        """Whether a record does not show the cause. What shows in moments, as play does where its gap is
        crossed, has beside them what the rest of the model takes up, and no more.
        """
        if not all(c[r.moving].any() for r, c in zip(self.rows, trial.columns, strict=True)):
            return True
        if Shows.IMPACTS not in trial.candidate.definition.shows:
            return False
        shows = [replace(r, effort=c[:, :, 0]) for r, c in zip(self.rows, trial.columns, strict=True)]
        sizes = np.maximum(self.system.sizes, 1e-150)
        theta = np.linalg.lstsq(*stacked(shows, self.old, 1.0 / sizes), rcond=None)[0]
        left = [((r.effort - c @ theta) / sizes)[r.moving] for r, c in zip(shows, self.old, strict=True)]
        power = [float(np.mean(e**2)) for e in left]
        return min(power) < self.limits.min_power_share * max(power)

    def _agreed(self, new: Sequence[Array], split: Split) -> bool:
        """Whether the parts agree on the cause."""
        parts = [part for _, part in folds(self.rows, split)]
        own = self.old[0].shape[2]
        return agreement(parts, self.equations, new, own).probability >= self.limits.min_agreement

    def _least(self, trial: FittedCandidate) -> float:
        """Percent of the RMSE that the cause must gain in the usual band."""
        c, limits = trial.candidate, self.limits
        if _reverses(c):
            before = [o for o in (t.candidate for t in self.before) if _at_one_place(c, o)]
            if any(_reverses(o) and not _lags(o) for o in before):
                return limits.gain_at_reversals_percent
            if _lags(c) and any(o.elastic for o in before):
                return limits.gain_at_reversals_percent
            if not _lags(c) and any(_reverses(o) for o in before):
                return limits.gain_beside_delay_percent
        evidence = trial.gain.delta_bic / self.system.price
        if not self.system.coloured:
            faint = evidence < limits.faint_delta_bic[1]
            return limits.faint_gain_percent if faint else limits.min_gain_percent
        ends = limits.faint_gain_percent, limits.min_gain_percent
        return float(np.interp(evidence, limits.faint_delta_bic, ends))

    def _tried(self, split: Split) -> Array:
        """How many rows (n,) are tried, at least one."""
        counts = [moving_rows(tried) for _, (tried, _) in folds(self.rows, split)]
        return np.asarray(np.maximum(np.sum(counts, axis=0), 1.0))

    def _without(self, split: Split) -> Array:
        """Sums of squares (2, n) left of unseen rows, the whole predicted and the model fitted anew."""
        if split not in self._known:
            again = np.zeros(self.system.n)
            for _, (tried, to) in folds(self.rows, split):
                table = [self.old[i] for i in to]
                again += moving_rows(tried) * rmse(tried, table, weighted_fit(tried, table)) ** 2
            self._known[split] = np.array([left_unseen(self.rows, self.old, split), again])
        return self._known[split]

    def _with(self, new: Sequence[Array], split: Split) -> Array:
        """Sums of squares with the cause, as it was fitted to the other part."""
        own = self.old[0].shape[2]
        found = np.zeros((2, self.system.n))
        for (fitted, at), (tried, to) in folds(self.rows, split):
            theta = weighted_fit(fitted, [new[i] for i in at])
            carried = [
                replace(r, effort=r.effort - new[i][:, :, own:] @ theta[own:])
                for r, i in zip(tried, to, strict=True)
            ]
            table = [self.old[i] for i in to]
            found[0] += moving_rows(tried) * rmse(tried, [new[i] for i in to], theta) ** 2
            found[1] += moving_rows(tried) * rmse(carried, table, weighted_fit(carried, table)) ** 2
        return found

    def _expected(self, new: Sequence[Array], split: Split) -> Array:
        """Percent of the RMSE (n,) that a model without the cause, which is there as found, loses unseen."""
        own = self.old[0].shape[2]
        theta = weighted_fit(self.rows, new)
        shows = [replace(r, effort=c[:, :, own:] @ theta[own:]) for r, c in zip(self.rows, new, strict=True)]
        bias = left_unseen(shows, self.old, split) / self._tried(split)
        noise = rmse(self.rows, new, theta) ** 2
        return np.asarray(100.0 * (1.0 - np.sqrt(noise / (noise + bias))))

    def _total(self, sums: Array) -> float:
        """Mean over the joints of the squares with the cause over those without."""
        return float((sums[1] / np.maximum(sums[0], 1e-300))[self.counts > 0].mean())


def _gains(sums: Array) -> Array:
    """Percent of the RMSE by joint, from sums of squares without and with (2, n)."""
    return np.where(sums[0] > 0, 100.0 * (1.0 - np.sqrt(sums[1] / np.maximum(sums[0], 1e-300))), 0.0)


def _known_form(c: Candidate) -> bool:
    """Whether joints of others are not those to which the form of this one may leave some."""
    return c.definition.exact or c.definition.family is Family.FLUID


def _feignable(c: Candidate) -> bool:
    """Whether errors of the positions look like it most: what comes late, and what differs between records.

    It must gain all of it where the rest is fitted anew.
    """
    return c.elastic or _lags(c) or c.coming


def _reverses(c: Candidate) -> bool:
    return Shows.REVERSALS in c.definition.shows


def _lags(c: Candidate) -> bool:
    """Whether it shows at reversals because what it moves comes late, not by friction near rest."""
    return _reverses(c) and Shows.NEAR_REST not in c.definition.shows


def _at_one_place(one: Candidate, other: Candidate) -> bool:
    """Whether they are at one joint, or one of them everywhere."""
    return one.joint == other.joint or one.joint is None or other.joint is None


def instrumented(trial: FittedCandidate, system: System) -> bool:
    """Whether the cause shows where errors of the positions are kept out: its estimate by instruments is not
    zero, or it does not repeat as they do.
    """
    presence = trial.candidate.definition.presence
    if presence is Presence.FADING:  # passes while errors of the positions repeat with the excitation
        return True
    if trial.candidate.coming:  # does not repeat
        return False
    if trial.candidate.elastic:  # searched for over what makes a filter of any errors
        return False
    table = [np.concatenate([c, t], axis=2) for c, t in zip(system.columns, trial.columns, strict=True)]
    pairs = Pairs(system, table)
    if not pairs.enough or repeating_errors(system.equations).any():
        return False
    values = pairs.t_values(system.plain.share)[system.columns[0].shape[2] :]
    least = system.equations.thresholds.validation.min_instrument_deviations
    return bool(np.abs(values).max(initial=0.0) > least)
