"""Mapping files: names, units and scales of foreign logs."""
