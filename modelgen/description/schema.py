"""Structure of arms.yaml as pydantic models: keys, types, units in words.

Quantities stay as written here (number or expression); `build` evaluates them, since an expression may use
the arm's symbols and the unit of some depends on the joint's type.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, Literal, TypeAlias, Union

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Discriminator,
    Field,
    Tag,
    WithJsonSchema,
    create_model,
    model_validator,
)
from pydantic_core import PydanticCustomError

from modelgen.description.expressions import MAX_LENGTH
from modelgen.transmission import KINDS, Drive, NoDrive

JOINT_NAME = r"^[A-Za-z_][A-Za-z0-9_-]*$"
ARM_NAME = r"^[A-Za-z][A-Za-z0-9_]*$"
FUNCTION_NAME = r"^[a-z][a-z0-9_]*$"
VERSION = r"^[A-Za-z0-9.+_-]{0,64}$"
SYMBOL_NAME = r"^[A-Za-z_][A-Za-z0-9_]*$"


def _number(value: Any) -> Any:
    if isinstance(value, bool) or not isinstance(value, int | float | str) or value == "":
        raise PydanticCustomError("number", "expected a number or an expression such as pi/2")
    return value


def _whole(value: Any) -> Any:
    if isinstance(value, float) and value.is_integer():
        return int(value)
    if isinstance(value, bool) or not isinstance(value, int):
        raise PydanticCustomError("whole", "expected a whole number")
    return value


def _effect_form(value: Any) -> str | None:
    if isinstance(value, str):
        return "<name>"
    return "<values>" if isinstance(value, dict) else None


Number: TypeAlias = Annotated[
    float | str,
    BeforeValidator(_number),
    WithJsonSchema({"type": ["number", "string"], "minLength": 1, "maxLength": MAX_LENGTH}),
]
Pair: TypeAlias = Annotated[list[Number], Field(min_length=2, max_length=2)]
Triple: TypeAlias = Annotated[list[Number], Field(min_length=3, max_length=3)]
Quadruple: TypeAlias = Annotated[list[Number], Field(min_length=4, max_length=4)]
Sextuple: TypeAlias = Annotated[list[Number], Field(min_length=6, max_length=6)]
Sign: TypeAlias = Annotated[Literal[1, -1], BeforeValidator(_whole)]
JointName: TypeAlias = Annotated[str, Field(pattern=JOINT_NAME)]
EffectEntry: TypeAlias = Annotated[
    Annotated[str, Field(min_length=1), Tag("<name>")]
    | Annotated[dict[str, dict[str, Number]], Field(min_length=1, max_length=1), Tag("<values>")],
    Discriminator(_effect_form),
]


class Model(BaseModel):
    """Strict about types, and closed: an unknown key is an error that says which keys there are."""

    model_config = ConfigDict(extra="forbid", strict=True, frozen=True, populate_by_name=False)

    @model_validator(mode="before")
    @classmethod
    def _known_keys(cls, data: Any) -> Any:
        if isinstance(data, dict):
            options = [field.alias or name for name, field in cls.model_fields.items()]
            for key in data:
                if key not in options:
                    raise PydanticCustomError("unknown_key", "unknown key", {"key": key, "options": options})
        return data


class LimitsModel(Model):
    """Limits of a joint coordinate q. Angles may be written with deg, lengths with mm, cm or m."""

    position: Pair | None = Field(
        default=None, description="Lowest and highest q [rad, or m for a prismatic joint]."
    )
    velocity: Number | None = Field(
        default=None, description="Largest |dq| [rad/s or m/s]; '28 deg' is 28 deg/s."
    )
    acceleration: Number | None = Field(default=None, description="Largest |ddq| [rad/s^2 or m/s^2].")
    effort: Number | None = Field(default=None, description="Largest effort at the joint [N m or N].")


class DriveModel(Model):
    """A drive; each kind has a model of its own, with its figures as fields."""

    type: str


class MotorModel(DriveModel):
    """Keys of every motor: its torque constant and its limits in its own coordinate."""

    torque_constant: Number
    motor_velocity: Number | None = Field(default=None, description="Largest motor speed [units/s].")
    motor_acceleration: Number | None = Field(
        default=None, description="Largest motor acceleration [units/s^2]."
    )
    current: Number | None = Field(default=None, description="Largest motor current [A].")


def _drive_model(kind: type[Drive]) -> type[DriveModel]:
    fields: dict[str, Any] = {"type": (Literal[kind.name], Field(description=f"{kind.name}: {kind.text}."))}
    if kind.driven:
        force = f"Generalised force at the motor coordinate per ampere [{kind.force_unit}]. Not zero."
        fields["torque_constant"] = (Number, Field(description=force))
    for name, figure in kind.figures().items():
        value = Sign if figure.kind == "sign" else Pair if figure.pair else Number
        fields[name] = (value, Field(description=figure.text))
    made: type[DriveModel] = create_model(
        f"{kind.__name__}Model",
        __base__=MotorModel if kind.driven else DriveModel,
        __doc__=kind.text[0].upper() + kind.text[1:] + ".",
        **fields,
    )
    return made


_MODELS = {name: _drive_model(kind) for name, kind in KINDS.items()}
if TYPE_CHECKING:
    AnyDriveModel: TypeAlias = DriveModel
else:
    AnyDriveModel = Annotated[Union[tuple(_MODELS.values())], Field(discriminator="type")]  # noqa: UP007 - made of a tuple


class JointModel(Model):
    """One joint and its link's frame by modified DH parameters; q adds to theta (revolute) or r."""

    name: JointName = Field(description="Name of the joint, unique in the arm; not 'base'.")
    type: Literal["revolute", "prismatic", "fixed"] = Field(
        default="revolute", description="Kind of joint; a fixed one only carries a frame and a link."
    )
    alpha: Number = Field(default=0.0, description="Angle about x from the antecedent's z to this z [rad].")
    d: Number = Field(default=0.0, description="Distance along x between the two z axes [m].")
    r: Number = Field(default=0.0, description="Distance along z [m]; a prismatic joint adds q to it.")
    theta: Number = Field(default=0.0, description="Angle about z [rad]; a revolute joint adds q to it.")
    gamma: Number = Field(
        default=0.0, description="Trees: angle about the antecedent's z axis before alpha [rad]."
    )
    b: Number = Field(
        default=0.0, description="Trees: distance along the antecedent's z axis before alpha [m]."
    )
    antecedent: JointName | None = Field(
        default=None, description="The joint that carries this one, or 'base'. Default: the joint before."
    )
    limits: LimitsModel = Field(default=LimitsModel(), description="Limits of the joint coordinate.")
    drive: AnyDriveModel = Field(
        default=_MODELS[NoDrive.name](type=NoDrive.name),
        description="How the joint is driven; default: not at all.",
    )
    effects: list[EffectEntry] | None = Field(
        default=None,
        description="Effects beyond rigid-body dynamics: a name, or a name with nominal values of its "
        "parameters (`modelgen effects` lists names and units). Default: viscous_friction, "
        "coulomb_friction and drive_inertia for a driven joint, none for another.",
    )


