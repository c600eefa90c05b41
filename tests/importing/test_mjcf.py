"""MJCF: efforts, mass matrix and the place of every body and site are those of MuJoCo."""

from __future__ import annotations

from pathlib import Path

import pytest
from importing_support import against_mujoco
from mjcf_models import MASS, MODELS, bodies, whole

import modelgen as mg


def saved(folder: Path, content: str) -> Path:
    path = folder / "model.xml"
    path.write_text(content, encoding="utf-8")
    return path


@pytest.mark.parametrize("name", MODELS)
def test_a_model_moves_as_in_mujoco(name: str, tmp_path: Path) -> None:
    robot = mg.import_robot(saved(tmp_path, whole(name)), exact=True)
    against_mujoco(whole(name), robot)


REFUSED = {
    "ball": (bodies(f'<joint name="hip" type="ball"/>{MASS}'), r"joint hip is ball"),
    "free": (bodies(f'<freejoint name="float"/>{MASS}'), r"joint float is free"),
    "a loop": (
        bodies(f'<joint name="a"/>{MASS}', f'<joint name="b"/>{MASS}')
        + '<equality><connect name="rod" body1="b1" body2="world" anchor="0 0 0"/></equality>',
        r"equality rod closes a loop",
    ),
    "coupled joints": (
        bodies(f'<joint name="a"/>{MASS}', f'<joint name="b"/>{MASS}')
        + '<equality><joint name="pair" joint1="a" joint2="b"/></equality>',
        r"equality pair closes a loop or couples joints",
    ),
    "an axis of zero": (bodies(f'<joint name="a" axis="0 0 0"/>{MASS}'), r"joint a: its axis is zero"),
    "limits the wrong way round": (
        bodies(f'<joint name="a" range="30 -30"/>{MASS}'),
        r"<joint range>: found '30 -30', expected the lower end first",
    ),
    "a tendon with a spring along two joints": (
        bodies(f'<joint name="a"/>{MASS}', f'<joint name="b"/>{MASS}')
        + '<tendon><fixed name="belt" stiffness="9"><joint joint="a" coef="1"/><joint joint="b" coef="1"/>'
        "</fixed></tendon>",
        r"tendon belt acts on several joints",
    ),
    "a tendon out of the plane of a lever": (
        bodies('<joint name="a"/><site name="pin" pos="0.1 0 0.2"/>' + MASS).replace(
            "<worldbody>", '<worldbody><site name="foot" pos="1 0 0"/>'
        )
        + '<tendon><spatial name="rope" damping="3"><site site="foot"/><site site="pin"/></spatial>'
        "</tendon>",
        r"tendon rope acts on several joints",
    ),
    "a mesh as inertia": (
        bodies('<joint name="a"/><geom type="mesh" mesh="part"/>'),
        r"only simple shapes are known",
    ),
    "other files": ('<include file="x.xml"/>', r"<include> is not read"),
    "no joint": (bodies(MASS), r"no joint is left that moves"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_imported_is_refused_by_name(name: str, tmp_path: Path) -> None:
    content, message = REFUSED[name]
    with pytest.raises(mg.InputError, match=message):
        mg.import_robot(saved(tmp_path, f"<mujoco>{content}</mujoco>"))


def test_a_held_ball_lets_the_rest_in(tmp_path: Path) -> None:
    inner = bodies(f'<joint name="hip" type="ball"/>{MASS}', f'<joint name="knee"/>{MASS}')
    robot = mg.import_robot(saved(tmp_path, f"<mujoco>{inner}</mujoco>"), root="b0")
    assert list(robot.joints) == ["knee"]


DRIVE = (
    '<general joint="a" gear="20" dyntype="filterexact" dynprm="0.04" gainprm="0.1" biastype="affine" {}/>'
)
PASSIVE = '<dcmotor name="p" joint="a" gear="5" resistance="1" motorconst="{}" input="none" {}/>'


@pytest.mark.parametrize(
    ("bias", "constant", "passive", "effects", "remark"),
    [
        ("0.3 0 0", "0 0", 'cogging="0.2 8 1"', "time_delay friction_offset torque_ripple", ""),
        ("0.3 -4 0", "0 0", 'lugre="8 0 0.2 0.2 1"', "time_delay presliding", ""),
        ("0 0 0", "0 0", 'lugre="8 0 0.2 0.3 1"', "time_delay", "actuator p of joint a has no input"),
        ("0 0 0", "0.1 0", 'cogging="0.2 8 1"', "time_delay", "actuator p of joint a has no input"),
    ],
)
def test_what_actuators_do_by_themselves_becomes_effects(
    bias: str, constant: str, passive: str, effects: str, remark: str, tmp_path: Path
) -> None:
    actuators = DRIVE.format(f'biasprm="{bias}"') + PASSIVE.format(constant, passive)
    text = bodies(f'<joint name="a" axis="0 1 0"/>{MASS}') + f"<actuator>{actuators}</actuator>"
    robot = mg.import_robot(saved(tmp_path, f"<mujoco>{text}</mujoco>"))
    (joint,) = robot.arm.joints
    assert {use.name for use in joint.effects} == set(effects.split())
    assert [remark in text for text in robot.remarks] == ([True] if remark else [])


@pytest.mark.parametrize(
    ("actuator", "current", "effort"),
    [
        ('<motor joint="a" gear="50" ctrlrange="-2 2"/>', 2.0, None),
        ('<general joint="a" gear="50" gainprm="0.1" ctrlrange="-3 3"/>', 3.0, None),
        ('<general joint="a" gear="50" gainprm="0.1" ctrlrange="-3 3" ctrllimited="false"/>', None, None),
        ('<position joint="a" gear="50" kp="9" ctrlrange="-1 1"/>', None, None),
        ('<motor joint="a" ctrlrange="-80 80"/>', None, 80.0),
    ],
)
def test_the_range_of_an_input_limits_the_current(
    actuator: str, current: float | None, effort: float | None, tmp_path: Path
) -> None:
    text = bodies(f'<joint name="a"/>{MASS}') + f"<actuator>{actuator}</actuator>"
    (joint,) = mg.import_robot(saved(tmp_path, f"<mujoco>{text}</mujoco>")).arm.joints
    assert (joint.drive.limits.current, joint.limits.effort) == (current, effort)


def test_damping_of_more_terms_than_there_are_is_refused(tmp_path: Path) -> None:
    text = bodies(f'<joint name="a" damping="1 2 3 4"/>{MASS}')
    with pytest.raises(mg.InputError, match="found 4 values, expected 3 at most"):
        mg.import_robot(saved(tmp_path, f"<mujoco>{text}</mujoco>"))
