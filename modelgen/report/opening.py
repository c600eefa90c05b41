"""The first sentences of a diagnosis in the terminal."""

from __future__ import annotations

from modelgen.charts import at_joints
from modelgen.diagnosis.result import Diagnosis
from modelgen.report.diagnosis_sentences import beside, by_worth, doubted, headline, missing, worth
from modelgen.report.words import sentence

_SPOKEN = 3  # causes in sentences
_MOST = 0.8  # of the samples, from which on what is left out is said of a joint


def opening(d: Diagnosis) -> str:
    """The sentences that the page has, of many causes those of most worth."""
    if d.verdict != "named":
        return " ".join(part for part in (headline(d), hardly_moved(d)) if part)
    texts, order = missing(d), by_worth(d)
    said = [texts[k] for k in order[:_SPOKEN]]
    if order[_SPOKEN:]:
        said.append(f"And {len(order) - _SPOKEN} more, in the table.")
    more = [part for part in (beside(d), hardly_moved(d)) if part]
    return " ".join([*said, sentence(worth(d)), *more, *doubted(d)])


def hardly_moved(d: Diagnosis) -> str:
    """Joints of which most samples of driven records are left out, for they rest; empty where none is."""
    shares = [] if d.free else d.log.shares_left_out
    resting = [(name, share) for name, share in zip(d.log.joints, shares, strict=False) if share > _MOST]
    if not resting:
        return ""
    where = at_joints(
        [name for name, _ in resting], [f"{100 * share:.0f} % of the samples" for _, share in resting]
    )
    return f"Left out at rest: {where}; these records say little of what is missing there."
