"""Actuators of MJCF without input: cogging and bristles."""

from __future__ import annotations

import math

from modelgen.importing.xml_text import Element


def passive_laws(actuator: Element, scale: float) -> list[dict[str, float]]:
    """Its laws by the names of `Definition.simulated`, empty where it has others besides.

    scale: the actuator's length per motor coordinate.
    """
    resistance = any(
        actuator.numbers(name)[0] for name in ("damping", "armature") if name in actuator.attributes
    )
    brakes = "motorconst" in actuator.attributes and any(actuator.numbers("motorconst"))
    if actuator.tag != "dcmotor" or brakes or resistance:
        return []
    found = []
    amplitude, poles, phase = _padded(actuator, "cogging", 3)
    wave = poles * scale
    if amplitude and wave:
        # the simulator's force adds to the input, an effect's opposes it
        size = -scale * amplitude
        sine = math.copysign(1.0, wave) * size * math.cos(phase)
        found.append({"sine": sine, "cosine": size * math.sin(phase), "wave": abs(wave)})
    stiffness, damping, dry, static, _ = _padded(actuator, "lugre", 5)
    if stiffness and dry:
        if damping or static not in (0.0, dry):
            return []
        size = abs(scale)
        found.append({"friction": size * dry, "bristle": dry / stiffness / size})
    return found


def _padded(actuator: Element, name: str, size: int) -> list[float]:
    given = actuator.numbers(name) if name in actuator.attributes else []
    return [*given, *[0.0] * size][:size]
