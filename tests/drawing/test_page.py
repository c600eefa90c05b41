"""The page of a drawing: complete, the same each time, and alive in a browser."""

from __future__ import annotations

import json
import math
import os
import re
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import replace
from html import unescape
from pathlib import Path

import numpy as np
import pytest
from browser_support import SCHEMES, WIDTHS, close, on_paper, opened, printed, violations
from drawing_support import in_browser
from typer.testing import CliRunner

import modelgen as mg
from modelgen.cli.app import app
from modelgen.drawing import framed, moving_page, page


@pytest.fixture(scope="module")
def ariane() -> mg.Arm:
    return mg.load_arms()["ariane4"]


def test_the_page_needs_nothing_beside_it(ariane: mg.Arm) -> None:
    text = page(ariane).replace("http://www.w3.org/2000/svg", "")  # a name in pictures that are saved
    assert not re.findall(r"https?:|\bsrc=|<link|@import|url\((?!#)|fetch\(|XMLHttp|import\(|WebSocket", text)
    assert "default-src 'none'" in text  # and a browser holds it to that
    assert len(text.encode()) < 150_000


def test_text_of_a_description_is_no_markup(ariane: mg.Arm) -> None:
    text = page(replace(ariane, source="</script><script>alert('x')</script> & <b>"))
    assert "<script>alert" not in text
    assert "<b>" not in text
    (data,) = re.findall(r'id="data">(.*?)</script>', text, re.DOTALL)
    assert json.loads(data)["source"].startswith("</script>")


def test_the_same_arm_gives_the_same_bytes(ariane: mg.Arm, tmp_path: Path) -> None:
    code = f"import modelgen as mg; mg.draw(mg.load_arms()['ariane4'], {str(tmp_path / 'a.html')!r})"
    environment = os.environ | {"PYTHONHASHSEED": "7"}
    subprocess.run([sys.executable, "-c", code], check=True, env=environment)
    mg.draw(ariane, tmp_path / "b.html")
    assert (tmp_path / "a.html").read_bytes() == (tmp_path / "b.html").read_bytes()


