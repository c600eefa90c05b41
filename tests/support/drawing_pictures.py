"""The pictures of the pages about drawings, drawn by the page itself in a headless browser.

PYTHONPATH=tests/support python -m drawing_pictures     writes them anew
"""

from __future__ import annotations

import re
import tempfile
from collections.abc import Iterator
from html import unescape
from pathlib import Path

from drawing_support import in_browser

import modelgen as mg
from modelgen.drawing import page

DOCS = Path(__file__).resolve().parents[2] / "docs"
SIZE = (900, 560)

# What the page does before its picture is taken.
_TAKEN = """<script>
[view.width, view.height] = {size};
Object.assign(show, {show});
look("{view}");
const out = document.createElement("pre");
out.id = "svg";
out.textContent = svgPicture({width}, {height});
document.body.append(out);
</script></body>"""


def described() -> mg.Arm:
    """The arm of the page that goes from a drawing to a description."""
    text = (DOCS / "from-a-drawing.md").read_text(encoding="utf-8")
    (block,) = re.findall(r"^```yaml\n(.*?)^```", text, re.DOTALL | re.MULTILINE)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "arms.yaml"
        path.write_text(block, encoding="utf-8")
        return mg.load_arms(path)["loader"]


def picture(arm: mg.Arm, q: list[float] | None, view: str, show: str) -> str:
    """SVG of an arm. view: a button of the page. show: switches of its parts, as JavaScript."""
    taken = _TAKEN.format(size=list(SIZE), show=show, view=view, width=SIZE[0], height=SIZE[1])
    with tempfile.TemporaryDirectory() as folder:
        shown = in_browser(page(arm, q).replace("</body>", taken), Path(folder))
    (found,) = re.findall(r'<pre id="svg">(.*?)</pre>', shown, re.DOTALL)
    return unescape(found)


def pictures() -> Iterator[tuple[str, str]]:
    """Name and text of every picture."""
    ariane, loader = mg.load_arms()["ariane4"], described()
    raised = [0.0, 0.35, 0.0]
    side = "{dimensions: true, frames: false, inertias: false, floor: false, axes: true}"
    yield "drawing.svg", picture(ariane, None, "oblique", "{inertias: true}")
    yield "from-a-drawing-side.svg", picture(loader, raised, "front", side)
    yield "from-a-drawing.svg", picture(loader, raised, "oblique", "{inertias: false}")


if __name__ == "__main__":
    for name, text in pictures():
        (DOCS / name).write_text(text, encoding="utf-8", newline="\n")
