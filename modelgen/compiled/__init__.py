"""C compiled on this machine, for speed: shared libraries, cached."""

from modelgen.compiled.library import compiler, shared_library

__all__ = ["compiler", "shared_library"]
