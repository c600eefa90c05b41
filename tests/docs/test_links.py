"""Links on the pages lead somewhere: files, headings, addresses in their right form; no network is asked."""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from urllib.parse import urlsplit

import pytest
from page_commands import ROOT, pages

PAGES = [*pages(), "CHANGELOG.md", "tests/hidden/README.md"]
FENCE = re.compile(r"^( *)```.*?^\1```", re.DOTALL | re.MULTILINE)
CODE = re.compile(r"`[^`\n]+`")
LINK = re.compile(r"(?P<picture>!?)\[(?P<text>[^\[\]]*)\]\((?P<target>[^()\s]+(?:\([^()\s]*\))?[^()\s]*)\)")
TAG = re.compile(r"<(?:img|a)\s[^>]*(?:src|href)=\"(?P<target>[^\"]+)\"[^>]*>")
ROW = re.compile(
    r"^\| (?P<question>[A-Z][^|]+\?) \| (?P<links>[^|]+) \| `(?P<command>[^`]+)` \|$", re.MULTILINE
)
AMINUTE = 200  # words that are read in one


@cache
def text(path: Path) -> str:
    return path.read_text(encoding="utf-8")


@cache
def headings(path: Path) -> tuple[str, ...]:
    """Anchors of the headings of a page, as GitHub and MyST make them."""
    found: list[str] = []
    for title in re.findall(r"^#+ (.+?)\s*$", FENCE.sub("", text(path)), re.MULTILINE):
        shown = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", title)
        slug = re.sub(r"[^\w\- ]", "", shown.lower()).replace(" ", "-")
        count = sum(f == slug or re.fullmatch(rf"{re.escape(slug)}-\d+", f) is not None for f in found)
        found.append(f"{slug}-{count}" if count else slug)
    return tuple(found)


def links(page: str) -> list[str]:
    shown = FENCE.sub("", text(ROOT / page))
    plain = CODE.sub("", shown)
    return [m["target"] for pattern in (LINK, TAG) for m in pattern.finditer(plain)]


def wrong(page: str, target: str) -> str:
    """What is wrong with a link of a page; empty where nothing is."""
    if "://" in target or target.startswith("mailto:"):
        parts = urlsplit(target)
        good = parts.scheme == "https" and re.fullmatch(r"([\w-]+\.)+[a-z]{2,}", parts.netloc)
        return "" if good and not target.endswith((".", ",", ";")) else "no address"
    name, _, anchor = target.partition("#")
    path = (ROOT / page).parent / name if name else ROOT / page
    if not path.exists():
        return "no such file"
    if anchor and (path.suffix != ".md" or anchor not in headings(path)):
        return "no such heading"
    return ""


@pytest.mark.parametrize("page", PAGES)
def test_links_lead_somewhere(page: str) -> None:
    found = {target: wrong(page, target) for target in links(page)}
    assert not {target: what for target, what in found.items() if what}


def test_a_wrong_link_is_seen() -> None:
    page = "docs/index.md"
    assert not wrong(page, "logs.md#is-my-log-good-enough")
    assert wrong(page, "log.md") == wrong(page, "../logs.md") == "no such file"
    assert wrong(page, "logs.md#is-my-log-good") == wrong(page, "loop.svg#top") == "no such heading"
    assert wrong(page, "http://example.org") == wrong(page, "https://example") == "no address"


@pytest.mark.parametrize("page", PAGES)
def test_pictures_have_a_text(page: str) -> None:
    shown = CODE.sub("", FENCE.sub("", text(ROOT / page)))
    assert all(m["text"].strip() for m in LINK.finditer(shown) if m["picture"])
    assert all(re.search(r'alt="[^"]+"', m[0]) for m in TAG.finditer(shown) if m[0].startswith("<img"))


def test_questions_of_a_newcomer_are_answered_at_the_top_of_a_page() -> None:
    """One click from the first page, within what is read in a minute, with the command."""
    rows = list(ROW.finditer(text(ROOT / "docs/index.md")))
    assert len(rows) == 5
    for row in rows:
        (target, *_) = [m["target"] for m in LINK.finditer(row["links"])]
        name, _, anchor = target.partition("#")
        page = text(ROOT / "docs" / name)
        if anchor:
            section = next(
                part
                for part in re.split(r"^#+ ", page, flags=re.MULTILINE)[1:]
                if re.sub(r"[^\w\- ]", "", part.splitlines()[0].lower()).replace(" ", "-") == anchor
            )
            page = section
        assert row["command"] in " ".join(page.split()[:AMINUTE]), row["question"]


def test_figures_of_the_readme_are_those_of_their_pages() -> None:
    rows = re.findall(r"^\| \*\*.*\|$", text(ROOT / "README.md"), re.MULTILINE)
    assert len(rows) == 4
    for row in rows:
        (target,) = (m["target"] for m in LINK.finditer(row))
        page = text(ROOT / target)
        for figure in re.findall(r"\*\*(.+?)\*\*", row):
            assert re.search(rf"(?<![\d.]){re.escape(figure)}(?![\d.]*\d)", page), (figure, target)
