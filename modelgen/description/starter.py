"""The first arms.yaml of a user: commented, and valid as it stands."""

from __future__ import annotations

from modelgen.description.document import one_line
from modelgen.description.names import arm_name_problem
from modelgen.errors import InputError

_TEXT = """\
# Units are SI with radians; text such as "90 deg", "50 mm" or pi/2 is understood.
# Every figure here is an example: put your arm's in its place.
schema: 1
convention: khalil_kleinfinger   # Rot(x, alpha) Trans(x, d) Rot(z, theta) Trans(z, r), q added to theta
arms:
  {name}:
    source: where the figures come from
    gravity: [0, 0, -9.81]       # m/s^2 in the base frame
    fluid_density: 0             # kg/m^3; above 0 the links get buoyancy parameters
    symbols: {{d2: 0.45}}          # named geometry: stays a name in the printed parameters
    locked: {{}}                   # joints held in place, {{tool: 0}} say
    joints:
      # Turned by a linear actuator (motor, ball-screw) between two points at l1 and l2 from the joint axis.
      - name: shoulder
        alpha: 90 deg
        d: 0.116
        r: 0
        # limits of q; the stroke below allows -29.54 to 67.92 deg
        limits: {{position: [-29 deg, 67 deg], velocity: 25 deg}}
        drive:
          type: levered
          l1: 0.32               # m
          l2: 0.06               # m
          length: [0.27, 0.36]   # m, actuator length at the two motor values
          motor: [0, 20000]      # motor coordinate there: increments here
          rev: 1                 # q = rev * inner angle of the lever + offset
          offset: -60 deg
          torque_constant: 1.0e-3   # J per increment per A
          motor_velocity: 2000   # increments/s
          motor_acceleration: 20000
          current: 3             # A
        # the default effects of a driven joint, with values at the motor to simulate with
        effects:
          - viscous_friction: {{coefficient: 1.0e-7}}   # J s per increment^2
          - coulomb_friction: {{magnitude: 3.0e-4}}     # J per increment
          - drive_inertia: {{inertia: 1.0e-8}}          # J s^2 per increment^2
      # Turned by a geared motor: q_m = ratio q. A prismatic axis on a ball-screw has ratio 2*pi/lead.
      - name: elbow
        alpha: 0
        d: d2
        r: 0
        limits: {{position: [-120 deg, 120 deg], velocity: 90 deg, effort: 40}}
        drive: {{type: direct, ratio: 100, torque_constant: 0.05, current: 3}}   # N m/A at the motor
        effects:
          - viscous_friction: {{coefficient: 5.0e-5}}   # N m s/rad
          - coulomb_friction: {{magnitude: 0.01}}       # N m
          - drive_inertia: {{inertia: 2.0e-5}}          # kg m^2
    links:                       # nominal inertials: needed to simulate before anything was identified
      shoulder: {{mass: 5, com: [0.2, 0, 0], inertia: [0.01, 0, 0, 0.08, 0, 0.08]}}
      elbow: {{mass: 2, com: [0.15, 0, 0], inertia: [0.003, 0, 0, 0.02, 0, 0.02]}}
"""


def starter(name: str) -> str:
    """Text of an arms.yaml with one arm of the given name: one levered and one direct joint, with comments.

    Raises InputError where the name cannot be an arm's.
    """
    problem = arm_name_problem(name)
    if problem:
        raise InputError(f"the arm name '{one_line(name, 60)}' cannot be used: {problem}")
    return _TEXT.format(name=_quoted(name))


def _quoted(name: str) -> str:
    """YAML reads some words as values."""
    return f'"{name}"' if name.lower() in {"null", "true", "false"} else name
