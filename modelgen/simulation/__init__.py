"""Forward simulation of exactly the model that is emitted, dry friction as a set."""

from modelgen.simulation.control import Reference, cascade, computed_torque
from modelgen.simulation.metrics import Scores, scores
from modelgen.simulation.plant import Plant, plant
from modelgen.simulation.replay import Replay, replay
from modelgen.simulation.simulate import simulate
from modelgen.simulation.trajectory import Trajectory

__all__ = [
    "Plant",
    "Reference",
    "Replay",
    "Scores",
    "Trajectory",
    "cascade",
    "computed_torque",
    "plant",
    "replay",
    "scores",
    "simulate",
]
