"""What to do after a diagnosis: a sentence, a command, an experiment."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from modelgen.diagnosis.result import Diagnosis, to_json
from modelgen.effects import CATALOGUE
from modelgen.effects.placement import Found, titled
from modelgen.options import words_of
from modelgen.report.call import WHERE, Call, command
from modelgen.report.diagnosis_sentences import beside, cause_title, harmful, no_arm, repeating_sizes
from modelgen.report.experiment import followed
from modelgen.report.words import listed, place_of

# What is without the causes that make the test record worse: a description, a folder beside the page.
REDUCED = "reduced"
# What has values that an arm can have: a folder beside the page.
POSSIBLE = "consistent"
_EXPLAIN = "Do not generate code from values that no arm has."
_NEAREST = "modelgen identify --consistent"
RESIDUALS = "Residuals over speed, position, load and more"  # a fold of the report
_LOOK = f'Look at "{RESIDUALS}" in the report: over what they bend, and at which joint.'
# By verdict, where another motion is what helps.
_MOTIONS = {
    "cannot_tell": "Record a motion that moves every joint over its range, several periods in a row.",
    "outside_catalogue": f"{_LOOK} Another motion helps.",
    "suspected": "Record another motion and add its log to the training records.",
}
# The same where nothing drives the arm.
_RELEASES = {
    "cannot_tell": "A release that does not repeat shows no noise: tune the parameters on the motion, and "
    "see whether it is missed by more than the encoders' noise.",
    "outside_catalogue": f"{_LOOK} Releases from other angles help.",
    "suspected": "Release the arm from other angles and add these logs to the training records.",
}
_COARSE = (
    "Use finer encoders; else record a motion that goes farther, or is faster, beside which their steps are "
    "smaller."
)
_REMAINS = (
    "Something remains that is not named{sizes}: the values of what is named hold as far as it does not act "
    "on them."
)
_EVERY = "Only some effects were asked for: ask for all of the catalogue."


@dataclass(frozen=True)
class Step:
    """What to do; command: empty where none does it. mends: whether it is the log that is to be mended.
    warns: whether it says how far to trust what follows it.
    """

    text: str
    command: str = ""
    mends: bool = False
    warns: bool = False


def following(d: Diagnosis, call: Call) -> list[Step]:
    """Steps, the first one first. call: how the diagnosis was asked for, with the folder of its report."""
    steps = [*_mending(d), *_first(d, call)]
    if d.next_experiment is not None:
        steps.append(Step(f"To separate the cause from its rivals: {followed(d.next_experiment)}."))
    else:
        steps += [Step(text) for text in _by_itself(d)]
    return steps


def _mending(d: Diagnosis) -> list[Step]:
    """Questions about channels that are older than the others: a further log will have them so too."""
    return [] if d.identified is None else [Step(text, mends=True) for text in d.identified.late]


def _first(d: Diagnosis, call: Call) -> list[Step]:
    """What the verdict asks for: the code of what was found, or another motion."""
    if d.verdict in _MOTIONS:
        return [asked_next(d, call)[1]]
    code = _generating(d, call, _described(d, call))
    if d.verdict == "named":
        steps = carried(d, call) or possible_links(d, call)
        steps = steps or [Step(f"Generate the code of the extended model, {WHERE}:", code)]
        return [_remaining(d), *steps] if beside(d) else steps
    if no_arm(d):
        return possible_links(d, call)
    text = f"Use the model as described, with its parameters from these records; its code, {WHERE}:"
    return [Step(text, code)]


def _remaining(d: Diagnosis) -> Step:
    """What the causes leave, and how large that is."""
    sizes = listed(repeating_sizes(d).values())
    said = _REMAINS.format(sizes=f", about {sizes} (RMS)" if sizes else "")
    return Step(f"{said} {_LOOK}", warns=True)


def whole_json(d: Diagnosis, call: Call) -> dict[str, Any]:
    """diagnosis.json, with what the page proposes as `next_experiment`.

    That is what separates a cause from its rivals, or what is to be done where nothing is named or a channel
    is to be mended, with its command; None else. call: as of `following`.
    """
    said = to_json(d)
    mending = [step.text for step in _mending(d)]
    if d.next_experiment is None and (mending or d.verdict in _MOTIONS):
        what, step = asked_next(d, call) if d.verdict in _MOTIONS else ("", Step(""))
        said["next_experiment"] = {
            "separates": [],
            "do": " ".join([*mending, what]).rstrip(),
            "command": step.command or None,
            "trajectory": None,
            "tests": [{"test": text, "expected_delta_bic": None} for text in _by_itself(d)],
        }
    return said


def _by_itself(d: Diagnosis) -> list[str]:
    """What shows each effect by itself, that was named or is suspected; none where nothing drives the arm."""
    if d.free:
        return []
    places: dict[str, list[int | None]] = {}
    for c in (*d.causes, *d.suspects):
        places.setdefault(c.effect, []).append(c.joint)
    return [
        f"To see {_wherever(d, effect, joints)} by itself: {CATALOGUE[effect].experiment}."
        for effect, joints in places.items()
        if CATALOGUE[effect].experiment
    ]


def proposed(d: Diagnosis, call: Call) -> list[Step]:
    """Steps that the terminal offers at the end, each with a command where there is one."""
    return [*_mending(d), *_first(d, call), *replaying(d, call)]


def carried(d: Diagnosis, call: Call) -> list[Step]:
    """Steps to a model without the causes that make the test record worse; none where no cause does."""
    worse = harmful(d)
    if not worse:
        return []
    names = listed(cause_title(d, c) for c in worse)
    reduced = reduced_name(d)
    description = call.beside(reduced) if reduced else call.description
    what = f"{reduced}, the description without {names}" if reduced else f"the description, without {names}"
    if d.free:
        fit = call.refining(REDUCED, description)
        text, by = f"Tune {what}, on the releases", "refine"
    else:
        fit = call.identifying(REDUCED, description, float(d.settings["cutoff_hz"]))
        text, by = f"Fit {what}, to the records", "identify"
    if not fit:
        return [Step(f"{text} by modelgen {by}, and generate its code.")]
    return [
        Step(f"{text}, {WHERE}:", fit),
        Step("Then generate its code:", _generating(d, call, description, REDUCED)),
    ]


def possible_links(d: Diagnosis, call: Call) -> list[Step]:
    """Steps to values that an arm can have; none where all can be those of one."""
    if not no_arm(d):
        return []
    description = _described(d, call)
    fit = call.identifying(POSSIBLE, description, float(d.settings["cutoff_hz"]), consistent=True)
    if not fit:
        return [Step(f"{_EXPLAIN} The nearest values of links that could exist are those of {_NEAREST}.")]
    return [
        Step(f"{_EXPLAIN} The nearest values of links that could exist, {WHERE}:", fit),
        Step("Then generate its code:", _generating(d, call, description, POSSIBLE)),
    ]


def replaying(d: Diagnosis, call: Call) -> list[Step]:
    """The model that the diagnosis offers, simulated along the test record; none where nothing is named.

    Where a cause makes that record worse, it is the model without it, once that is fitted.
    """
    if not d.causes:
        return []
    worse, folder, name = bool(harmful(d)), "", ""  # a description of one arm needs no name
    description = call.beside(f"{d.arm.name}_extended.yaml")
    against = "the whole test record, rest included:" if d.free else "the test record:"
    text = f"The extended model against {against}"
    if worse:
        reduced, folder = reduced_name(d), f"{REDUCED}/"
        description, name = (call.beside(reduced), "") if reduced else (call.description, d.arm.name)
        text = f"Once that is fitted, compare it with {against}"
    elif no_arm(d):
        folder, text = f"{POSSIBLE}/", f"Once that is fitted, compare it with {against}"
    words = ["--parameters", call.beside(f"{folder}{d.arm.name}_parameters.yaml")]
    words += [word for log in call.test for word in ("--log", log)]
    words += words_of(call.options, ("mapping",))
    if not d.free:  # as its motion is simulated on the page
        words += ["--window", f"{d.settings['simulated_window_s']:g}"]
    return [Step(text, command("simulate", description, name, *words))]


def reduced_name(d: Diagnosis) -> str:
    """File of the description with all causes but those that harm; empty where there is none."""
    return f"{d.arm.name}_{REDUCED}.yaml" if 0 < len(harmful(d)) < len(d.causes) else ""


def reduced_causes(d: Diagnosis) -> list[Found]:
    """What the description is extended by, without the causes that harm the test record."""
    worse = [(c.effect, c.joint) for c in harmful(d)]
    return [found for found in d.added if found[:2] not in worse]


def _described(d: Diagnosis, call: Call) -> str:
    """Path of the description that is gone on with: the extended one where something is named, else that of
    the call, unless no file has it.
    """
    return call.beside(f"{d.arm.name}_extended.yaml") if d.causes or call.first else call.description


def _generating(d: Diagnosis, call: Call, description: str, folder: str = "") -> str:
    """The command for the code of a description, with the parameters in a folder beside the page."""
    values = call.beside(f"{folder}/{d.arm.name}_parameters.yaml".lstrip("/"))
    return call.command("generate", "--parameters", values, description=description)


def _wherever(d: Diagnosis, effect: str, joints: Sequence[int | None]) -> str:
    """An effect at every place where it acts."""
    if len(joints) == 1:
        return titled(d.arm, effect, joints[0])
    return f"{effect} at {listed(place_of(d.arm, joint) for joint in joints)}"


def asked_next(d: Diagnosis, call: Call) -> tuple[str, Step]:
    """What to do where nothing is named, by itself and with its command.

    That is to ask for all effects, where only some were asked for; else to record another motion, with the
    speeds of the test record where the arm has no limits.
    """
    if d.settings["asked"] != "all":
        every = call.diagnosing()
        return _EVERY, Step(f"{_EVERY} This does, {WHERE}:" if every else _EVERY, every)
    if d.free:
        text = _RELEASES[d.verdict]
        refine = call.refining("refined", call.description) if d.verdict == "cannot_tell" else ""
        return text, Step(f"{text} This does, {WHERE}:" if refine else text, refine)
    feigned = 0.0 if d.positions is None else float(d.positions.feigned.max())
    coarse = d.verdict == "cannot_tell" and feigned > float(d.settings["practical_gain_percent"])
    text = _COARSE if coarse else _MOTIONS[d.verdict]
    p = d.test.prepared
    speeds = np.abs(p.picked(p.dq)).max(axis=0).tolist()
    description = _described(d, call)
    excite = call.exciting(call.beside("trajectory.csv"), speeds, description)
    one = "one that goes farther" if coarse else "one"
    return text, Step(f"{text} This computes {one}, {WHERE}:" if excite else text, excite)
