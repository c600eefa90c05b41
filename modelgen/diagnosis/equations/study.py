"""The records of a diagnosis from where they move on, their periods, and the usual band."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from modelgen.dataset import Record, Settings
from modelgen.dataset.processing.content import quiet_cutoff
from modelgen.dataset.processing.instants import EffortInstant
from modelgen.dataset.processing.periods import period_of
from modelgen.dataset.processing.splitting import repeating
from modelgen.dataset.reading.jumps import check_jumps
from modelgen.description import Arm
from modelgen.diagnosis.equations.free_motion import released, settings_of_swings
from modelgen.diagnosis.options import Options
from modelgen.diagnosis.options.thresholds import Thresholds
from modelgen.errors import InputError
from modelgen.evaluation import Evaluator
from modelgen.functions import EVALUATED, Model, build_model
from modelgen.identification.cut_off import without_cut_off
from modelgen.identification.effort_instant import at_instants, effort_instant


@dataclass(frozen=True)
class Study:
    """Sources of equations. records: the last is the test record. lengths: samples in a period of each
    training record, None where nothing repeats. settings: of the usual band. narrower: whether that may give
    way to a narrower one where coarse positions spoil it. instant: when the efforts were read, None of free
    motions.
    """

    model: Model
    evaluator: Evaluator
    records: Sequence[Record]
    lengths: Sequence[float | None]
    settings: Settings
    thresholds: Thresholds
    narrower: bool = False
    instant: EffortInstant | None = None

    def at(self, instant: EffortInstant) -> Study:
        """The same with the efforts at this instant."""
        if self.instant is not None:
            instant = replace(instant, channels=self.instant.channels)
        return replace(self, records=at_instants(self.records, instant), instant=instant)


def study_of(arm: Arm, found: Sequence[Record], options: Options) -> Study:
    """Prepare a study: the records from where they move on, their periods, and the usual band.

    Raises InputError where records do not fit together, or none holds the period that is given.
    """
    check_jumps(found)
    free, period, thresholds = found[0].input is None, options.period, options.thresholds
    other = next((r for r in found if (r.input is None) != free), None)
    if other is not None:
        here, there = ("an effort", "none") if free else ("no effort", "one")
        raise InputError(f"{other.name}: found {here}, {found[0].name} has {there}; expected all alike")
    lengths: list[float | None] = [None] * (len(found) - 1)
    if not free:
        trained, lengths = _repeating(found[:-1], period, thresholds)
        found = [*trained, found[-1]]
    settings = settings_for(found, options.cutoff, thresholds)
    # What is left out mixes noise into the band: how much is seen where the motion repeats, and there alone.
    settings = replace(settings, turns=all(p is None for p in lengths))
    if free:
        found = [released(record, settings) for record in found]
        if period is not None:
            lengths = [period_of(record, period, thresholds.dataset) for record in found[:-1]]
    if period is not None and all(p is None for p in lengths):
        raise InputError(
            f"--period: found {period:g} s, expected one of which a training record holds two, "
            "or three where it is the only one, which is split in two"
        )
    train, test = without_cut_off(found[:-1], found[-1:], settings, arm)
    found = [*train, *test]
    instant = effort_instant(found[:-1], arm, thresholds.dataset)
    return Study(
        model=build_model(arm, EVALUATED),
        evaluator=Evaluator(arm),
        records=at_instants(found, instant),
        lengths=lengths,
        settings=settings,
        thresholds=thresholds,
        narrower=options.cutoff is None and not free,
        instant=instant,
    )


def _repeating(
    train: Sequence[Record], period: float | None, thresholds: Thresholds
) -> tuple[list[Record], list[float | None]]:
    """Records from where their motions repeat, and samples in a period of each."""
    found = [repeating(record, period, thresholds.dataset) for record in train]
    return [record for record, _ in found], [lag for _, lag in found]


def settings_for(found: Sequence[Record], cutoff: float | None, thresholds: Thresholds) -> Settings:
    """A wide band: what friction and backlash do lies far above the motion's own frequencies.

    Narrower for free motions, which lack what drives do and whose noise is all in the positions, and where
    nothing repeats: there what other noise of the positions than rounding does is not seen, and the band ends
    where it begins. Of the last record, the test record, the length alone has a say. cutoff: as the user gave
    it [Hz].
    Raises InputError where it is not positive.
    """
    if cutoff is not None and not cutoff > 0.0:
        raise InputError(f"--cutoff: found {cutoff:g} Hz, expected more than 0: a diagnosis needs a band")
    limits, rate, free = thresholds.equations, 1.0 / found[0].step, found[0].input is None
    if cutoff is None:
        widest = limits.max_free_cutoff if free else limits.max_cutoff
        cutoff = min(widest, rate / limits.samples_per_cutoff_period)
        if not free and not any(period_of(record, None, thresholds.dataset) for record in found[:-1]):
            lengths = [len(record.t) * record.step for record in found]
            quiet = quiet_cutoff(found[:-1], thresholds.dataset, lengths, rounding=False)
            cutoff = min(cutoff, quiet)
    chosen = Settings(cutoff=cutoff, thresholds=thresholds.dataset)
    return settings_of_swings(found[:-1], chosen, limits) if free else chosen
