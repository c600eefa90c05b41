"""Departures of what is measured and commanded from what is there."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

import sympy as sp

from modelgen.description.objects import Arm
from modelgen.effects.base import ANY, POSITIVE, DescriptionEffect, InputEffect, Parameter, Values, at
from modelgen.effects.traits import Added, Family, Numbers, Reading, Seen, Shows, joint_of
from modelgen.effects.variables import InputVariables
from modelgen.numeric import Array
from modelgen.symbolic import number as figure

# Of the greatest torque, two roundings of single precision below it: there the current's slope has no bound.
NEAR_TOP = 1.0 - 2.0**-22
MEASURED = 0.03  # of a length, as drawings and tapes leave it
SMALL_ERROR = 1e-4  # of a torque constant, over which a slope is taken
VANISHING = 1e-9  # of a torque constant, no more than none


class EncoderOffset(DescriptionEffect):
    """The joint is not where its encoder says: the true coordinate is the reading plus the offset."""

    name = "encoder_offset"
    seen_over = "position"
    text = "true coordinate of the joint less the reading"
    finding = "the encoder of {joint} is off by {offset}"
    reference = "Hollerbach, Khalil and Gautier 2016"
    nonlinear = (
        Parameter("offset", "{x}", "true coordinate less the reading", bounds=ANY, step=1e-4, usual=0.02),
    )
    confused_with = ("base_tilt", "spring", "friction_offset")
    reading = Reading("the angle at an index mark or a hard stop, to 0.1 deg", ("offset",), 1.7e-3)
    experiment = "an index mark or a hard stop"
    shown = at(offset=0.03)

    @classmethod
    def usual(cls, arm: Arm, number: int | None) -> Mapping[str, float]:
        """Usual size of an angle; that of a slide depends on the arm's size."""
        slides = number is not None and joint_of(arm, number).type == "prismatic"
        return {} if slides else super().usual(arm, number)

    def changed(self, arm: Arm, joint: int | None, values: Mapping[str, float]) -> Arm:
        """Frame and lever turned by the offset."""
        assert joint is not None
        old, offset = arm.joints[joint], values["offset"]
        if old.type == "prismatic":
            return _with(arm, joint, r=old.r + offset, drive=old.drive.shifted(offset))
        return _with(arm, joint, theta=old.theta + offset, drive=old.drive.shifted(offset))


def _length(name: str, text: str) -> Parameter:
    """An error of one of a lever's lengths."""
    return Parameter(name, "m", text, default=0.0, bounds=ANY, step=1e-6)


class LeverGeometry(DescriptionEffect):
    """Lengths of a lever that differ from the described ones."""

    name = "lever_geometry"
    seen_over = "position"
    text = "true lengths of the lever less the described ones"
    finding = "the lever of {joint} has other lengths than described"
    reference = "Leborne, Creuze, Chemori and Brignone 2018"
    nonlinear = (
        _length("l1", "true l1 less the described one"),
        _length("l2", "true l2 less the described one"),
        _length("length", "true actuator length less the described one"),
    )
    parts = (("l1",), ("l2",), ("length",))
    rereads = True
    overlooked = (5.0, 0.03)  # m, by which a length between pivots may be off however short it is
    confused_with = ("encoder_offset", "position_dependent_friction", "actuator_mass")
    reading = Reading("the lever's lengths, to 0.5 mm", ("l1", "l2", "length"), 5e-4)
    experiment = "a calibration of the lever (modelgen calibrate), or static holds over the whole stroke"
    shown = at(l2=0.001)

    @classmethod
    def stands_at(cls, arm: Arm, number: int | None) -> bool:
        """It stands at a lever."""
        return number is not None and joint_of(arm, number).drive.actuator is not None

    @classmethod
    def usual(cls, arm: Arm, number: int | None) -> Mapping[str, float]:
        """A share of each length."""
        actuator = None if number is None else joint_of(arm, number).drive.actuator
        if actuator is None:
            return {}
        lengths = (actuator.l1, actuator.l2, *actuator.length)
        l1, l2, shortest, longest = (figure(x, arm.symbols) for x in lengths)
        return {"l1": MEASURED * l1, "l2": MEASURED * l2, "length": MEASURED * (shortest + longest) / 2}

    def changed(self, arm: Arm, joint: int | None, values: Mapping[str, float]) -> Arm:
        """The lever with its true lengths; its stroke ends where they no longer close."""
        assert joint is not None
        drive = arm.joints[joint].drive
        if drive.actuator is None:
            raise ValueError("found on a joint without a lever, expected a levered drive")
        actuator = drive.actuator.lengthened(values["l1"], values["l2"], values["length"])
        return _with(arm, joint, drive=drive.with_actuator(actuator))


