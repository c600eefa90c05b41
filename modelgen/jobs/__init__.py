"""Independent jobs, on the processors of this machine or on a Dask cluster."""

from modelgen.jobs.run import run
from modelgen.jobs.where import Where

__all__ = ["Where", "run"]
