"""Family B: arms with joint and current loops, two-mass joints and dry friction, from own equations.

It shares no code with modelgen. `make` draws an arm and its records by seed, and hides one thing in it,
as strong as `size` says: the RMSE of a fit of the user's model to the training records, over that of the
same fit to the same commands and noise without the hidden thing, in the band of `fit.cutoff`, at the
joint at which it is hidden.
"""

from __future__ import annotations

from blind.family_b.make import KINDS, SETTINGS, make

__all__ = ["KINDS", "SETTINGS", "make"]
