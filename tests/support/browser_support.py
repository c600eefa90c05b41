"""Pages in a real browser: Chromium by Playwright, and the accessibility rules of axe-core."""

from __future__ import annotations

import re
from collections.abc import Iterator
from contextlib import contextmanager
from importlib.resources import files
from pathlib import Path
from typing import Any

from drawing_support import browser
from playwright.sync_api import Browser, Page, Playwright, sync_playwright

WIDTHS = (1280, 400)  # a desk's screen, a phone's
SCHEMES = ("light", "dark")


_started: list[tuple[Playwright, Browser]] = []


def chromium() -> Browser:
    """The browser, started by the first of a module's tests that asks for it."""
    if not _started:
        path = browser()
        playwright = sync_playwright().start()
        _started.append(
            (
                playwright,
                playwright.chromium.launch(executable_path=path, args=["--no-sandbox", "--disable-gpu"]),
            )
        )
    return _started[0][1]


def close() -> None:
    """End the browser: while Playwright runs, nothing else in this thread can have an event loop."""
    while _started:
        playwright, window = _started.pop()
        window.close()
        playwright.stop()


@contextmanager
def opened(path: Path, width: int = 1280, scheme: str = "light", *, alone: bool = True) -> Iterator[Page]:
    """A page in a window of that width, without a past; the test fails where its scripts fail, or where
    it asks for anything beside it (alone) or beyond this machine.
    """
    asked: list[str] = []
    failed: list[str] = []
    context = chromium().new_context(viewport={"width": width, "height": 900}, color_scheme=scheme)
    try:
        page = context.new_page()
        page.on("request", lambda r: asked.append(r.url))
        page.on("pageerror", lambda e: failed.append(str(e)))
        page.goto(path.as_uri())
        page.evaluate("document.fonts.ready.then(() => true)")
        yield page
        own = path.as_uri() if alone else "file:"
        beside = [
            u
            for u in asked
            if not (u.split("#")[0] == own if alone else u.startswith(own))
            and not u.startswith(("about:", "data:", "blob:"))
        ]
        assert not beside, beside
        assert not failed, failed
    finally:
        context.close()


def violations(page: Page) -> list[str]:
    """What axe-core finds wrong in a page and its frames, a line for each rule and element."""
    rules = files("axe_playwright_python").joinpath("axe.min.js").read_text(encoding="utf-8")
    for frame in page.frames:
        frame.evaluate(rules)
    found: list[dict[str, Any]] = page.evaluate("axe.run().then(r => r.violations)")
    return [
        f"{rule['id']}: {node['target']} {node.get('failureSummary', '')[:300]}"
        for rule in found
        for node in rule["nodes"]
    ]


def wider(page: Page) -> int:
    """By how many pixels the page is wider than its window: what is beyond has to be scrolled to."""
    found: int = page.evaluate("document.documentElement.scrollWidth - document.documentElement.clientWidth")
    return found


def letters(page: Page, selector: str) -> float:
    """Height of the smallest letters of the elements on the screen [pixel]."""
    found: float = page.evaluate(
        "s => Math.min(...[...document.querySelectorAll(s)].filter(e => e.getBoundingClientRect().width)"
        ".map(e => parseFloat(getComputedStyle(e).fontSize)"
        " * (e.ownerSVGElement ? e.getScreenCTM().a : 1)))",
        selector,
    )
    return found


SHEET = 1039.0  # pixels of A4 between the margins that the pages ask for
PAPER = 703  # wide


def printed(page: Page) -> tuple[int, float]:
    """Number of sheets of A4 that the page is printed on, and how many of them it fills."""
    page.evaluate("dispatchEvent(new Event('beforeprint'))")
    sheets = len(re.findall(rb"/Type\s*/Page\b", page.pdf(format="A4")))
    with on_paper(page):
        high: float = page.evaluate("document.body.getBoundingClientRect().height")
    return sheets, high / SHEET


@contextmanager
def on_paper(page: Page) -> Iterator[None]:
    """The page as it is laid out for paper, on one endless sheet."""
    size = page.viewport_size
    page.emulate_media(media="print")
    page.set_viewport_size({"width": PAPER, "height": 900})
    yield
    page.emulate_media(media="screen")
    page.set_viewport_size(size or {"width": WIDTHS[0], "height": 900})


_BROKEN = """() => {
  const found = [];
  for (const cell of document.querySelectorAll("th, td")) {
    const walker = document.createTreeWalker(cell, NodeFilter.SHOW_TEXT);
    for (let node; (node = walker.nextNode());) {
      for (const word of node.data.matchAll(/[^\\s\\/@-]+/g)) {
        const range = document.createRange();
        range.setStart(node, word.index);
        range.setEnd(node, word.index + word[0].length);
        const lines = new Set([...range.getClientRects()].filter(r => r.width).map(r => Math.round(r.top)));
        if (lines.size > 1) found.push(word[0]);
      }
    }
  }
  return found;
}"""


def broken(page: Page) -> list[str]:
    """Words of tables that go on in another line."""
    found: list[str] = page.evaluate(_BROKEN)
    return found


def on_few_sheets(page: Page, most: int) -> None:
    """No more sheets than that, and only the last one with room to spare; no table is cut off nor a word of
    one broken; letters of charts have 4.5 pt and lie on the sheet.
    """
    sheets, filled = printed(page)
    assert sheets <= most
    assert sheets - filled < 1.0
    with on_paper(page):
        assert cut(page) == []
        assert broken(page) == []
        if page.locator("svg.chart").count():
            assert letters(page, "svg.chart text") * 0.75 > 4.5
            assert beyond(page) == []


def beyond(page: Page) -> list[str]:
    """Words of charts that begin or end beyond the paper's margins."""
    found: list[str] = page.evaluate(
        "[...document.querySelectorAll('svg.chart text')]"
        ".map(t => [t.textContent, t.getBoundingClientRect()])"
        ".filter(([, b]) => b.width && (b.left < -0.1 || b.right > document.body.clientWidth + 0.1))"
        ".map(([text]) => text)"
    )
    return found


def cut(page: Page) -> list[str]:
    """Tables that are wider than the place they have."""
    found: list[str] = page.evaluate(
        "[...document.querySelectorAll('.table')].filter(t => t.scrollWidth > t.clientWidth + 1)"
        ".map(t => t.getAttribute('aria-label'))"
    )
    return found
