"""C compiled on this machine, for speed: shared libraries, cached."""

from modelgen.compiled.columns import RegressorColumns, plain_columns
from modelgen.compiled.library import compiler, shared_library
from modelgen.compiled.smoothing import both_ways, central

__all__ = ["RegressorColumns", "both_ways", "central", "compiler", "plain_columns", "shared_library"]
