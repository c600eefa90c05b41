"""Robots of other formats to arms: URDF, MJCF, tables of standard DH parameters."""

from modelgen.importing.importer import Imported, import_model

__all__ = ["Imported", "import_model"]
