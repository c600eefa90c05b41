"""All effects by name: every class of the modules below that has one."""

from __future__ import annotations

from types import ModuleType

from modelgen.effects.base import Definition, Parameter
from modelgen.effects.laws import (
    compliance,
    environment,
    measurement,
    mechanism,
)
from modelgen.effects.laws import (
    dry_friction as friction_dry,
)
from modelgen.effects.laws import (
    velocity_friction as friction,
)

MODULES = (friction, friction_dry, mechanism, compliance, environment, measurement)
# What is printed first, in this order; others follow in the order of their modules.
FIRST = (
    "viscous_friction",
    "coulomb_friction",
    "friction_offset",
    "asymmetric_viscous_friction",
    "stribeck_friction",
    "load_dependent_friction",
    "nonlinear_viscous_friction",
    "position_dependent_friction",
    "friction_warm_up",
    "presliding",
    "drive_inertia",
    "torque_ripple",
    "backlash",
    "joint_flexibility",
    "transmission_coupling",
    "lever_geometry",
    "actuator_mass",
    "spring",
    "payload_change",
    "fluid_drag",
    "added_mass",
    "base_tilt",
    "drive_gain_error",
    "torque_constant_saturation",
    "encoder_offset",
    "time_delay",
)


def collected(modules: tuple[ModuleType, ...]) -> dict[str, type[Definition]]:
    """The effects that the modules define, by name. Raises ValueError where two have one name."""
    found: dict[str, type[Definition]] = {}
    for module in modules:
        for thing in vars(module).values():
            own = isinstance(thing, type) and thing.__module__ == module.__name__
            # a class without a name is what several effects have in common
            if not own or not issubclass(thing, Definition) or "name" not in vars(thing):
                continue
            if thing.name in found:
                raise ValueError(f"two effects are called {thing.name}")
            found[thing.name] = thing
    first = {name: k for k, name in enumerate(FIRST)}
    return {name: found[name] for name in sorted(found, key=lambda n: first.get(n, len(first)))}


CATALOGUE: dict[str, type[Definition]] = collected(MODULES)


def known_effects() -> dict[str, tuple[str, ...]]:
    """Names of the parameters that a description may set, by effect."""
    return {name: tuple(p.name for p in effect.accepted()) for name, effect in CATALOGUE.items()}


def effect_texts() -> dict[str, str]:
    """What every effect is, every parameter with its unit, by the names "spring" and "spring.stiffness"."""
    found = {}
    for name, effect in CATALOGUE.items():
        found[name] = f"{effect.text}. {effect.reference}"
        for parameter in effect.accepted():
            default = "" if parameter.default is None else f"; default {parameter.default:g}"
            found[f"{name}.{parameter.name}"] = f"{parameter.text} [{unit_text(effect, parameter)}]{default}"
    return found


def unit_text(effect: type[Definition], parameter: Parameter) -> str:
    """A parameter's unit in words that hold for every joint and drive."""
    turning, sliding = (parameter.unit.format(f=f, x=x, q=x) for f, x in (("N m", "rad"), ("N", "m")))
    if turning == sliding:
        return turning
    if effect.side == "motor":
        return f"{turning} at the motor, in its own unit where that is not rad"
    return f"{turning}; prismatic joint: {sliding}"
