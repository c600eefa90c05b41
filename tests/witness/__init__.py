"""Independent witnesses: the same mechanics by other people's code, or written anew from first principles.

Nothing here uses the expression graph or the equations under test; an `Arm` is only read.
"""
