"""How likely the values of a cause are before any record: by how much descriptions usually are wrong.

Several errors of a description, and what a mechanism has besides, look alike where each may have any value.
A value is charged as a Cauchy distribution does: hardly anything up to its scale, and slowly more beyond
(Gelman, Jakulin, Pittau and Su 2008), so that evidence still prevails where there is much of it. Of an
effect that is tried in several forms each form has its share of the effect's prior.
"""

from __future__ import annotations

import math
from collections.abc import Mapping

from modelgen.description.objects import Arm
from modelgen.diagnosis.candidates.candidate import WEIGHING, Candidate
from modelgen.symbolic import number

# Scales that no arm tells: rad where the joint turns, of the torque constant, s.
USUAL: Mapping[str, Mapping[str, float]] = {
    "encoder_offset": {"offset": 0.02},
    "base_tilt": {"x": 0.03, "y": 0.03, "z": 0.03},
    "drive_gain_error": {"error": 0.1},
    "time_delay": {"delay": 0.005},
}
MEASURED = 0.03  # of a length, as drawings and tapes leave it
HEAVY = 0.3  # of the mass of all links, of one actuator
# Times the scale, beyond which nobody overlooks it: at a glance, with a tape, or in the hand.
OBVIOUS = {"base_tilt": 10.0, "lever_geometry": 5.0, WEIGHING: 10.0}
HIDDEN = 0.03  # m, by which a length between pivots may be off however short it is


def prior_penalty(candidate: Candidate, values: Mapping[str, float], arm: Arm) -> float:
    """What the candidate's values and its other forms take off its delta BIC."""
    scales = usual(candidate, arm)
    charged = sum(math.log1p((values[name] / scale) ** 2) for name, scale in scales.items() if name in values)
    return 2.0 * (charged + math.log(candidate.forms))


def place_penalty(candidate: Candidate) -> float:
    """What the effect's other places take off the odds of the candidate against one of another effect.

    No effect is likelier than another before any record: one that may be at every joint is as likely at each
    as its share. Whether anything is there at all is asked of the evidence alone.
    """
    return 2.0 * math.log(candidate.places)


def beyond_plausible(candidate: Candidate, values: Mapping[str, float], arm: Arm) -> bool:
    """Whether someone would have seen it, so that the records must be about something else."""
    times = OBVIOUS.get(candidate.effect, math.inf)
    least = HIDDEN if candidate.effect == "lever_geometry" else 0.0
    scales = usual(candidate, arm)
    return any(abs(values.get(name, 0.0)) > max(times * scale, least) for name, scale in scales.items())


def usual(candidate: Candidate, arm: Arm) -> Mapping[str, float]:
    """Scales of the parameters, those alone of which something is known."""
    if candidate.joint is None:
        return USUAL.get(candidate.effect, {})
    joint = arm.joints[arm.coordinates[candidate.joint - 1]]
    if candidate.effect == "encoder_offset" and joint.type == "prismatic":
        return {}
    actuator = joint.drive.actuator
    if actuator is None:
        return USUAL.get(candidate.effect, {})
    lengths = (actuator.l1, actuator.l2, *actuator.length)
    l1, l2, shortest, longest = (number(x, arm.symbols) for x in lengths)
    if candidate.effect == "lever_geometry":
        return {"l1": MEASURED * l1, "l2": MEASURED * l2, "length": MEASURED * (shortest + longest) / 2}
    mass = HEAVY * sum(link.mass for link in arm.links if link is not None)
    if candidate.effect == WEIGHING and mass > 0:  # a rod of it
        moment = mass * longest / 2
        return {"inertia": mass * longest**2 / 3, "moment_x": moment, "moment_y": moment}
    return USUAL.get(candidate.effect, {})
