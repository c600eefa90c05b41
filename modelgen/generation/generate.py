"""Arms become folders of generated code, or a list of what has drifted from them."""

from __future__ import annotations

import os
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from modelgen.description.objects import Arm
from modelgen.errors import InputError
from modelgen.functions import Options
from modelgen.generation.arm import GeneratedArm
from modelgen.generation.budget import Budget, Excess, excesses
from modelgen.generation.folders import ARTEFACTS, check_output, differences, write_folder
from modelgen.generation.pool import generate_arms


@dataclass(frozen=True)
class Drift:
    """A file that differs from what would be generated: "missing", "changed" or "extra"."""

    path: Path
    kind: str


@dataclass(frozen=True)
class Report:
    """Results of a generation; a check alone fills `drift`, a budget alone `excess`."""

    arms: tuple[GeneratedArm, ...]
    drift: tuple[Drift, ...] = ()
    excess: tuple[Excess, ...] = ()


def generate(
    arms: Sequence[Arm],
    out: Path,
    options: Options,
    *,
    check: bool = False,
    artefacts: Collection[str] = (),
    budget: Budget | None = None,
    processes: int | None = None,
    progress: Callable[[str], None] = lambda _: None,
    identified: Mapping[str, Mapping[str, float]] | None = None,
) -> Report:
    """Write the folder `out/<arm>` of every arm, or with `check` compare it and write nothing.

    `artefacts` are those of ARTEFACTS to build as well; a check looks at no others.
    With `budget` nothing is written either where a function exceeds it.
    Nothing is written before every arm has been generated, and each folder is replaced whole.
    identified: values of base parameters by name, by arm, to be folded in; the options' for the others.
    `processes` is one per processor by default. Raises InputError for an arm that has no model, for
    arms whose names collide in C or on the disk, and where `out` cannot be written.
    """
    _refuse_same_folder(arms)
    if not check:
        check_output(out, [arm.name for arm in arms])
    generated = generate_arms(
        arms, options, processes or os.cpu_count() or 1, progress, artefacts, identified
    )
    refuse_collisions(arms, generated)
    if budget is not None:
        excess = excesses(generated, budget)
        if excess:
            return Report(tuple(generated), excess=tuple(excess))
    if check:
        unasked = [name for name in ARTEFACTS if name not in artefacts]
        drift = [
            Drift(out / arm.name / name, kind)
            for arm in generated
            for name, kind in differences(out / arm.name, {**arm.files, **arm.artefacts}, unasked)
        ]
        return Report(tuple(generated), tuple(drift))
    for arm in generated:
        write_folder(out / arm.name, {**arm.files, **arm.artefacts})
    return Report(tuple(generated))


def refuse_collisions(arms: Sequence[Arm], generated: Sequence[GeneratedArm]) -> None:
    """Raise InputError where two arms take the same name in C, in whatever case."""
    taken: dict[str, str] = {}
    for arm, result in zip(arms, generated, strict=True):
        for symbol in sorted(result.symbols):
            other = taken.setdefault(symbol, result.name)
            if other != result.name:
                raise InputError(
                    f"the arms '{other}' and '{result.name}' would both define '{symbol}' in C; rename one",
                    arm.where,
                )


def _refuse_same_folder(arms: Sequence[Arm]) -> None:
    seen: dict[str, str] = {}
    for arm in arms:
        other = seen.setdefault(arm.name.lower(), arm.name)
        if other != arm.name:
            raise InputError(
                f"the arms '{other}' and '{arm.name}' would share a folder and C names: they differ in case "
                "alone; rename one",
                arm.where,
            )
