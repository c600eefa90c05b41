"""Drives: each is one function q_m(q)."""

from modelgen.transmission.drives import (
    STROKE_MARGIN,
    Levered,
    Transmission,
    of_joint,
    with_lever_symbols,
)

__all__ = ["STROKE_MARGIN", "Levered", "Transmission", "of_joint", "with_lever_symbols"]
