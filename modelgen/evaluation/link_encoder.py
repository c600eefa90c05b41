"""An elastic joint or play between a drive and a link whose own motion was measured.

The links' equations along the measured motion give the effort T that is transmitted: where the joint is
elastic, the drive leads the link by T over the stiffness (Spong 1987), and friction and inertia of the drive
act there. In a gap nothing is transmitted (Nordin and Gutman 2002): around a change of the sign of T the link
is loose until it is hit; what T lacks then of a steady load, or has more, is the drive's own motion.
Both follow from the measured motion alone; noise of the efforts has no part in them.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray
from scipy import signal

from modelgen.backends.numpy import NumpyFunction
from modelgen.base_parameters import Grouping
from modelgen.description.objects import Arm
from modelgen.effects import CATALOGUE, Family
from modelgen.evaluation.cache import Recent
from modelgen.evaluation.motion import Motion, evaluated
from modelgen.evaluation.programs import at_motors, links_alone
from modelgen.model.equations import Equations
from modelgen.numeric import Array

CUTOFF = 0.04  # of the rate, where no cut-off is given
STEADY = 1 / 6  # of the cut-off: what of T a rigid drive would transmit through gap and impact
WIDE = 2.0  # over the cut-off [s]: how long impacts ring on either side of the gap
TOLD = 0.02  # of the links' inertia: a drive's below it is not told apart from theirs
GUESS = 0.2  # of the links' inertia: the drive's that is assumed then
OFTEN = 0.5  # of the time: a link that is loose for longer is not told from an elastic one
KEPT = 6  # motions


def at_link(motion: Motion, joint: int | None) -> bool:
    """Whether the position of coordinate `joint` (from 1) is known as measured at the link."""
    return joint is not None and bool(motion.motor_side) and not motion.motor_side[joint - 1]


def led_by(arm: Arm, motion: Motion) -> list[tuple[str, int, dict[str, float]]]:
    """The arm's own elastic joints and play behind links that were measured: effect, joint from 1, values."""
    return [
        (use.name, number, dict(use.values))
        for number, index in enumerate(arm.coordinates, 1)
        if at_link(motion, number)
        for use in arm.joints[index].effects
        if CATALOGUE[use.name].family is Family.ELASTIC
    ]


def compliant(arm: Arm) -> bool:
    """Whether the arm has elastic joints or play: what these do is no column, and follows from parameters."""
    return any(CATALOGUE[u.name].family is Family.ELASTIC for joint in arm.joints for u in joint.effects)


def rigid(arm: Arm) -> Arm:
    """The arm without elastic joints and play."""
    joints = []
    for joint in arm.joints:
        kept = tuple(use for use in joint.effects if CATALOGUE[use.name].family is not Family.ELASTIC)
        joints.append(replace(joint, effects=kept))
    return replace(arm, joints=tuple(joints))


def lagging(states: Array, e: Equations, before: Motion, after: Motion) -> Array:
    """States with the lags and their rates, behind measured links, from motions of links and drives."""
    names, found = e.state_names(), states.copy()
    for effect in e.effects:
        if effect.joint is None or not effect.elastic:
            continue
        n = e.arm.coordinates.index(effect.joint)
        if at_link(before, n + 1):
            lag, rate = (names.index(symbol.name) for symbol in effect.states.values())
            found[:, lag], found[:, rate] = (after.q - before.q)[:, n], (after.dq - before.dq)[:, n]
    return found


