"""The structure of the package, read from its own imports."""
