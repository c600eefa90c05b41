"""Independent jobs, on the processors of this machine or on a Dask cluster."""

from modelgen.jobs.forked import forked
from modelgen.jobs.local import ignore_interrupt
from modelgen.jobs.run import run
from modelgen.jobs.threads import one_thread
from modelgen.jobs.where import HERE, Where

__all__ = ["HERE", "Where", "forked", "ignore_interrupt", "one_thread", "run"]