class LinkSide:
    """Lead of drives over measured links, and what it adds to the inputs.

    e, base: of the arm. links: inputs (N, n) of the links alone along a motion, for base parameters.
    gain: joint effort per input of coordinate number j at its positions, (N,); lever: the same for the ratio
    of its drive over that in the middle of the stroke.
    """

    def __init__(
        self,
        e: Equations,
        base: Grouping,
        links: Callable[[Motion, Array], Array],
        gain: Callable[[int, Array], Array],
        lever: Callable[[int, Array], Array],
    ) -> None:
        self._drives = NumpyFunction(at_motors(e, base))
        self._arm, self._base = e.arm, base
        self._links, self._gain, self._lever = links, gain, lever
        self._recent: Recent[Array] = Recent(KEPT * len(e.arm.coordinates))

    def added(self, joint: int, motion: Motion, values: dict[str, float], parameters: Array) -> Array:
        """Inputs that an elastic joint, or with `play` a gap, adds, (N, n). joint: from 1.

        Nothing where the gap would keep the link loose most of the time.
        """
        t = self._torque(joint, motion, parameters)
        j, found = joint - 1, np.zeros(motion.q.shape)
        if values.get("play", 0.0) > 0.0:
            loose = self._loose(t, motion, values["play"])
            if loose.mean() <= OFTEN:
                found[:, j] = np.where(loose, t["all_steady"] - t["all"], 0.0) / t["gain"]
            return found
        # friction turns with the sign of a speed, which noise must not; inertia is linear: all of it counts
        moved = replace(self.moved(joint, motion, values, parameters), ddq=motion.ddq)
        found[:, j] = (self.drives(moved, parameters) - self.drives(motion, parameters))[:, j]
        lead = _relaxed(t["links"] / t["lever"] ** 2, values, motion.step)
        found[:, j] += t["inertia"] * _second(lead, motion.step) / t["gain"]
        return found

    def moved(self, joint: int, motion: Motion, values: dict[str, float], parameters: Array) -> Motion:
        """The motion with the drive's position of that coordinate for the link's."""
        t, play = self._torque(joint, motion, parameters), values.get("play", 0.0)
        lead = _relaxed(t["passed"] / t["lever"] ** 2, values, motion.step)
        if play > 0.0:
            lead = lead + play / 2 / t["lever"] * np.clip(
                t["steady"] / _torque_of(play, t, motion), -1.0, 1.0
            )
        rate = np.gradient(lead, motion.step)
        tables = [motion.q.copy(), motion.dq.copy(), motion.ddq.copy()]
        for table, more in zip(tables, (lead, rate, np.gradient(rate, motion.step)), strict=True):
            table[:, joint - 1] += more
        return replace(motion, q=tables[0], dq=tables[1], ddq=tables[2])

    def led(self, motion: Motion, parameters: Array) -> Array:
        """Inputs that the arm's own elastic joints and play behind measured links add, (N, n)."""
        found = np.zeros(motion.q.shape)
        for _, joint, values in led_by(self._arm, motion):
            found += self.added(joint, motion, values, parameters)
        return found

    def at_drives(self, motion: Motion, parameters: Array) -> Motion:
        """The motion with the drives' positions for those of links behind the arm's own of these."""
        found = motion
        for _, joint, values in led_by(self._arm, motion):
            lead = self.moved(joint, motion, values, parameters)
            more = ((lead.q - motion.q), (lead.dq - motion.dq), (lead.ddq - motion.ddq))
            found = replace(found, q=found.q + more[0], dq=found.dq + more[1], ddq=found.ddq + more[2])
        return found

    def drives(self, motion: Motion, parameters: Array) -> Array:
        """Inputs that what acts at the motors takes, (N, n); what has states or reads loads at zero.

        Within a sample fractions of it decide when a drive turns back, by how far it leads: always as means,
        since what is added would jump with the stiffness else.
        """
        known = {"q": motion.q, "dq": motion.dq, "ddq": motion.ddq, "time": motion.t[:, None]}
        known["parameters"] = np.asarray(parameters, dtype=float)
        given = {
            a.name: known[a.name] if a.name in known else np.zeros((len(motion.t), a.size))
            for a in self._drives.function.arguments
        }
        return evaluated(self._drives, given, motion, means=True)

    def _loose(self, t: dict[str, Array], motion: Motion, play: float) -> NDArray[np.bool_]:
        """Samples at which the link may be loose, or be hit: around changes of sign, while T is small."""
        turn = np.diff(t["steady"] > 0.0, prepend=t["steady"][0] > 0.0)
        near = (np.abs(t["steady"]) < _torque_of(play, t, motion)) | turn
        run = np.cumsum(
            np.diff(near, prepend=False)
        )  # numbers stretches that are near, and those that are not
        found = near & np.isin(run, run[turn])
        reach = round(WIDE / _cutoff(motion) / motion.step)
        return np.asarray(np.convolve(found, np.ones(2 * reach + 1), mode="same") > 0.5)

    def _torque(self, joint: int, motion: Motion, parameters: Array) -> dict[str, Array]:
        """Series of a coordinate, (N,): gain; effort that moves the links, below the cut-off (`passed`), its
        slow part (`steady`); effort that moves links and drive (`all`), and its slow part; inertia of the
        drive, as effort per acceleration of the joint; `lever`, the drive's ratio over that in the middle.
        """
        made = self._recent.along(joint, motion, parameters, lambda: self._made(joint, motion, parameters))
        names = ("gain", "links", "passed", "steady", "all", "all_steady", "inertia", "lever")
        return dict(zip(names, made, strict=True))

    def _made(self, joint: int, motion: Motion, parameters: Array) -> Array:
        j = joint - 1
        gain = self._gain(joint, motion.q[:, j])
        ddq = motion.ddq.copy()
        ddq[:, j] += 1.0
        faster = replace(motion, ddq=ddq)
        links = links_alone(self._arm, self._base, joint, parameters)
        here = self._links(motion, links)[:, j] * gain
        heavy = np.abs(self._links(faster, links)[:, j] * gain - here)
        told = (self.drives(faster, parameters) - self.drives(motion, parameters))[:, j] * gain
        inertia = np.where(told > TOLD * heavy, told, GUESS * heavy)
        together = here + told * motion.ddq[:, j]
        cutoff = _cutoff(motion)
        passed = _low_pass(here, cutoff, motion.step)
        slow = (_low_pass(x, STEADY * cutoff, motion.step) for x in (here, together))
        steady, whole = slow
        lever = np.broadcast_to(self._lever(joint, motion.q[:, j]), gain.shape)
        return np.stack([gain, here, passed, steady, together, whole, inertia, lever])


def _torque_of(play: float, t: dict[str, Array], motion: Motion) -> float:
    """Effort by which the drive crosses the gap in a period of the cut-off, from rest."""
    return float(2 * play * np.median(t["inertia"]) * _cutoff(motion) ** 2)


def _relaxed(effort: Array, values: dict[str, float], step: float) -> Array:
    """How far the drive leads by an effort through spring and damper."""
    lead = effort / values["stiffness"]
    relaxation = (values.get("damping") or 0.0) / values["stiffness"]
    if relaxation <= 0.0:
        return lead
    kept = float(np.exp(-step / relaxation))
    return np.asarray(signal.lfilter([1 - kept], [1, -kept], lead, zi=lead[:1] * kept)[0])


def _second(x: Array, step: float) -> Array:
    """Second derivative by central differences, zero at the ends."""
    return np.pad(np.diff(x, 2), 1) / step**2


def _cutoff(motion: Motion) -> float:
    return motion.cutoff or CUTOFF / motion.step


def _low_pass(x: Array, cutoff: float, step: float) -> Array:
    """Forwards and backwards, padded by a period."""
    sections = signal.butter(4, cutoff, fs=1.0 / step, output="sos")
    return np.asarray(signal.sosfiltfilt(sections, x, padlen=min(len(x) - 1, round(1.0 / cutoff / step))))
