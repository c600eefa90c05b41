"""An arm as a drawing to turn and move: one HTML page that needs nothing beside it."""

from modelgen.drawing.page import moving_page, page
from modelgen.drawing.scene import scene, start

__all__ = ["moving_page", "page", "scene", "start"]
