"""An exported URDF has in Pinocchio the efforts that the arm's own functions say."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from exporting_support import Array, Motion, close, only_exact

import modelgen as mg
from modelgen.description.objects import EffectUse

SHIPPED = mg.load_arms(Path(__file__).parents[2] / "arms.yaml")
SOME = ["ariane4_free", "gravity_arm", "ur10e", "scara", "screw_axis", "two_fingers"]


def pinocchio_efforts(text: str, motion: Motion) -> Array:
    """Efforts (N, n) at the joints, damping and dry friction taken in."""
    model = pin.buildModelFromXML(text)
    data = model.createData()
    names = [motion.arm.joints[i].name for i in motion.arm.coordinates]
    joints = [model.joints[model.getJointId(name)] for name in names]
    order = [joint.idx_v for joint in joints]
    assert model.nv == len(order)
    found = np.zeros_like(motion.q)
    for k in range(len(motion.q)):
        q, v, a = np.zeros(model.nq), np.zeros(model.nv), np.zeros(model.nv)
        for joint, x, dx, ddx in zip(joints, motion.q[k], motion.dq[k], motion.ddq[k], strict=True):
            # a joint that may turn without end has its angle as cosine and sine
            q[joint.idx_q : joint.idx_q + joint.nq] = [x] if joint.nq == 1 else [np.cos(x), np.sin(x)]
            v[joint.idx_v], a[joint.idx_v] = dx, ddx
        resistance = model.damping * v + model.upperDryFrictionLimit * np.sign(v)
        found[k] = (pin.rnea(model, data, q, v, a) + resistance)[order]
    return found


@pytest.mark.parametrize("name", SOME)
def test_the_efforts_are_those_of_the_equations(name: str) -> None:
    arm = only_exact(SHIPPED[name], mg.export(SHIPPED[name], to="urdf"))
    motion = Motion(arm)
    close(pinocchio_efforts(mg.export(arm, to="urdf").text, motion), motion.efforts)


@pytest.mark.parametrize("name", ["screw_axis", "yaw3pitch"])
def test_what_was_exported_is_imported_with_the_same_base_parameters(name: str, tmp_path: Path) -> None:
    arm = only_exact(SHIPPED[name], mg.export(SHIPPED[name], to="urdf"))
    mg.export(arm, to="urdf", out=tmp_path / "arm.urdf")
    model = mg.build_model(arm)
    back = mg.import_robot(tmp_path / "arm.urdf", exact=True)
    assert back.remarks == ()
    nominal = mg.build_model(back.arm).nominal
    assert model.nominal is not None
    assert nominal is not None
    assert dict(nominal) == pytest.approx(dict(model.nominal), rel=1e-9, abs=1e-12)
    limits = [joint.limits for joint in arm.joints]
    assert [joint.limits.velocity for joint in back.arm.joints] == [x.velocity for x in limits]


def test_what_urdf_cannot_say_is_listed() -> None:
    model = mg.export(SHIPPED["ariane4"], to="urdf")
    levered = {(row.effect, row.status) for row in model.rows}
    assert levered == {
        ("viscous_friction", "approximated"),
        ("coulomb_friction", "approximated"),
        ("drive_inertia", "left out"),
    }
    assert all(row.error is not None and row.error > 0 for row in model.rows)
    assert any("linkages of j1, j2, j3" in note for note in model.notes)
    assert any("upright" in note for note in mg.export(SHIPPED["gravity_arm"], to="urdf").notes)


def test_a_spring_is_left_out_with_its_size() -> None:
    arm = SHIPPED["gravity_link1"].without_effects()
    use = EffectUse("spring", {"stiffness": 8.0, "rest": 0.0})
    sprung = replace(arm, joints=(replace(arm.joints[0], effects=(use,)),))
    (row,) = mg.export(sprung, to="urdf").rows
    assert (row.status, row.error) == ("left out", pytest.approx(8.0 * np.pi, rel=0.02))


def test_tools_and_held_joints_are_fixed() -> None:
    arm = SHIPPED["ariane4"]
    model = pin.buildModelFromXML(mg.export(arm, to="urdf").text)
    assert model.njoints == 1 + len(arm.coordinates)
    assert model.existFrame("j4_link")
