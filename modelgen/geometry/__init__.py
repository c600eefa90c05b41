"""Position and orientation of frames: modified DH in the expression graph."""

from modelgen.geometry.frames import Frame, Frames
from modelgen.geometry.runtime import with_geometry_symbols
from modelgen.geometry.scalars import Scalars
from modelgen.geometry.trigonometry import Trigonometry

__all__ = ["Frame", "Frames", "Scalars", "Trigonometry", "with_geometry_symbols"]
