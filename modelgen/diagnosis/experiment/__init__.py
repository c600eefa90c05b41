"""The next experiment tells rivals apart, within the arm's limits."""

from modelgen.diagnosis.experiment.experiment import STEM, Experiment, differences, next_experiment
from modelgen.diagnosis.experiment.experiment import to_json as experiment_json
from modelgen.diagnosis.experiment.motions import setup
from modelgen.diagnosis.experiment.trajectory import Proposal

__all__ = ["STEM", "Experiment", "Proposal", "differences", "experiment_json", "next_experiment", "setup"]
