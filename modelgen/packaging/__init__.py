"""Packaging makes a generated folder usable elsewhere: build files, its README, its self-test."""

from modelgen.packaging.files import packaging_files

__all__ = ["packaging_files"]
