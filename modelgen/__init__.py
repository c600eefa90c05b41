"""From a description of an arm to its dynamic model: C99, CasADi and NumPy."""

__version__ = "0.1.0"
