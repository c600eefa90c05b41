"""What an effect that the arm does not have would add to its inputs along a recorded motion."""

from modelgen.probing.motion import Motion
from modelgen.probing.places import places, with_effect
from modelgen.probing.probe import Prober

__all__ = ["Motion", "Prober", "places", "with_effect"]
