"""An arm as a drawing to turn and move: one HTML page that needs nothing beside it."""

from modelgen.drawing.page import framed, moving_page, page
from modelgen.drawing.scene import scene, start

__all__ = ["framed", "moving_page", "page", "scene", "start"]
