"""MJCF, MuJoCo's format."""

from modelgen.importing.mjcf.model import read_mjcf

__all__ = ["read_mjcf"]
