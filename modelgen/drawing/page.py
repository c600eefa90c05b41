"""The page that shows a scene: its styles and scripts stand in it."""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup

from modelgen.description.objects import Arm
from modelgen.drawing.scene import moving_scene, scene
from modelgen.numeric import Array
from modelgen.resources import templates_folder

# In the order in which they use each other.
SCRIPTS = (
    "model",
    "skeleton",
    "view",
    "solids",
    "marks",
    "labels",
    "svg",
    "panel",
    "painting",
    "hits",
    "page",
    "motion",
)


def page(arm: Arm, q: Sequence[float] | None = None) -> str:
    """HTML of the arm, drawn at the coordinates `q` (n,) [rad, m]; by default as `scene.start` says.

    Raises InputError where `q` is not within the joints' limits.
    """
    return _rendered(arm, scene(arm, q))


def moving_page(arm: Arm, t: Array, q: Array) -> str:
    """HTML of a motion that plays: q (F, n) [rad, m] at equal times t (F,) [s]."""
    return _rendered(arm, moving_scene(arm, t, q))


def _rendered(arm: Arm, data: dict[str, Any]) -> str:
    folder = templates_folder()
    environment = Environment(
        loader=FileSystemLoader(folder), undefined=StrictUndefined, autoescape=True, trim_blocks=True
    )
    texts = {
        name: (folder / "drawing" / f"{name}.js").read_text(encoding="utf-8").rstrip() for name in SCRIPTS
    }
    return (
        environment.get_template("drawing/page.html.j2").render(
            name=arm.name,
            source=arm.source,
            style=Markup((folder / "drawing" / "page.css").read_text(encoding="utf-8").rstrip()),
            data=_embedded(json.dumps(data, separators=(",", ":"), allow_nan=False)),
            scripts={name: Markup(text) for name, text in texts.items()},
        )
        + "\n"
    )


def _embedded(text: str) -> Markup:
    """JSON that cannot end the script it stands in."""
    return Markup(text.replace("<", "\\u003c"))
