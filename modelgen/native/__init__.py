"""C compiled on this machine, for speed: shared libraries, cached."""

from __future__ import annotations

from modelgen.native.columns import plain_columns
from modelgen.native.library import compiler, library_bytes, shared_library
from modelgen.native.smoothing import both_ways, central

__all__ = ["both_ways", "central", "compiler", "library_bytes", "plain_columns", "shared_library"]
