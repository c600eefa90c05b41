"""What was checked where nothing is missing: a mark with its figures for each."""

from __future__ import annotations

import numpy as np

from modelgen.charts import number
from modelgen.diagnosis.adequacy import LackOfFit
from modelgen.diagnosis.result import Diagnosis
from modelgen.identification.unexplained import FAR
from modelgen.numeric import Array
from modelgen.report.diagnosis_figures import units_of
from modelgen.report.diagnosis_sentences import efforts_of
from modelgen.report.page import Marks
from modelgen.report.ranking import strongest
from modelgen.report.words import listed

_UNKNOWN = "no period repeats in the training records, by which the noise could be measured"
_ASIDE = "; reported, decides nothing"
Mark = tuple[str, str, str]


def complete(d: Diagnosis) -> Marks | None:
    """Marks of a diagnosis that misses nothing; None of another one, and of free motions."""
    if d.verdict != "nothing_missing" or d.free:
        return None
    return Marks("complete", [_repeating(d), _candidates(d), _least(d), _unseen(d)])


def noise(d: Diagnosis, fit: LackOfFit) -> Array:
    """RMS (n,) of what of the training records' error does not repeat, in the unit of the log's efforts.

    The mean square of what repeats adds to the noise's, and k periods make (F - 1) / k of the noise's of it.
    """
    left = [(np.square((r.effort - r.columns @ d.before.theta) * r.gain), r.moving) for r in d.before.rows]
    square = sum(np.where(moving, x, 0.0).sum(axis=0) for x, moving in left)
    count = sum(moving.sum(axis=0) for _, moving in left)
    share = np.maximum(fit.by_joint - 1.0, 0.0) / fit.periods
    return np.asarray(np.sqrt(square / np.maximum(count, 1) / (1.0 + share)))


def _repeating(d: Diagnosis) -> Mark:
    fit, name = d.lack_of_fit, "no lack of fit"
    if fit is None:
        return "unasked", name, _UNKNOWN
    figures = f"{fit.statistic:z.2f}, threshold {fit.threshold:z.2f}"
    return "no" if fit.found else "yes", name, f"{figures}: above it more than noise repeats"


def _candidates(d: Diagnosis) -> Mark:
    """The candidate with most evidence beside what a cause needs."""
    tried = strongest(d.arm, d.ranking)
    least = float(d.settings["evidence_threshold"])
    needed = f"a cause needs {least:z.1f} and has to pass the other checks"
    return "yes", "no candidate", f"{tried}; {needed}" if tried else f"none has evidence; {needed}"


def _least(d: Diagnosis) -> Mark:
    """How large what repeats has to be at each joint for the lack of fit to reach its threshold."""
    fit, name, efforts = d.lack_of_fit, "sensitive", efforts_of(d)
    if fit is None or efforts is None:
        return "unasked", name, _UNKNOWN
    above = [t.threshold - 1.0 for t in fit.tests if t.kind == "whole"]
    sizes = noise(d, fit) * np.sqrt(np.maximum(above, 0.0) / fit.periods)
    said = [
        f"{number(size, 2)} of {number(effort, 2)} {unit} at {joint}"
        for size, effort, unit, joint in zip(sizes, efforts, units_of(d), d.arm.coordinate_names, strict=True)
        if np.isfinite(size) and size > 0.0 and np.isfinite(effort)
    ]
    if not said:
        return "unasked", name, _UNKNOWN
    return (
        "yes",
        name,
        f"what repeats shows from {listed(said)} on (RMS, over all rows), less can hide{_ASIDE}",
    )


def _unseen(d: Diagnosis) -> Mark:
    """The error on the test record beside the noise of the training records."""
    fit, name = d.lack_of_fit, "test record"
    if fit is None:
        return "unasked", name, _UNKNOWN
    before, of_noise = d.errors.before, noise(d, fit)
    times = np.nan_to_num(before / np.maximum(of_noise, 1e-300), posinf=0.0)
    j = int(np.argmax(times))
    sizes = f"{number(before[j], 2)} beside {number(of_noise[j], 2)} {units_of(d)[j]} (RMS)"
    where = "" if len(times) == 1 else f" at {d.arm.coordinate_names[j]}, where it is most"
    figures = f"its error is {times[j]:z.2g} times the noise of the training records{where}: {sizes}{_ASIDE}"
    return "yes" if times[j] < FAR else "no", name, figures
