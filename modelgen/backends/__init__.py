"""Printers of the emitted functions: C99, CasADi, and evaluation in NumPy."""

from modelgen.backends.c import c_files
from modelgen.backends.casadi.module import casadi_files
from modelgen.backends.numpy import NumpyFunction
from modelgen.backends.provenance import Provenance

# What is printed into every arm's folder: each gives text by path for a model and its provenance.
PRINTERS = (
    c_files,
    casadi_files,
)

__all__ = ["PRINTERS", "NumpyFunction", "Provenance", "c_files", "casadi_files"]
