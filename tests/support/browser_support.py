"""Pages in a real browser: Chromium by Playwright, and the accessibility rules of axe-core."""

from __future__ import annotations

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
    """What axe-core finds wrong, a line for each rule and element."""
    page.evaluate(files("axe_playwright_python").joinpath("axe.min.js").read_text(encoding="utf-8"))
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