class DriveGainError(DescriptionEffect):
    """The torque constant of one joint differs from the described one."""

    name = "drive_gain_error"
    seen_over = "position"
    text = "relative error of one joint's torque constant"
    finding = "the torque constant of {drive} is off by {error:%}"
    reference = "Gautier and Briot 2014"
    nonlinear = (
        Parameter(
            "error",
            "1",
            "true over described torque constant, less 1",
            bounds=(-0.9, 9.0),
            step=1e-4,
            usual=0.1,
        ),
    )
    needs_effort = True
    relative = True
    confused_with = ("load_dependent_friction", "torque_constant_saturation")
    experiment = "a run with a known payload"
    shown = at(error=0.1)

    @classmethod
    def stands_at(cls, arm: Arm, number: int | None) -> bool:
        """It stands at a drive."""
        return number is not None and joint_of(arm, number).drive.driven

    @classmethod
    def scales(cls, values: Numbers) -> float | None:
        """It scales the input where nothing else bends that."""
        return 1 / (1 + values["error"])

    @classmethod
    def estimated(cls) -> tuple[str, ...]:
        """What the inputs are more than a drive as described would need, over those: it is in proportion."""
        return ("surplus",)

    @classmethod
    def slopes(cls, names: Sequence[str], values: Numbers, added: Added) -> Array:
        """Inputs per unit of the surplus."""
        error = values.get("error", 0.0) or SMALL_ERROR
        return added({"error": error})[:, :, None] / (1 / (1 + error) - 1)

    @classmethod
    def physical(cls, found: Numbers) -> dict[str, float]:
        """The torque constant from the surplus; far beyond its bounds where none has that much."""
        if "surplus" not in found:
            return dict(found)
        return {"error": 1 / max(1 + found["surplus"], VANISHING) - 1}

    @classmethod
    def usual(cls, arm: Arm, number: int | None) -> Mapping[str, float]:
        """Alike of both, as errors usually are small."""
        found = super().usual(arm, number)
        return {**found, "surplus": found["error"]}

    @classmethod
    def hidden(cls, arm: Arm, seen: Seen, named: bool) -> list[str]:
        """A single joint hides it, where something drives that."""
        if named or len(arm.coordinates) > 1 or not arm.joints[arm.coordinates[0]].drive.driven:
            return []
        return ["the torque constant of a single joint scales all its parameters"]

    def changed(self, arm: Arm, joint: int | None, values: Mapping[str, float]) -> Arm:
        """The drive with its true torque constant."""
        assert joint is not None
        drive = arm.joints[joint].drive
        if not drive.driven:
            raise ValueError("found on a joint without a drive, expected a driven joint")
        constant = drive.torque_constant * (1 + values["error"])
        return _with(arm, joint, drive=drive.with_torque_constant(constant))


