"""Family C: random arms of two to six joints, simulated by MuJoCo.

Links by random modified Denavit-Hartenberg parameters, oblique axes and sliding joints among them; rotors and
dry friction are MuJoCo's too (armature and friction loss of a tendon for each drive); `steps.c` has the loops
and the other laws. It shares no code with modelgen or another family. `make` draws an arm and its records by
seed, and hides one thing in it, as strong as `size` says: the RMSE of a fit of the user's model to the
training records, over that of the same fit to the same commands and noise without the hidden thing, below
`measure.band`, at the joint at which it is hidden.
"""

from __future__ import annotations

from blind.family_c.make import KINDS, SETTINGS, make

__all__ = ["KINDS", "SETTINGS", "make"]
