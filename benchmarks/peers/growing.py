"""Arms of any size: chains and trees of revolute joints.

python -m peers.growing SHAPE JOINTS FOLDER     generates, and prints what it cost
"""

from __future__ import annotations

import sys
from math import pi
from pathlib import Path

from modelgen.description.objects import Arm, Joint
from peers.arms import links_alone, subject_of
from peers.cost import generation
from peers.ours import write

_LIMB = 6  # joints of a limb, in "limbs"


def antecedent(shape: str, i: int) -> int | None:
    """The joint before joint i.

    chain; binary: every link carries two; limbs: the first link carries limbs of six joints. Raises
    ValueError for another shape.
    """
    if i == 0:
        return None
    if shape == "chain":
        return i - 1
    if shape == "binary":
        return (i - 1) // 2
    if shape == "limbs":
        return 0 if (i - 1) % _LIMB == 0 else i - 1
    raise ValueError(f"unknown shape {shape!r}, expected chain, binary or limbs")


def arm(shape: str, joints: int) -> Arm:
    """Parallel and perpendicular axes in turn, every link with the same inertials."""
    made = []
    for i in range(joints):
        before = antecedent(shape, i)
        second = before is not None and before != i - 1  # a branch leaves at an angle of its own
        made.append(
            Joint(
                f"j{i + 1}",
                "revolute",
                alpha=(pi / 2, 0.0, -pi / 2)[i % 3],
                d=0.1 + 0.005 * i,
                r=(0.0, 0.2)[i % 2],
                gamma=0.7 if second else 0.0,
                b=0.05 if second else 0.0,
                antecedent=before,
            )
        )
    return Arm(f"{shape}{joints}", tuple(made), (None,) * joints)


if __name__ == "__main__":
    described = subject_of(arm(sys.argv[1], int(sys.argv[2]))).arm
    generation(lambda: write(links_alone(described), Path(sys.argv[3])))
