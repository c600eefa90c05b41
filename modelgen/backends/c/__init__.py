"""C99 of an arm: a header, and a source file for each function."""

from modelgen.backends.c.files import c_files, c_symbols

__all__ = ["c_files", "c_symbols"]
