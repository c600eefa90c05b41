"""C compiled on this machine, for speed: shared libraries, cached."""

from modelgen.compiled.columns import Columns
from modelgen.compiled.library import compiler, shared_library

__all__ = ["Columns", "compiler", "shared_library"]
