"""From a description of an arm to its dynamic model: C99, CasADi and NumPy."""

from modelgen.version import __version__ as __version__
