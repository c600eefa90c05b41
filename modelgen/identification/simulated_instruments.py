"""The motion that a model makes in place of a measured one: instruments without the positions' errors."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from modelgen.dataset import Prepared, prepare
from modelgen.dataset.drives import drives_of
from modelgen.dataset.processing.content import motion_bandwidth
from modelgen.dataset.processing.filters import low_pass
from modelgen.description import Arm
from modelgen.errors import InputError
from modelgen.simulation.control import Reference, controller
from modelgen.simulation.plant import plant
from modelgen.simulation.simulate import simulate

OVER_MOTION = 2.5  # bandwidth of the position loop, and of a measured reference, over that of the motion
LOOPS = 4.0  # bandwidth of the velocity loop over that of the position loop, in `cascade`
SAMPLES = 10.0  # of the log per period of the velocity loop, at least


@dataclass(frozen=True)
class Tracking:
    """Simulates an arm under control along each record.

    control: "pi" or "computed_torque". reference: what the controller followed, on the log's time axis;
    None: the measured motion below its own bandwidth, whose noise beyond it the simulation then has not.
    bandwidth: of the velocity loop [Hz], None: enough for the motion.
    """

    arm: Arm
    control: str = "pi"
    reference: Reference | None = None
    bandwidth: float | None = None

    def __call__(self, p: Prepared, parameters: Mapping[str, float]) -> Prepared:
        """The record as the model with these base parameters would have made it.

        Raises InputError where the model does not get through the motion.
        """
        made, rate, record = plant(self.arm, parameters), 1.0 / p.record.step, p.record
        band = OVER_MOTION * motion_bandwidth(record)
        wanted = self.reference or Reference(p.time, low_pass(p.q, min(band, 0.4 * rate), rate, 2))
        if wanted.t[0] > p.time[0] + record.step or wanted.t[-1] < p.time[-1] - record.step:
            raise InputError(
                f"--reference: found {wanted.t[0]:g} to {wanted.t[-1]:g} s, expected it to cover "
                f"{record.name}, {p.time[0]:g} to {p.time[-1]:g} s"
            )
        shifted = Reference(wanted.t - p.time[0], wanted.q)
        bandwidth = self.bandwidth or min(LOOPS * band, rate / SAMPLES)
        q0, dq0, _ = shifted.at(max(0.0, float(shifted.t[0])))
        low, high = made.strokes
        duration = float(p.time[-1] - p.time[0])
        law = controller(made, self.control, shifted, bandwidth, rate)
        try:
            found = simulate(made, np.clip(q0, low, high), dq0, duration, rate, law)
            ended = found.ended
        except InputError as error:
            ended = error.message
        if ended or len(found.q) != len(p.time):
            raise InputError(
                f"--instrument simulated: the model does not get through {record.name}: {ended}; expected "
                "records that determine the inertias well enough, a motion that repeats, or another "
                "--bandwidth"
            )
        motor = np.stack([d.motor(x) for d, x in zip(drives_of(self.arm), found.q.T, strict=True)], axis=1)
        changed = replace(record, q=found.q, motor=motor, motor_side=(), arm=self.arm)
        return replace(prepare(changed, p.settings), before=p.before)