def test_the_command_draws_what_the_function_draws(ariane: mg.Arm, tmp_path: Path) -> None:
    out = tmp_path / "arm.html"
    at = "10 deg, 0.9, 180 deg"
    done = CliRunner().invoke(app, ["draw", "--arm", "ariane4", "--q", at, "--out", str(out), "--json"])
    assert done.exit_code == 0, done.output
    drawn = mg.draw(ariane, q=at)
    assert out.read_text(encoding="utf-8") == drawn.html
    assert json.loads(done.stdout) == drawn.to_json()
    assert drawn.q == pytest.approx([np.radians(10), 0.9, np.pi])
    assert unescape(re.findall(r'srcdoc="(.*?)"', drawn._repr_html_(), re.DOTALL)[0]) == drawn.html


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (
            ["--q", "0, 150 deg, 180 deg"],
            "found 150 deg for joint j2, expected a value within its range 7",
        ),
        (["--q", "1, 2"], "found 2 values, expected 1 or 3: j1, j2, j3"),
        (["--q", "one"], "expected 0.35, 'pi/9' or '20 deg'"),
        (["--out", "."], "expected the name of a file"),
        (["--arm", "arian"], "did you mean 'ariane"),
    ],
)
def test_bad_input_is_one_line(
    words: list[str], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(tmp_path)
    done = CliRunner().invoke(app, ["draw", "--arm", "ariane4", *words])
    assert done.exit_code == 2
    assert message in done.stderr
    assert len(done.stderr.strip().splitlines()) == 1
    assert not list(tmp_path.iterdir())


# Moves the first slider to its end, points at a lever and at a joint, asks for every view and table.
USED = """
<script>
const log = [];
addEventListener("error", (e) => log.push(e.message));
const said = (key) => {
  const hit = hits.find((h) => h.key === key);
  const [a, b] = hit.line || [0, 0];
  if (hit.line) hover((a[0] + b[0]) / 2, (a[1] + b[1]) / 2, 5);
  return hit.text().join(" | ");
};
{
  for (const box of document.querySelectorAll("details")) box.open = true;
  const slider = document.querySelector("#coordinates input[type=range]");
  slider.value = slider.max;
  slider.dispatchEvent(new Event("input"));
  paint();
  const motor = document.querySelector(".motor").textContent;
  const found = { motor, lever: said("bar actuator 0"), joint: said("joint 1") };
  const pixels = pen.getImageData(0, 0, canvas.width, canvas.height).data.buffer;
  found.colours = new Set(new Uint32Array(pixels)).size;
  for (const box of document.querySelectorAll("#shown input")) box.click();
  svgPicture();
  canvas.setPointerCapture = () => {};  // of pointers that there are
  const point = (type, id, x, y, more = {}) => {
    const at = canvas.getBoundingClientRect();
    const given = { pointerId: id, clientX: at.left + x, clientY: at.top + y, pointerType: "touch", ...more };
    canvas.dispatchEvent(new PointerEvent(type, given));
  };
  const seen_ = () => [view.azimuth, view.elevation, view.scale, ...view.centre];
  look("front");
  found.front = seen_();
  point("pointerdown", 1, 100, 100);
  point("pointermove", 1, 170, 100);
  found.turned = seen_();
  point("pointerdown", 2, 270, 100);
  point("pointermove", 2, 370, 100);
  found.pinched = seen_();
  point("pointerup", 1, 170, 100);
  point("pointerup", 2, 370, 100);
  canvas.dispatchEvent(new WheelEvent("wheel", { deltaY: 200, cancelable: true }));
  found.wheeled = seen_();
  paint();
  const [px, py] = view.project(origin(current.frames[1].link));
  point("pointermove", 3, px, py, { pointerType: "mouse" });
  found.tip = tip.hidden ? "" : tip.textContent;
  for (const button of document.querySelectorAll("button:not([data-view=save])")) { button.click(); paint(); }
  found.wide = document.documentElement.scrollWidth <= innerWidth;
  found.rows = document.querySelectorAll("#table tr, #masses tr, #pose tr").length;
  found.log = log;
  const out = document.createElement("pre");
  out.id = "found";
  out.textContent = JSON.stringify(found);
  document.body.append(out);
}
</script>
"""


@pytest.mark.parametrize("width", [1280, 500])
def test_a_browser_moves_the_arm(width: int, ariane: mg.Arm, tmp_path: Path) -> None:
    shown = in_browser(page(ariane).replace("</body>", USED + "</body>"), tmp_path, width)
    found = json.loads(unescape(re.findall(r'<pre id="found">(.*?)</pre>', shown, re.DOTALL)[0]))
    assert found["log"] == []
    # j1 at 32 deg: the law of cosines, with the figures of arms.yaml
    length = math.sqrt(0.323**2 + 0.058**2 - 2 * 0.323 * 0.058 * math.cos(math.radians(32 + 106.39)))
    motor = 20850 * (length - 0.267857) / (0.368385 - 0.267857)
    assert found["motor"] == f"motor {motor:.6g} units (0 to 20850) · actuator {length:.5g} m"
    assert found["lever"].startswith(f"j1: actuator {length:.5g} m | motor {motor:.6g} units")
    assert "j2: revolute, q2 = 50.5" in found["joint"]
    assert found["turned"][0] == pytest.approx(
        found["front"][0] - 70 / 140
    )  # half a radian by a thumb's width
    assert found["turned"][1:3] == pytest.approx(found["front"][1:3])
    assert found["pinched"][2] == pytest.approx(2 * found["turned"][2])  # fingers twice as far apart
    assert found["wheeled"][2] == pytest.approx(found["pinched"][2] * math.exp(-0.3))
    assert "j2: revolute" in found["tip"]
    assert found["colours"] > 500  # shaded bodies, not an empty picture
    assert found["rows"] == 5 + 5 + 4
    assert found["wide"]  # nothing runs out of the page


@pytest.fixture(scope="module")
def pages(ariane: mg.Arm, tmp_path_factory: pytest.TempPathFactory) -> Iterator[dict[str, Path]]:
    """A drawing, a motion that plays, and a page that shows a drawing in a frame."""
    folder, t = tmp_path_factory.mktemp("pages"), np.linspace(0.0, 1.0, 20)
    start = np.array(mg.draw(ariane).q)
    moves = start + 0.05 * np.sin(2.0 * np.pi * t)[:, None]
    inner = framed(page(ariane), "arm", 500)
    outer = f'<!DOCTYPE html><html lang="en"><title>o</title><main><h1>o</h1>{inner}</main></html>'
    texts = {"drawing": page(ariane), "motion": moving_page(ariane, t, moves), "frame": outer}
    for name, text in texts.items():
        (folder / f"{name}.html").write_text(text, encoding="utf-8")
    yield {name: folder / f"{name}.html" for name in texts}
    close()


@pytest.mark.parametrize(
    ("name", "width", "scheme"),
    [
        *(("drawing", w, s) for w in WIDTHS for s in SCHEMES),
        ("motion", 400, "light"),
        ("frame", 1280, "dark"),
    ],
)
def test_the_page_can_be_used_by_everybody(
    name: str, width: int, scheme: str, pages: dict[str, Path]
) -> None:
    """The rules of axe-core, folded and unfolded; a table that is scrolled has the focus first."""
    with opened(pages[name], width, scheme) as window:
        inner = window.frames[-1]
        assert violations(window) == []
        inner.evaluate("document.querySelectorAll('details').forEach(d => d.open = true)")
        inner.locator("#table tr").nth(1).wait_for(state="attached")
        assert violations(window) == []
        inner.locator("#table .scroll").focus()
        assert inner.evaluate("document.activeElement.getAttribute('aria-label')") == (
            "Denavit-Hartenberg parameters"
        )


@pytest.mark.parametrize("name", ["ariane4", "wam7"])
def test_a_drawing_is_printed_on_one_sheet_without_controls(name: str, tmp_path: Path) -> None:
    """The picture and the coordinates it is drawn at, with their units."""
    path = tmp_path / "draw.html"
    path.write_text(page(mg.load_arms()[name]), encoding="utf-8")
    with opened(path) as window:
        sheets, filled = printed(window)
        assert sheets == 1
        assert filled < 1.0
        with on_paper(window):
            shown = window.locator("button, select, summary, input[type=range], input[type=checkbox]")
            assert not [e for e in shown.all() if e.is_visible()]
            assert window.locator("canvas#view").is_visible()
            numbers = window.locator(".value input")
            assert numbers.count() == len(mg.load_arms()[name].coordinates)
            assert all(e.is_visible() for e in numbers.all())
