"""Parts of equations that no arm and no log has."""

from typing import Any

import numpy as np

from modelgen.diagnosis.equations.prior import Unknowns

UNUSED: Any = None  # records, of which nothing is asked
BARE = Unknowns(np.zeros(0), np.zeros((0, 0)))  # of which nothing is told
