"""What to do after a refinement."""

from __future__ import annotations

import numpy as np

from modelgen.identification.objects import MATTERS
from modelgen.identification.output_error.refine import Refinement
from modelgen.options import words_of
from modelgen.report.call import WHERE, Call
from modelgen.report.page import Command, Part, Run, Text
from modelgen.report.words import listed, sentence

_RELEASES = 3  # that a diagnosis of free motions needs: a release is not split in two
_NEAR = "if the simulated motion is near enough to the measured one all the same"
SAME = 1.01  # of an error, that needs no word
_LISTED = 6  # parameters by their names


def following(call: Call, found: Refinement) -> list[Part | str]:
    """The code, where there is a reason to have the values in it, and what the model lacks.

    Where values are not determined, what determines them comes first.
    """
    loose = _loose(found)
    if not found.converged and not gained(found):
        return [*_first(call, _elsewhere(call, found)), *_lacking(call, found)]
    if not gained(found):
        return [*_first(call, _from_start(call)), *_lacking(call, found)]
    code = _folded_in(call, found.converged)
    if not loose:
        return [*_first(call, code), *_lacking(call, found)]
    more = _further(call, found, loose)
    text, command = code
    least = Text(sentence(f"for motions like {'this one' if len(found.t) == 1 else 'these'} alone, {text}:"))
    return [*_first(call, more), *_lacking(call, found), least, Command(command)]


def _first(call: Call, step: tuple[str, str]) -> list[Part | str]:
    """A sentence with its command, where it has one, that comes first."""
    text, command = step
    said = sentence(f"{text}:" if command else text)
    return [Text(f"{call.first}{said}"), *([Command(command)] if command else [])]


def _folded_in(call: Call, converged: bool) -> tuple[str, str]:
    """How to generate the code of what was found."""
    text = f"generate code with these values folded in, {WHERE}"
    values = call.beside(f"{call.arm.name}_parameters.yaml")
    return text if converged else f"{_NEAR}, {text}", call.command("generate", "--parameters", values)


def _elsewhere(call: Call, found: Refinement) -> tuple[str, str]:
    """Where another refinement begins, of one that found nothing."""
    text = "this says nothing of the parameters: generate no code by it"
    if found.effort and words_of(call.options, ("parameters",)):  # it began at values of a fit
        often = "begin the simulation anew more often, or take another part of the record"
        again = call.refining_again("again", _shorter(call, found))
        return f"{text}. {sentence(often)}{f' This begins anew more often, {WHERE}' if again else ''}", again
    near = "begin nearer, by --parameters; or with a shorter --window, or another part of the record"
    fit = call.identifying("identified", call.description) if found.effort else ""
    if not fit:
        return f"{text}. {sentence(near)}", ""
    return f"{text}. Identify the parameters, and {near}; this identifies them, {WHERE}", fit


def _shorter(call: Call, found: Refinement) -> float:
    """Half the window [s]; of a record that was simulated from end to end, a twentieth."""
    window = getattr(call.options, "window", None)
    length = max(float(t[-1] - t[0]) for t in found.t)
    return float(f"{window / 2.0 if window else length / 20.0:.2g}")


def _from_start(call: Call) -> tuple[str, str]:
    """How to generate the code of the start, which is from a file, else the description."""
    values = words_of(call.options, ("parameters",)) or ["--nominal"]
    return f"generate code with the values of the start, {WHERE}", call.command("generate", *values)


def _further(call: Call, found: Refinement, loose: list[str]) -> tuple[str, str]:
    """What determines the values that these motions leave open."""
    names = listed([*loose[:_LISTED], *([f"{len(loose) - _LISTED} more"] if loose[_LISTED:] else [])])
    verb = "is" if len(loose) == 1 else "are"
    whose = "its standard deviation moves" if len(loose) == 1 else "the standard deviation of each moves"
    text = f"generate no code yet: {names} {verb} not determined, {whose} the motion by more than it errs"
    if not found.effort:
        return f"{text}. Give refine releases from other angles too, each by a --log of its own", ""
    text = f"{text}. Give refine further motions too, each by a --log of its own"
    pairs = zip(found.measured, found.t, strict=True)
    speeds = np.max([np.abs(np.gradient(q, t, axis=0)).max(axis=0) for q, t in pairs], axis=0)
    excite = call.exciting(call.beside("trajectory.csv"), speeds.tolist())
    return (f"{text}. This computes one, {WHERE}" if excite else text), excite


def _loose(found: Refinement) -> list[str]:
    """Names of parameters whose uncertainty moves the motion by more than it errs, and by what matters of it,
    worst first.
    """
    least = MATTERS / 100.0 * np.std(np.concatenate(found.measured), axis=0)
    errors = np.maximum(found.after.rmse, least)
    times = {x.name: x.moves / float(errors[x.shown_by]) for x in found.parameters if x.std}
    return [name for name in sorted(times, key=lambda name: -times[name]) if times[name] > 1.0]


def _lacking(call: Call, found: Refinement) -> list[Part | str]:
    """What names the cause where the motion still differs."""
    diagnose = call.diagnosing()
    if diagnose and (found.effort or len(call.train) + len(call.test) >= _RELEASES):
        return [
            Text("Where the motion still differs by more than its noise, this names the cause."),
            Command(diagnose),
        ]
    more = "a second motion, which nothing is fitted to"
    place = "this record is for "
    if not found.effort:
        more = f"{_RELEASES} releases or more"
        place = "name each of them but the last by a "
    ends = (", the second for ", ".") if found.effort else (" of its own, the last one by ", ".")
    named = [
        Run(f"Where the motion still differs by more than its noise, record {more}, and let "),
        Run("modelgen diagnose", "code"),
        Run(f" find the cause: {place}"),
        Run("--train", "code"),
        Run(ends[0]),
        Run("--test", "code"),
        Run(ends[1]),
    ]
    return [Text(named)]


def gained(found: Refinement) -> bool:
    """Whether the simulated motion of some joint is nearer to the measured one than at the start."""
    return bool((found.before.rmse > SAME * found.after.rmse).any())
