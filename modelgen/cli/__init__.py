"""The command line: `modelgen`."""

from modelgen.cli.app import main

__all__ = ["main"]
