"""An arm's links in Pinocchio."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from modelgen.description import Arm
from witness.bodies import Body
from witness.geometry import moving, parents_first, placement

Array = NDArray[np.float64]

# Pinocchio: m, mx, my, mz, Ixx, Ixy, Iyy, Ixz, Iyz, Izz about the joint's frame
FROM_PINOCCHIO = [4, 5, 7, 6, 8, 9, 1, 2, 3, 0]


class RigidBodies:
    """The links without drives; one call is one sample, coordinates in the arm's order.

    Fixed and locked links are welded to what carries them. With `every_joint` they keep a joint that is
    held still instead: then each link has its own body, which the regressor needs.
    """

    def __init__(self, arm: Arm, bodies: Sequence[Body], every_joint: bool = False) -> None:
        self.arm = arm
        self.model = pin.Model()
        self.model.gravity.linear = np.array(arm.gravity)
        self.every_joint = every_joint
        carrier: dict[int | None, tuple[int, pin.SE3]] = {None: (0, pin.SE3.Identity())}
        self.joint_id: dict[int, int] = {}
        self.frame_id: dict[int, int] = {}
        for i in parents_first(arm):  # a subtree's joints must be neighbours in Pinocchio
            joint, body = arm.joints[i], bodies[i]
            parent, offset = carrier[joint.antecedent]
            if every_joint or i in moving(arm):
                kind = pin.JointModelPZ() if joint.type == "prismatic" else pin.JointModelRZ()
                place = offset * pin.SE3(placement(arm, i))
                self.joint_id[i] = self.model.addJoint(parent, kind, place, f"joint {i}")
                carrier[i] = self.joint_id[i], pin.SE3.Identity()
            else:
                carrier[i] = parent, offset * pin.SE3(placement(arm, i, joint.locked or 0.0))
            self.model.appendBodyToJoint(
                carrier[i][0], pin.Inertia(body.mass, body.com, body.inertia), carrier[i][1]
            )
            frame = pin.Frame(f"link {i}", carrier[i][0], 0, carrier[i][1], pin.FrameType.OP_FRAME)
            self.frame_id[i] = self.model.addFrame(frame)
        self.data = self.model.createData()
        self.places = [self.model.joints[self.joint_id[i]].idx_v for i in moving(arm)]

    def _full(self, values: Array) -> Array:
        result = np.zeros(self.model.nv)
        result[self.places] = values
        return result

    def _q(self, q: Array) -> Array:
        result = self._full(q)
        for i, identifier in self.joint_id.items():
            locked = self.arm.joints[i].locked
            if locked is not None:
                result[self.model.joints[identifier].idx_q] = locked
        return result

    def effort(self, q: Array, dq: Array, ddq: Array, forces: Mapping[int, pin.Force] | None = None) -> Array:
        """Inverse dynamics [N m or N]. `forces`: what else acts on a link, at its origin in its axes."""
        acting = [pin.Force.Zero() for _ in range(self.model.njoints)]
        for i, force in (forces or {}).items():
            assert self.every_joint
            acting[self.joint_id[i]] = force
        found = pin.rnea(
            self.model,
            self.data,
            self._q(q),
            self._full(dq),
            self._full(ddq),
            pin.StdVec_Force(acting),
        )
        return np.array(found)[self.places]

    def mass_matrix(self, q: Array) -> Array:
        """n x n."""
        upper = np.triu(pin.crba(self.model, self.data, self._q(q)))
        return (upper + np.triu(upper, 1).T)[np.ix_(self.places, self.places)]

    def acceleration(self, q: Array, dq: Array, effort: Array) -> Array:
        """Forward dynamics by articulated bodies."""
        assert not self.every_joint
        found = pin.aba(self.model, self.data, self._q(q), self._full(dq), self._full(effort))
        return np.array(found)[self.places]

    def regressor(self, q: Array, dq: Array, ddq: Array) -> Array:
        """n x 10 links, efforts per unit of XX ... M, link after link in the arm's order."""
        assert self.every_joint
        found = pin.computeJointTorqueRegressor(
            self.model, self.data, self._q(q), self._full(dq), self._full(ddq)
        )
        found = np.array(found).reshape(self.model.nv, -1)  # with one joint it comes as a vector
        blocks = []
        for i in range(len(self.arm.joints)):
            first = 10 * (self.joint_id[i] - 1)
            blocks.append(found[self.places, first : first + 10][:, FROM_PINOCCHIO])
        return np.hstack(blocks)

    def poses(self, q: Array) -> list[Array]:
        """Every link's frame in the base."""
        pin.framesForwardKinematics(self.model, self.data, self._q(q))
        return [self.data.oMf[self.frame_id[i]].homogeneous for i in range(len(self.arm.joints))]

    def jacobian(self, q: Array, link: int) -> Array:
        """6 x n at the origin of a link's frame, linear over angular, base axes."""
        found = pin.computeFrameJacobian(
            self.model, self.data, self._q(q), self.frame_id[link], pin.LOCAL_WORLD_ALIGNED
        )
        return np.array(found).reshape(6, -1)[:, self.places]

    def energy(self, q: Array, dq: Array) -> tuple[float, float]:
        """Kinetic and potential [J]."""
        full = self._q(q)
        kinetic = pin.computeKineticEnergy(self.model, self.data, full, self._full(dq))
        return float(kinetic), float(pin.computePotentialEnergy(self.model, self.data, full))
