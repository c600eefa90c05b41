"""Sentences about a diagnosis, as its report and the terminal say them."""

from __future__ import annotations

import numpy as np

from modelgen.diagnosis.result import Diagnosis
from modelgen.diagnosis.validation import Check
from modelgen.effects import CATALOGUE, Family

_SENTENCES = {
    "nothing_missing": "Nothing is missing that these records could show.",
    "outside_catalogue": "Something is missing that is not in the catalogue.",
    "cannot_tell": "These records cannot tell.",
    "suspected": "Nothing can be named, and something is suspected.",
}
_VISIBLE = 0.05  # percent: less is 0.0 in print
_SAME = 0.01  # of an error or a cut-off, that needs no word


def unnamed(d: Diagnosis) -> str:
    """The verdict where no cause is named."""
    if d.verdict == "outside_catalogue" and d.settings["asked"] != "all":
        return "Something is missing that is none of the effects asked for."
    return _SENTENCES[d.verdict]


def worth(d: Diagnosis) -> str:
    """What the causes are worth on the test record: over all joints, at the best and at the worst."""
    gains = np.nan_to_num(d.errors.gain)
    best, worst = int(np.argmax(gains)), int(np.argmin(gains))
    if np.isnan(d.errors.overall):
        return "the test record cannot tell what that is worth"
    said = "the test record is predicted no better"
    if d.errors.overall >= _VISIBLE:
        said = f"{d.errors.overall:.1f} % less error on the test record"
        said += " over all joints" if len(gains) > 1 else ""
    if gains[best] >= _VISIBLE and len(gains) > 1:
        said += f", {gains[best]:.1f} % less at {place_of(best + 1)}"
    if gains[worst] <= -_VISIBLE:
        said += f", {-gains[worst]:.1f} % more at {place_of(worst + 1)}"
    doubted = [c for c in d.causes if any(k.name == "confirmed" and k.passed is False for k in c.checks)]
    names = [f"{c.effect} at {place_of(c.joint)}" for c in doubted]
    return said + (f"; that record does not confirm {' and '.join(names)}" if names else "")


def harms(d: Diagnosis) -> list[str]:
    """Warnings about causes that make the test record worse."""
    return [
        f"With {c.effect} at {place_of(c.joint)} the error on the test record is {-c.share.gain:.1f} % "
        f"larger ({-c.share.high:.1f} to {-c.share.low:.1f} %): what was found does not carry over to that "
        f"record.{CATALOGUE[c.effect].caveat}"
        for c in d.causes
        if c.share.high < 0.0
    ]


def assumptions(d: Diagnosis) -> list[str]:
    """Values taken from the description because no record shows them, what is missing there, and doubts."""
    taken = [
        f"The drive's inertia at {place_of(number)} is taken as {e.value:.3g} {e.unit}, what was identified "
        "of drive and link together beyond the link's nominal inertials: stiffness and play are found with "
        "it. A value under drive_inertia in the description is taken instead."
        for number, e in d.inertias.items()
    ]
    compliant = {c.joint for c in d.causes if CATALOGUE[c.effect].family is Family.ELASTIC}
    unknown = [
        f"The drive's inertia at {place_of(number)} is not told from the link's: the extended model "
        "cannot be simulated, nor its forward dynamics used, until the description gives "
        "drive_inertia a value."
        for drive in d.after.model.grouping.drives
        if drive.nominal is None and (number := d.arm.coordinates.index(drive.joint) + 1) in compliant
    ]
    return taken + unknown + ([] if d.identified is None else list(d.identified.doubts))


def compared(d: Diagnosis) -> list[str]:
    """Why `modelgen identify` says another error of the test record, where it does."""
    if d.identified is None:
        return []
    rmse, usual = d.identified.rmse, d.identified.cutoff
    cutoff, before = float(d.settings["cutoff_hz"]), d.errors.before
    known = np.isfinite(before)
    rested = bool((np.abs(rmse - before) > _SAME * rmse)[known].any())
    if not rested and abs(usual - cutoff) <= _SAME * cutoff:
        return []
    numbers = ", ".join(f"{x:.4g}" for x in rmse)
    at_rest = "fitted with what the filter carries from samples at rest, as identify does, it is"
    counted = f"; {at_rest} {numbers} {d.errors.unit}" if rested else ""
    other = f", identify chooses {usual:.4g} Hz" if abs(usual - cutoff) > _SAME * cutoff else ""
    return [
        f"The error is that up to {cutoff:.6g} Hz, fitted and judged while the joint moves{counted}{other}; "
        f"modelgen identify --cutoff {cutoff:.6g} has this band."
    ]


def suspicions(d: Diagnosis) -> list[str]:
    """What has evidence and is not named, each with the check that it failed."""
    return [
        f"Suspected: {c.effect} at {place_of(c.joint)}, evidence {c.delta_bic:.1f}. It is not named: "
        + "; ".join(f"{name}, {text}" for name, mark, text in map(checked, c.checks) if mark == "no")
        + "."
        for c in d.suspects
    ]


def checked(c: Check) -> tuple[str, str, str]:
    """Name, answer and figures of a check."""
    mark = "not asked" if c.passed is None else "yes" if c.passed else "no"
    if not c.decides and c.passed is False:
        mark = "no, which does not decide"
    figures = (
        f" ({c.value:.3g}, threshold {c.threshold:.3g})" if np.isfinite([c.value, c.threshold]).all() else ""
    )
    return c.name, mark, c.text + figures


def place_of(joint: int | None) -> str:
    """Where an effect acts, in words."""
    return "the whole arm" if joint is None else f"joint {joint}"
