"""The page that shows a scene: its styles and scripts are inside."""

from __future__ import annotations

import json
from collections.abc import Mapping, Sequence
from typing import Any

from jinja2 import Environment, FileSystemLoader, StrictUndefined
from markupsafe import Markup, escape

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


def page(arm: Arm, q: Sequence[float] | None = None, marks: Mapping[str, str] | None = None) -> str:
    """HTML of the arm, drawn at the coordinates `q` (n,) [rad, m]; by default as `scene.start` says.

    marks: what is said of some joints, by their names; these are drawn in another colour. Raises InputError
    where `q` is not within the joints' limits.
    """
    data = scene(arm, q)
    for joint in data["joints"]:
        joint["mark"] = (marks or {}).get(joint["name"], "")
    return _rendered(arm, data)


def framed(html: str, title: str, height: int) -> Markup:
    """A page as a part of another one. height: [pixels]."""
    style = f"width: 100%; height: {height}px; border: 0"
    return Markup(f'<iframe title="{escape(title)}" srcdoc="{escape(html)}" style="{style}"></iframe>')


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
            scripts=[(name, Markup(text)) for name, text in texts.items()],
        )
        + "\n"
    )


def _embedded(text: str) -> Markup:
    """JSON that cannot end the script it stands in."""
    return Markup(text.replace("<", "\\u003c"))
