"""The version of modelgen."""

__version__ = "0.1.0"
