"""Base regressor in many states: rows per second, on one core."""

from __future__ import annotations

from collections.abc import Callable
from time import process_time
from typing import Any

import numpy as np
from numpy.typing import NDArray

from modelgen.backends.numpy import NumpyFunction
from modelgen.functions import Model
from peers.arms import Subject, model_text

Array = NDArray[np.float64]
_SECONDS = 0.5


def rate(evaluate: Callable[[], object], rows: int) -> list[float]:
    """Rows per second of CPU time, of one evaluation after the other."""
    evaluate()
    found: list[float] = []
    end = process_time() + _SECONDS
    while len(found) < 3 or process_time() < end:
        start = process_time()
        evaluate()
        found.append(rows / (process_time() - start))
    return found


def numpy_rows(model: Model, case: Subject) -> list[float]:
    """modelgen's NumPy backend on all states at once."""
    function = NumpyFunction(next(f for f in model.functions if f.name == "regressor"))
    states = np.tile(case.states, (50, 1))
    q, dq, ddq = np.split(states, 3, axis=1)
    return rate(lambda: function(q, dq, ddq), len(states) * case.joints)


def pinocchio_rows(case: Subject) -> list[float]:
    """Pinocchio's regressor of the standard parameters in a loop of Python."""
    import pinocchio as pin  # noqa: PLC0415 - the tables are made without it where it is missing

    model = _model(case)
    data = model.createData()
    parts = [np.split(state, 3) for state in case.states]

    def loop() -> None:
        for q, dq, ddq in parts:
            pin.computeJointTorqueRegressor(model, data, q, dq, ddq)

    return rate(loop, len(parts) * case.joints)


def figaroh_rows(case: Subject) -> list[float]:
    """FIGAROH's stacked regressor of the standard parameters."""
    from figaroh.tools.regressor import build_regressor_basic  # noqa: PLC0415 - likewise

    class Wrapped:
        """What FIGAROH asks of a robot."""

        def __init__(self) -> None:
            self.model = _model(case)
            self.data = self.model.createData()

    q, dq, ddq = np.split(case.states, 3, axis=1)
    options = {
        "is_joint_torques": True,
        "is_external_wrench": False,
        "has_friction": False,
        "has_actuator_inertia": False,
        "has_joint_offset": False,
        "force_torque": None,
        "act_idxv": list(range(case.joints)),
    }
    robot = Wrapped()
    return rate(lambda: build_regressor_basic(robot, q, dq, ddq, options), len(q) * case.joints)


def _model(case: Subject) -> Any:
    """The arm in Pinocchio's Python module, from the text that its C++ reads."""
    import pinocchio as pin  # noqa: PLC0415 - likewise

    first, *lines = model_text(case).splitlines()
    model = pin.Model()
    model.gravity.linear = np.array([float(x) for x in first.split()[1:]])
    for i, line in enumerate(lines):
        numbers = np.array([float(x) for x in line.split()])
        place = numbers[2:14].reshape(3, 4)
        kind = pin.JointModelPZ() if numbers[1] else pin.JointModelRZ()
        joint = model.addJoint(
            int(numbers[0]), kind, pin.SE3(place[:, :3].copy(), place[:, 3].copy()), f"joint{i}"
        )
        mass, com, t = float(numbers[14]), numbers[15:18], numbers[18:]
        tensor = np.array([[t[0], t[1], t[2]], [t[1], t[3], t[4]], [t[2], t[4], t[5]]])
        model.appendBodyToJoint(joint, pin.Inertia(mass, com, tensor), pin.SE3.Identity())
    return model
