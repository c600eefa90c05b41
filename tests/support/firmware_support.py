"""Arms compiled for a Cortex-M4F, once for all tests that one process runs of an arm."""

from __future__ import annotations

from functools import cache
from pathlib import Path

import pytest
import size
from arms_support import ARMS, model
from firmware.sizes import Size, measure

from modelgen.functions import Model

_known: dict[tuple[str, str], tuple[dict[str, Size], Path]] = {}


@cache
def sized(name: str) -> Model:
    return size.sized_model(ARMS[name]) if name in size.FOLDED else model(name)


def measured(name: str, tool: str, folders: pytest.TempPathFactory) -> tuple[dict[str, Size], Path]:
    """Sizes of an arm's functions by "gcc" or "zig", and the folder with its src, include and objects."""
    if (name, tool) not in _known:
        folder = folders.mktemp(f"{name}-{tool}")
        _known[name, tool] = measure(sized(name), folder, tool), folder
    return _known[name, tool]