class TransformModel(Model):
    """A fixed transform: a place and angles, or a matrix."""

    xyz: Triple = Field(default=[0.0, 0.0, 0.0], description="Place of the origin [m].")
    rpy: Triple = Field(
        default=[0.0, 0.0, 0.0],
        description="Roll, pitch, yaw [rad]: turns about x, then y, then z, which stand still.",
    )
    matrix: Annotated[list[Quadruple], Field(min_length=4, max_length=4)] | None = Field(
        default=None, description="Instead of both: a homogeneous 4 x 4 matrix, row by row [1; m]."
    )


class ToolModel(TransformModel):
    """A named frame on a link: link <- tool."""

    link: JointName = Field(description="Name of the joint whose link carries it.")


class LinkModel(Model):
    """Nominal inertials of a link, in the frame of its joint."""

    mass: Number = Field(description="Mass [kg].")
    com: Triple = Field(description="Centre of mass x, y, z [m].")
    inertia: Sextuple = Field(description="ixx, ixy, ixz, iyy, iyz, izz about the centre of mass [kg m^2].")
    as_given: Literal[True] | None = Field(
        default=None, description="true: the figures are kept even where no body can have them."
    )


class ArmModel(Model):
    """One arm: joints in the order of the coordinates, and what surrounds it."""

    source: str = Field(default="", description="Where the figures come from; free text.")
    version: Annotated[str, Field(pattern=VERSION)] = Field(
        default="", description="Version of this description, which the generated code states; '1.2.0', say."
    )
    gravity: Triple = Field(
        default=[0.0, 0.0, -9.81], description="Acceleration of gravity, base frame [m/s^2]."
    )
    fluid_density: Number = Field(
        default=0.0, description="Density of the fluid around [kg/m^3]; 0: no buoyancy."
    )
    symbols: dict[Annotated[str, Field(pattern=SYMBOL_NAME)], Number] = Field(
        default={},
        description="Named geometry: name to value [rad or m]; the names may be used in expressions.",
    )
    locked: dict[str, Number] = Field(
        default={}, description="Joints held in place: name to coordinate [rad or m]; they leave the model."
    )
    joints: Annotated[list[JointModel], Field(min_length=1)] = Field(description="The joints, base first.")
    effects: list[EffectEntry] = Field(
        default=[], description="Effects of the whole arm: base_tilt, fluid_drag, time_delay and others."
    )
    base: TransformModel | None = Field(
        default=None, description="World <- base frame; poses are then given in the world. Default: the same."
    )
    tools: dict[JointName, ToolModel] = Field(
        default={}, description="Named frames on links: name to link and transform, for poses and Jacobian."
    )
    combined: dict[
        Annotated[str, Field(pattern=FUNCTION_NAME)], Annotated[list[str], Field(min_length=1)]
    ] = Field(
        default={},
        description="Functions that do the work of several in one call: name to the functions that it stands "
        "for, {tick: [inverse_dynamics, mass_matrix]}.",
    )
    monitor: list[Annotated[str, Field(min_length=1)]] = Field(
        default=[],
        description="Parameters that the function monitor_step follows: [FC2, M4]; names of base or standard "
        "parameters.",
    )
    links: dict[str, LinkModel] = Field(
        default={}, description="Nominal inertials by the name of the link's joint."
    )


class Document(Model):
    """The whole file."""

    schema_version: Annotated[Literal[1], BeforeValidator(_whole)] = Field(
        alias="schema", description="Version of this format: 1."
    )
    convention: Literal["khalil_kleinfinger"] = Field(
        description="Frames by modified Denavit-Hartenberg parameters (Khalil and Kleinfinger, 1986)."
    )
    arms: Annotated[dict[Annotated[str, Field(pattern=ARM_NAME)], ArmModel], Field(min_length=1)] = Field(
        description="The arms by name; a name becomes the prefix of the generated functions."
    )
