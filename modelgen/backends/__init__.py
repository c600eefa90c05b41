"""Printers of the emitted functions: C99, CasADi, and evaluation in NumPy."""

from modelgen.backends.c import c_files
from modelgen.backends.casadi import casadi_files
from modelgen.backends.numpy import NumpyFunction
from modelgen.backends.packaging import packaging_files
from modelgen.backends.provenance import Provenance

__all__ = ["NumpyFunction", "Provenance", "c_files", "casadi_files", "packaging_files"]
