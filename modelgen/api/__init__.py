"""The functions behind `import modelgen` and the command line: each parses, works and gives back a result.

The face is `modelgen` itself, which loads a module of this package when one of its names is asked for.
"""
