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


def antecedents(shape: str, joints: int) -> list[int | None]:
    """The joint before each joint, branch after branch (Pinocchio's mass matrix needs that order).

    chain; binary: every link carries two; limbs: the first link carries limbs of six joints. Raises
    ValueError for another shape.
    """
    if shape == "chain":
        return [None, *range(joints - 1)]
    if shape == "limbs":
        return [None, *(0 if i % _LIMB == 0 else i for i in range(joints - 1))]
    if shape != "binary":
        raise ValueError(f"unknown shape {shape!r}, expected chain, binary or limbs")
    found: list[int | None] = []
    waiting: list[tuple[int, int | None]] = [(0, None)]  # place in the heap, joint before
    while waiting:
        place, before = waiting.pop()
        number = len(found)
        found.append(before)
        waiting += [(child, number) for child in (2 * place + 2, 2 * place + 1) if child < joints]
    return found


def arm(shape: str, joints: int) -> Arm:
    """Parallel and perpendicular axes in turn, every link with the same inertials."""
    made = []
    for i, before in enumerate(antecedents(shape, joints)):
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
