"""The arm of the example of MPC and the library of its plant, made once for all tests of one process."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import pytest
from mpc_arm import ControlledArm, controlled, described
from mpc_plant import compiled

ROOT = Path(__file__).resolve().parents[2]


@dataclass(frozen=True)
class Example:
    """generated: folder of the arm's code. library: of the plant, the C in the repository, dry friction with
    a sign.
    """

    arm: ControlledArm
    generated: Path
    library: Path


_made: list[Example] = []


def example(folders: pytest.TempPathFactory) -> Example:
    """The same whoever asks. Nothing of it changes."""
    if not _made:
        folder = folders.mktemp("mpc")
        arm = controlled(described(ROOT / "examples" / "mpc" / "arms.yaml", "ariane4_mpc"), folder)
        _made.append(Example(arm, folder / arm.name, compiled(ROOT / "generated", "ariane4", folder)))
    return _made[0]