class TorqueConstantSaturation(InputEffect):
    """A torque constant that falls at high current."""

    name = "torque_constant_saturation"
    seen_over = "position"
    text = "torque constant that falls with the square of the current"
    finding = "the torque constant of {drive} falls with the current"
    reference = "Gautier and Briot 2014"
    nonlinear = (
        Parameter(
            "coefficient",
            "1/A^2",
            "fall of the torque constant by current squared",
            bounds=POSITIVE,
            step=1e-8,
        ),
    )
    shows = frozenset({Shows.LOAD})
    confused_with = ("nonlinear_viscous_friction", "load_dependent_friction", "drive_gain_error")
    experiment = "a known payload at rest, light and heavy"
    shown = at(coefficient=0.002)

    def effective(self, x: InputVariables, p: Values) -> sp.Expr:
        """i (1 - c i^2), its largest value where i is beyond it."""
        top = 1 / sp.sqrt(3 * p["coefficient"])
        i = sp.Max(-top, sp.Min(top, x.input))
        return i * (1 - p["coefficient"] * i**2)

    def required(self, x: InputVariables, p: Values) -> sp.Expr:
        """The root of y = i (1 - c i^2) that is 0 at y = 0, by the trigonometric solution of the cubic."""
        scale = sp.sqrt(3 * p["coefficient"])
        sine = sp.Max(-NEAR_TOP, sp.Min(NEAR_TOP, sp.Rational(3, 2) * scale * x.input))
        return 2 / scale * sp.sin(sp.asin(sine) / 3)


class TimeDelay(InputEffect):
    """Effort that comes after its command, or a clock of the log that says so."""

    name = "time_delay"
    text = "time by which the effort comes after the logged input"
    finding = "the effort of {place} comes {delay} after the logged input"
    reference = "Swevers, Verdonck and De Schutter 2007"
    scope = "either"
    own_sizes = True
    nonlinear = (
        Parameter(
            "delay",
            "s",
            "time from the logged input to its effort",
            bounds=(-1.0, 1.0),
            step=1e-4,
            usual=0.005,
        ),
        Parameter(
            "order",
            "1",
            "1: it lags as one of a first order with that time constant; 0: along a motion it comes late",
            default=0.0,
            bounds=(0.0, 1.0),
            structural=True,
            forms=(None, 1.0),
        ),
    )
    family = Family.FRICTION  # it looks like what sticking does at reversals
    shows = frozenset({Shows.REVERSALS})
    states = ("lagged",)
    confused_with = ("joint_flexibility", "presliding", "stribeck_friction")
    experiment = "the cross-correlation of a chirp, or a loop-back of the signal"
    shown = at(delay=0.02)
    laws = MappingProxyType({"lag": "delay"})

    @classmethod
    def delays(cls, values: Numbers) -> float | None:
        """Along a motion that is known it is a pure delay, or what a lag makes of it."""
        return values["delay"]

    @classmethod
    def lags(cls, values: Numbers) -> bool:
        """Current loops and filters of readings let the effort or the log lag."""
        return bool(values.get("order", 0.0))

    @classmethod
    def simulated(cls, values: Numbers) -> Mapping[str, float]:
        """A lag of a first order; a negative delay belongs to the log."""
        return {"lag": values["delay"]} if values["delay"] > 0 else {}

    def effective(self, x: InputVariables, p: Values) -> sp.Expr:
        """The input of a first-order lag that has the delay for its time constant."""
        return x.state["lagged"] if p["delay"] > 0 else x.input

    def required(self, x: InputVariables, p: Values) -> sp.Expr:
        """Return the input unchanged: what has not happened yet cannot be commanded."""
        return x.input

    def step(self, x: InputVariables, p: Values, dt: sp.Symbol) -> Mapping[str, sp.Expr]:
        """Exact for a constant input; a negative delay belongs to the log, not to the arm."""
        if not p["delay"] > 0:
            return {"lagged": x.input}
        return {"lagged": x.input + (x.state["lagged"] - x.input) * sp.exp(-dt / p["delay"])}


def _with(arm: Arm, joint: int, **changes: object) -> Arm:
    """The arm with one joint changed."""
    joints = list(arm.joints)
    joints[joint] = replace(joints[joint], **changes)  # type: ignore[arg-type]
    return replace(arm, joints=tuple(joints))
