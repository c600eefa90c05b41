"""A diagnosis from logs to verdict."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

from modelgen.dataset import Record, Settings, check_separate, last_quarter_out, read, split
from modelgen.dataset.processing.periods import period_of
from modelgen.description import Arm
from modelgen.diagnosis.candidates.candidate import (
    Candidate,
    Place,
    at_links,
    at_motor,
    cold,
)
from modelgen.diagnosis.candidates.requested import check_one_arm
from modelgen.diagnosis.decision import Progress, decide
from modelgen.diagnosis.equations.band import bands
from modelgen.diagnosis.equations.checks import check_efforts
from modelgen.diagnosis.equations.free_motion import released, settings_of_swings
from modelgen.diagnosis.equations.rows import Rows, rows_of
from modelgen.diagnosis.experiment.experiment import next_experiment
from modelgen.diagnosis.experiment.motions import stage
from modelgen.diagnosis.extended.drive_inertia import split_drive_inertia
from modelgen.diagnosis.extended.extended_model import (
    extended,
    fitted,
    replay,
    residuals,
    unit_of_efforts,
)
from modelgen.diagnosis.extended.findings import NamedCause, Positions
from modelgen.diagnosis.extended.test_errors import errors, motion_errors, shares
from modelgen.diagnosis.extended.uncertainty import base_estimates, cause_estimates, valued
from modelgen.diagnosis.result import Diagnosis
from modelgen.diagnosis.selection.cause import Selection
from modelgen.diagnosis.selection.refit_stiffness import refit_stiffness
from modelgen.diagnosis.selection.stepwise import threshold
from modelgen.diagnosis.thresholds import PRACTICAL, practical
from modelgen.effects import CATALOGUE, Family, Presence, Seen
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import build_model
from modelgen.jobs import HERE, Where, one_thread

CUTOFF = 18.0  # Hz, of effort and regressor where the rate allows it
FREE_CUTOFF = 10.0  # Hz, for free motions
SAMPLES = 12.0  # per period of the cut-off, at least


def records(arm: Arm, train: Sequence[str], test: Sequence[str], mapping: Path | str | None) -> list[Record]:
    """Training records, the last is the test record; a single training record gives two.

    Raises InputError where records overlap, are missing, or do not fit the arm.
    """
    if not test:
        raise InputError(
            "found no test record: the gain cannot be measured on what was fitted; record the arm once more, "
            f"or hold its last quarter out: {last_quarter_out(read(train[0], arm, mapping))}"
        )
    check_separate(train, test)
    if len(test) != 1:
        raise InputError(f"found {len(test)} test records, expected one: --test LOG")
    found = [read(spec, arm, mapping) for spec in train]
    if len(found) == 1:
        found = split(found[0])
    return [*found, read(test[0], arm, mapping)]


def settings_for(found: Sequence[Record], cutoff: float | None) -> Settings:
    """A wide band: what friction and backlash do lies far above the motion's own frequencies.

    Narrower for free motions, which lack what drives do and whose noise is all in the positions. The last
    record, the test record, has no say.
    """
    if cutoff is not None and not cutoff > 0.0:
        raise InputError(f"--cutoff: found {cutoff:g} Hz, expected more than 0: a diagnosis needs a band")
    rate, free = 1.0 / found[0].step, found[0].input is None
    widest = FREE_CUTOFF if free else CUTOFF
    chosen = Settings(cutoff=min(widest, rate / SAMPLES) if cutoff is None else cutoff)
    if not free:
        return chosen
    return settings_of_swings(found[:-1], chosen)


@one_thread()
def diagnose(
    arm: Arm,
    found: Sequence[Record],
    *,
    cutoff: float | None = None,
    period: float | None = None,
    progress: Progress | None = None,
    experiment: bool = True,
    effects: Sequence[Place] = (),
    where: Where = HERE,
    known: Callable[[Diagnosis], None] | None = None,
) -> Diagnosis:
    """What the arm's model gets wrong in the records, of which the last is looked at for the errors alone.

    experiment: whether to look for what would separate causes that stand for each other. effects: to be asked
    for alone, with a joint from 1 or at any place; all of the catalogue where there are none. where:
    processes among which the candidates are shared; the answer is the same. known: told what is found before
    that experiment is looked for.
    Raises InputError where the records cannot answer.
    """
    free = found[0].input is None
    other = next((r for r in found if (r.input is None) != free), None)
    if other is not None:
        here, there = ("an effort", "none") if free else ("no effort", "one")
        raise InputError(f"{other.name}: found {here}, {found[0].name} has {there}; expected all alike")
    settings = settings_for(found, cutoff)
    if free:
        found = [released(record, settings) for record in found]
    lengths = [None if free and period is None else period_of(record, period) for record in found[:-1]]
    if period is not None and all(p is None for p in lengths):
        raise InputError(f"--period: found {period:g} s, expected one of which a training record holds two")
    model, evaluator = build_model(arm), Evaluator(arm)
    for made in bands(model, evaluator, found, lengths, settings, narrower=cutoff is None and not free):
        check_efforts(arm, model, made.rows)
        check_one_arm(arm, model, made.rows, evaluator, made.rows[0].baseline.base(made.theta))
        answer = decide(made, model, evaluator, effects, progress, where)
        if answer.verdict != "cannot_tell":
            break
    made, verdict, chosen, rows = answer.made, answer.verdict, answer.made.chosen, answer.made.rows
    train, test = made.prepared[:-1], made.prepared[-1]
    baseline = rows[0].baseline
    base = baseline.base(answer.selection.system.theta[: rows[0].columns.shape[2]])
    apart, selection, evaluator = split_drive_inertia(arm, model, answer.selection, base, rows, evaluator)
    selection = valued(refit_stiffness(selection, rows, evaluator))
    named = _named(selection, answer.equal, evaluator)
    before = fitted(arm, model, rows)
    after = extended(evaluator.arm, before, selection, train)
    last = rows_of(evaluator, model, test, before.theta, baseline)
    pair = residuals(last, before, selection, after, evaluator, base)
    if selection.causes and not free:
        gained = shares(selection, last, evaluator, base)
        named = tuple(replace(cause, share=share) for cause, share in zip(named, gained, strict=True))
    described = replay(before, last)
    played = described, replay(after, last) if selection.causes else described
    result = Diagnosis(
        arm,
        verdict,
        answer.reason,
        named,
        _absorbed(arm, rows, selection, made.narrowed > 1.0),
        answer.fit,
        answer.likeness,
        motion_errors(found[-1], *played) if free else errors(last, *pair, unit_of_efforts(test)),
        played,
        before,
        after,
        base_estimates(after.model, after.rows, after.theta, made.periods),
        None,
        last,
        pair,
        selection,
        {
            "asked": [effect if joint is None else f"{effect}:{joint}" for effect, joint in effects] or "all",
            "train": [record.name for record in found[:-1]],
            "test": found[-1].name,
            "cutoff_hz": chosen.cutoff,
            "position_cutoff_hz": chosen.position_cutoff,
            "factor": chosen.factor,
            "rest_gates": [float(f"{gate:.6g}") for gate in chosen.gates],
            "period_s": [
                None if p is None else float(f"{p * r.step:.9g}")
                for p, r in zip(lengths, found[:-1], strict=True)
            ],
            "evidence_threshold": threshold(selection.system),
            "practical_gain_percent": round(practical(PRACTICAL, made.narrowed), 3),
        },
        Positions(answer.share, answer.noisy),
        apart,
    )
    if known is not None:
        known(result)
    if not experiment or verdict != "named":
        return result
    plan = None if free else stage(arm, model, evaluator, train, base)
    shortest = min((p for p in lengths if p is not None), default=None)
    causes = selection.causes
    following = next_experiment(named, causes, plan, selection.system, shortest, progress, where)
    return replace(result, next_experiment=following)


def _named(
    selection: Selection, equal: Sequence[Sequence[Candidate]], evaluator: Evaluator
) -> tuple[NamedCause, ...]:
    if not selection.causes:
        return ()
    estimates = cause_estimates(selection, evaluator)
    result = []
    for cause, same, values in zip(selection.causes, equal, estimates, strict=True):
        c = cause.trial.candidate
        alias = tuple(other.place for other in same)
        rivals = tuple(
            (*t.candidate.place, behind) for t, behind in cause.rivals if t.candidate.place not in alias
        )
        gains = cause.cross_gain, cause.expected_gain
        result.append(NamedCause(c.effect, c.joint, values, cause.delta_bic, *gains, alias, rivals))
    return tuple(result)


def _absorbed(
    arm: Arm, rows: Sequence[Rows], selection: Selection, coarse: bool
) -> tuple[tuple[str, str], ...]:
    """What these records could not show, whatever is there; what concerns all of them first."""
    n, moved = rows[0].effort.shape[1], any(r.prepared.input is not None for r in rows)
    unsided = [
        j for j in range(1, n + 1) if moved and not at_motor(j, rows) and (coarse or not at_links(j, rows))
    ]
    still = [j + 1 for j in range(n) if not any(r.moving[:, j].any() for r in rows)]
    seen = Seen(cold(rows), tuple(still), tuple(unsided), coarse)
    named = {c.trial.candidate.effect for c in selection.causes}
    presences = [Presence.LATER, Presence.FADING, Presence.ALWAYS]
    order = sorted(
        CATALOGUE.values(),
        key=lambda e: (
            presences.index(e.presence),
            not e.exact,
            e.family is not Family.ELASTIC,
            e.simpler is not None,
        ),
    )
    return tuple((e.name, reason) for e in order for reason in e.hidden(arm, seen, e.name in named))
