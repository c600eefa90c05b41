"""Measured logs: reading, checking, processing."""

from modelgen.dataset.objects import Record

__all__ = ["Record"]
