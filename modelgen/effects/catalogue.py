"""All effects by name."""

from __future__ import annotations

from modelgen.effects.base import Definition
from modelgen.effects.compliance import Backlash, JointFlexibility
from modelgen.effects.environment import AddedMass, BaseTilt, FluidDrag, PayloadChange
from modelgen.effects.friction import (
    AsymmetricViscousFriction,
    CoulombFriction,
    FrictionOffset,
    NonlinearViscousFriction,
    ViscousFriction,
)
from modelgen.effects.friction_dry import (
    FrictionWarmUp,
    LoadDependentFriction,
    PositionDependentFriction,
    Presliding,
    StribeckFriction,
)
from modelgen.effects.measurement import (
    DriveGainError,
    EncoderOffset,
    LeverGeometry,
    TimeDelay,
    TorqueConstantSaturation,
)
from modelgen.effects.mechanism import ActuatorMass, DriveInertia, Spring, TorqueRipple, TransmissionCoupling

CATALOGUE: dict[str, type[Definition]] = {
    effect.name: effect
    for effect in (
        ViscousFriction,
        CoulombFriction,
        FrictionOffset,
        AsymmetricViscousFriction,
        StribeckFriction,
        LoadDependentFriction,
        NonlinearViscousFriction,
        PositionDependentFriction,
        FrictionWarmUp,
        Presliding,
        DriveInertia,
        TorqueRipple,
        Backlash,
        JointFlexibility,
        TransmissionCoupling,
        LeverGeometry,
        ActuatorMass,
        Spring,
        PayloadChange,
        FluidDrag,
        AddedMass,
        BaseTilt,
        DriveGainError,
        TorqueConstantSaturation,
        EncoderOffset,
        TimeDelay,
    )
}


def known_effects() -> dict[str, tuple[str, ...]]:
    """Names of the parameters that a description may set, by effect."""
    return {name: tuple(p.name for p in effect.accepted()) for name, effect in CATALOGUE.items()}
