"""Models of MJCF with joints and settings of every kind that can be imported."""

from __future__ import annotations

MASS = '<inertial pos="0.1 0.02 -0.03" mass="1.5" diaginertia="0.02 0.03 0.04" quat="0.9 0.1 0.3 0.2"/>'
FULL = '<inertial pos="0 0.1 0.05" mass="0.8" fullinertia="0.02 0.03 0.025 0.001 -0.002 0.003"/>'


def bodies(*inside: str) -> str:
    """A chain of bodies: what each holds besides the next."""
    opened = "".join(
        f'<body name="b{k}" pos="0.2 {0.1 * k} 0.3" euler="20 {30 * k} -40">{text}'
        for k, text in enumerate(inside)
    )
    return f"<worldbody>{opened}{'</body>' * len(inside)}</worldbody>"


MODELS = {
    "hinges of any axis": bodies(
        f'<joint name="a" axis="1 2 3"/>{MASS}',
        f'<joint name="b" axis="0 1 -1" pos="0.1 0.2 0"/>{FULL}',
        f'<joint name="c"/>{MASS}',
    ),
    "slides": bodies(
        f'<joint name="a" type="slide" axis="1 0 1"/>{MASS}',
        f'<joint name="b" type="hinge" axis="0 1 0"/>{FULL}',
        f'<joint name="c" type="slide" axis="0 0 -1" ref="0.2"/>{MASS}',
    ),
    "several joints of a body": bodies(
        f'<joint name="x" type="slide" axis="1 0 0"/><joint name="y" type="slide" axis="0 1 0"/>'
        f'<joint name="turn" axis="0 0 1" pos="0.1 0 0"/>{MASS}',
        f'<joint name="b" axis="0 1 0"/>{FULL}',
    ),
    "references in degrees": bodies(
        f'<joint name="a" axis="0 1 0" ref="30" range="-90 60"/>{MASS}',
        f'<joint name="b" axis="1 0 0" ref="-20"/>{MASS}',
    ),
    "radians and another order of angles": '<compiler angle="radian" eulerseq="ZYX"/>'
    + bodies(f'<joint name="a" axis="0 1 1"/>{MASS}', f'<joint name="b" axis="1 0 0"/>{MASS}')
    .replace('"20 0 -40"', '"0.2 0.5 -0.4"')
    .replace('"20 30 -40"', '"1 0.3 0.2"'),
    "what joints resist with": bodies(
        f'<joint name="a" axis="0 1 0" damping="0.4" frictionloss="0.3" armature="0.05"/>{MASS}',
        f'<joint name="b" axis="0 1 1" stiffness="3" springref="25" armature="0.01"/>{FULL}',
    ),
    "classes of defaults": '<default><joint damping="0.2" axis="0 1 0"/><default class="wrist">'
    '<joint armature="0.02" axis="1 0 0"/></default></default>'
    + bodies(f'<joint name="a"/>{MASS}', f'<joint name="b" class="wrist"/>{MASS}'),
    "gears": bodies(f'<joint name="a" axis="0 1 0" armature="0.3"/>{MASS}', f'<joint name="b"/>{FULL}')
    + '<actuator><motor joint="a" gear="40"/><motor joint="b" gear="-8"/></actuator>',
    "a linear actuator on a lever": '<worldbody><body name="b0" euler="20 30 40">'
    f'<joint name="a" axis="0 1 0"/>{MASS}<site name="foot" pos="0.3 0.1 0.3"/>'
    '<body name="b1" pos="0.2 0 0.3"><joint name="b" axis="0 0 -1" pos="0.1 0.2 0" range="-100 30"/>'
    f'{FULL}<site name="pin" pos="0.22 0.1 0"/></body></body></worldbody>'
    '<tendon><spatial name="rod" damping="30" armature="4"><site site="foot"/><site site="pin"/></spatial>'
    '</tendon><actuator><general name="screw" tendon="rod" gear="-900" gainprm="0.02"/></actuator>',
    "a part that turns with two joints": bodies(
        f'<joint name="a" axis="0 1 0"/>{MASS}',
        f'<joint name="b" axis="1 0 0"/>{FULL}',
        f'<joint name="c" axis="0 1 1"/>{MASS}',
    )
    + '<tendon><fixed damping="0.3" armature="0.02"><joint joint="c" coef="-2"/><joint joint="a" coef="3"/>'
    "</fixed></tendon>",
    "shapes as inertia": bodies(
        '<joint name="a" axis="0 1 0"/><geom type="box" size="0.1 0.05 0.2" pos="0.1 0 0" euler="10 0 20"/>'
        '<geom type="sphere" size="0.07" pos="0 0.1 0" mass="0.3"/>',
        '<joint name="b" axis="1 0 1"/><geom type="capsule" fromto="0 0 0 0.2 0.1 0.1" size="0.04"/>',
        '<joint name="c" axis="0 0 1"/><geom type="cylinder" size="0.05 0.1" density="700" zaxis="1 1 0"/>'
        '<geom type="ellipsoid" size="0.1 0.05 0.07" pos="0 0 0.1"/>',
    ),
    "branches, fixed bodies and sites": '<option gravity="1 -2 -9"/><worldbody>'
    f'<body name="base" pos="0 0 1" axisangle="0 1 1 30">{MASS}'
    f'<body name="left" pos="0 0.2 0"><joint name="l" axis="0 1 0"/>{MASS}'
    f'<site name="tcp" pos="0.1 0 0.2" quat="0.5 0.5 0.5 0.5"/>'
    f'<body name="tool" pos="0 0 0.1" zaxis="1 0 1">{FULL}</body></body>'
    f'<frame pos="0 0 0.3" euler="0 90 0"><body name="right"><joint name="r" type="slide" axis="1 1 0"/>'
    f'{FULL}<body name="hand" xyaxes="0 1 0 0 0 1" pos="0 0.1 0"><joint name="h"/>{MASS}</body></body>'
    "</frame></body></worldbody>",
}


def whole(name: str) -> str:
    """The text of a model's file."""
    return f'<mujoco model="made">{MODELS[name]}</mujoco>'
