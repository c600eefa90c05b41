"""make docs: the pages of this folder, the examples, and the reference from docstrings and --help, as HTML.

    python docs/build.py [--out build/docs]

By Sphinx, warnings as errors. The sources are put together in a temporary folder: nothing is written here.
"""

from __future__ import annotations

import argparse
import importlib
import os
import pkgutil
import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from pathlib import Path
from types import ModuleType
from typing import Any

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
PICTURES = (".svg", ".png")
# In the order in which data flows.
PACKAGES = (
    "transmission",
    "description",
    "geometry",
    "effects",
    "model",
    "base_parameters",
    "functions",
    "graph",
    "backends",
    "generation",
    "drawing",
    "dataset",
    "excitation",
    "calibration",
    "evaluation",
    "simulation",
    "identification",
    "diagnosis",
    "fleet",
    "jobs",
)
# What index.md says of the pages that are made here.
REFERENCE = "every command and every function (`make docs` builds these pages)"
# The reader's way first, in its order.
GUIDES = {
    "The way": [
        "install",
        "tutorial",
        "from-a-drawing",
        "from-a-urdf",
        "logs",
        "identification",
        "diagnosing",
        "firmware",
        "mpc",
        "python",
    ],
    "Seen on real arms": ["case-studies"],
    "The arm": ["describing", "importing", "drawing", "calibration", "exporting"],
    "Motions": ["excitation", "simulation", "fleet"],
    "The code": ["packaging", "safety"],
    "What is measured": ["diagnosis", "strangers", "benchmarks", "sizes", "imported-robots"],
    "How it works": [
        "effects",
        "gallery",
        "diagnosis_method",
        "thresholds",
        "theory",
        "architecture",
        "glossary",
    ],
}


def main() -> int:
    """Exit status of Sphinx."""
    parser = argparse.ArgumentParser(prog="docs/build.py")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "docs")
    out = parser.parse_args().out
    with tempfile.TemporaryDirectory() as scratch:
        source = Path(scratch) / "source"
        gather(source)
        options = ["-W", "--keep-going", "-q", "-b", "html", "-c", str(HERE), "-d", f"{scratch}/trees"]
        done = subprocess.run([sys.executable, "-m", "sphinx", *options, str(source), str(out)], check=False)
    if not done.returncode:
        for page in out.rglob("*.html"):
            _write(page, pictured(accessible(page.read_text("utf-8")), page.parent))
        print(f"{os.path.relpath(out)}/index.html")
    return done.returncode


def accessible(text: str) -> str:
    """A page with what the theme leaves out for keyboards and screen readers: reach, levels, names."""
    text = re.sub(r"<pre>(?=<span></span>)", '<pre tabindex="0">', text)
    text = re.sub(r'<div class="table-wrapper[^"]*"', r'\g<0> tabindex="0"', text)
    text = text.replace('role="heading"><span', 'role="heading" aria-level="2"><span')
    text = text.replace(
        '<aside class="sidebar-drawer">', '<aside class="sidebar-drawer" aria-label="All pages">'
    )
    text = re.sub(r'<aside class="toc-drawer[^"]*"', r'\g<0> aria-label="This page"', text)
    # Of a part of a log, FILE@t0:t1, docutils makes an address to write to.
    text = re.sub(r'<a [^>]*href="mailto:[^"]*"[^>]*>(.*?)</a>', r"\1", text)
    text = text.replace('<div id="search-results">', '<h1>Search</h1>\n<div id="search-results">')
    text = re.sub(r"<table.*?</table>", lambda m: labelled(m[0]), text, flags=re.DOTALL)
    text = re.sub(
        r'(<div class="highlight-sh.*?<pre[^>]*><span></span>)(.*?)(?=</pre>)',
        lambda m: m[1] + in_words(m[2]),
        text,
        flags=re.DOTALL,
    )
    # A long name breaks between its words.
    text = re.sub(r"(<h[12]>)(\w+)(?=<)", lambda m: m[1] + m[2].replace("_", "_<wbr>"), text)
    # A cell above the names of the rows heads nothing.
    return re.sub(r'<th class="head([^"]*)">(?:<p></p>)?</th>', r'<td class="head\1"></td>', text)


def labelled(table: str) -> str:
    """A table whose cells, but for a row's first, name their column: narrow screens fold it."""
    head, end, body = table.partition("</thead>")
    names = [re.sub(r"<[^>]*>", "", cell) for cell in re.findall(r"<t[hd][^>]*>.*?</t[hd]>", head, re.DOTALL)]

    def row(found: re.Match[str]) -> str:
        cells = re.split(r"(?=<td)", found[0])
        for k, name in list(enumerate(names, 1))[1:]:
            if k < len(cells):
                cells[k] = cells[k].replace("<td", f'<td data-label="{name}"', 1)
        return "".join(cells)

    return head + end + re.sub(r"<tr.*?</tr>", row, body, flags=re.DOTALL)


def in_words(code: str) -> str:
    """Highlighted text with a box about each word, in which no line ends: options have hyphens."""
    parts, word = [], ""
    for opening, text in re.findall(r"(?:(<span[^>]*>))?([^<]+)(?:</span>)?", code):
        for piece in re.findall(r"\s+|\S+", text):
            marked = f"{opening}{piece}</span>" if opening else piece
            if not piece.isspace():
                word += marked
                continue
            parts += [f'<span class="word">{word}</span>' if word else "", marked]
            word = ""
    return "".join(parts) + (f'<span class="word">{word}</span>' if word else "")


def pictured(text: str, folder: Path) -> str:
    """A page of a folder whose pictures lead to their own files, in boxes that scroll on a narrow screen.

    A picture is not drawn narrower there than three quarters of its own width, so that its letters stay
    legible. One that has no colours for the night lies on a card of its own.
    """

    def boxed(found: re.Match[str]) -> str:
        path = folder / found["src"]
        style = f' style="--legible: {round(0.75 * width)}px"' if (width := natural_width(path)) else ""
        card = "" if has_night(path) else " card"
        return f'<span class="picture{card}"{style}><a href="{found["src"]}">{found[0]}</a></span>'

    return re.sub(r'<img [^>]*src="(?P<src>[^":]*_images/[^"]+)"[^>]*>', boxed, text)


def has_night(picture: Path) -> bool:
    """Whether a picture has colours for dark pages beside those for light ones."""
    return picture.suffix == ".svg" and "prefers-color-scheme: dark" in picture.read_text("utf-8")


def natural_width(picture: Path) -> float:
    """Width that a picture has by itself [pixel]; 0 where it names none."""
    if picture.suffix == ".png":
        return float(int.from_bytes(picture.read_bytes()[16:20], "big"))
    head = re.search(r"<svg[^>]*>", picture.read_text("utf-8"))
    tag = head[0] if head else ""
    named = re.search(r'\bwidth="([\d.]+)(pt|px|)"', tag)
    if named:
        return float(named[1]) * (4 / 3 if named[2] == "pt" else 1)
    box = re.search(r'\bviewBox="[-\d.]+ [-\d.]+ ([\d.]+)', tag)
    return float(box[1]) if box else 0.0


def gather(folder: Path) -> None:
    """Pages, pictures, examples and reference as Sphinx wants them."""
    named = {page for pages in GUIDES.values() for page in pages}
    others = sorted(p.stem for p in HERE.glob("*.md") if p.stem not in named | {"index"})
    howto = sorted(f"howto/{p.stem}" for p in (HERE / "howto").glob("*.md"))
    for path in HERE.rglob("*"):
        if path.suffix == ".md":
            _write(folder / path.relative_to(HERE), _linked(path.read_text("utf-8")))
        elif path.suffix in PICTURES:
            _copy(path, folder / path.relative_to(HERE))
    examples = []
    for place in sorted((ROOT / "examples").iterdir()):
        if not place.is_dir():
            continue
        if (place / "README.md").exists():
            text = (place / "README.md").read_text("utf-8").replace("](../../docs/", "](../../")
            # sources lie beside the page in the repository alone
            text = re.sub(r"\[([^\]]+)\]\(([^)/]+\.(?:c|py|yaml))\)", r"`\1`", text)
            _write(folder / "examples" / place.name / "README.md", text)
            examples.append(f"examples/{place.name}/README")
        for picture in place.iterdir():
            if picture.suffix in PICTURES:
                _copy(picture, folder / "examples" / place.name / picture.name)
    for package in PACKAGES:
        _write(folder / "reference" / f"{package}.md", reference(package))
    _write(folder / "reference" / "face.md", face())
    _write(folder / "reference" / "command_line.md", command_line())
    trees = {
        **GUIDES,
        "How to": howto,
        "More": others,
        "Examples": examples,
        "Reference": [f"reference/{name}" for name in ("face", "command_line", *PACKAGES)],
    }
    index = folder / "index.md"
    made = "[every command](reference/command_line.md) and [every function](reference/face.md)"
    text = index.read_text("utf-8").replace(REFERENCE, made)
    index.write_text(text + "".join(_tree(k, v) for k, v in trees.items() if v), "utf-8")


def reference(package: str) -> str:
    """A page of everything public in a package."""
    module = importlib.import_module(f"modelgen.{package}")
    options, names = "   :members:\n", [module.__name__]
    if hasattr(module, "__all__"):
        options += "   :imported-members:\n"
        elsewhere = [name for name in module.__all__ if _home(module, name) not in (None, package)]
        if elsewhere:
            options += f"   :exclude-members: {', '.join(elsewhere)}\n"
    elif hasattr(module, "__path__"):
        names += modules(package)
    text = "".join(f".. automodule:: {name}\n{options}\n" for name in names)
    return f"# modelgen.{package}\n\n```{{eval-rst}}\n{text}```\n"


def face() -> str:
    """A page of what `import modelgen` gives."""
    module = importlib.import_module("modelgen")
    # Classes of packages that have a page of their own are described there.
    elsewhere = {name: home for name in module.__all__ if (home := _home(module, name)) is not None}
    listed = "".join(f"- `{name}`: [modelgen.{home}]({home}.md)\n" for name, home in elsewhere.items())
    text = ".. automodule:: modelgen\n   :members:\n   :imported-members:\n"
    text += f"   :exclude-members: {', '.join(elsewhere)}\n"
    return f"# modelgen\n\n```{{eval-rst}}\n{text}```\n\nAlso of the face:\n\n{listed}"


def _home(module: ModuleType, name: str) -> str | None:
    """The package with a page of its own that an object comes from; None where there is none."""
    parts = str(getattr(getattr(module, name), "__module__", "")).split(".")
    return parts[1] if parts[0] == "modelgen" and len(parts) > 1 and parts[1] in PACKAGES else None


def modules(package: str) -> Iterator[str]:
    """Dotted names of the modules of a package."""
    module = importlib.import_module(f"modelgen.{package}")
    for found in pkgutil.iter_modules(module.__path__):
        yield f"modelgen.{package}.{found.name}"


def command_line() -> str:
    """Every command with its options, an explanation under each name: legible on a narrow screen too."""
    from typer.main import get_command  # noqa: PLC0415 - slow, and only here

    from modelgen.cli.app import app  # noqa: PLC0415

    group: Any = get_command(app)
    inside = group.context_class(group, info_name="modelgen")
    parts = ["# Command line", *_explained(group, inside)]
    for name, command in group.commands.items():
        context = command.context_class(command, info_name=name, parent=inside)
        parts += [f"## {name}", *_explained(command, context)]
    return "\n\n".join(parts) + "\n"


def _explained(command: Any, context: Any) -> Iterator[str]:
    """Usage, purpose and parameters of a command, as blocks of Markdown."""
    yield f"```text\n{' '.join([context.command_path, *command.collect_usage_pieces(context)])}\n```"
    paragraphs = [_plain(part) for part in re.split(r"\n\s*\n", command.help or "")]
    records = [p.get_help_record(context) for p in command.get_params(context)]
    rows = [f"   ``{name}``\n      {_plain(said)}\n" for name, said in filter(None, records)]
    text = "\n\n".join([*paragraphs, ".. container:: options", "\n".join(rows)])
    yield f"```{{eval-rst}}\n{text}```"


def _plain(text: str) -> str:
    """A paragraph in one line, whose characters mean themselves; options in it are code."""
    text = re.sub(r"([*|_\\`])", r"\\\1", " ".join(text.split()))
    return re.sub(r"(?<![\w-])--[a-z][a-z-]*", r"``\g<0>``", text)


def _linked(text: str) -> str:
    """Links to examples, which lie beside this folder in the repository and below it here."""
    text = re.sub(r"\[([^\]]+)\]\((?:\.\./)+examples/\w+/?\)", r"\1", text)  # a folder is no page
    return text.replace("](../examples/", "](examples/")


def _tree(title: str, pages: list[str]) -> str:
    listed = "\n".join(pages)
    return f"\n```{{toctree}}\n:caption: {title}\n:hidden:\n\n{listed}\n```\n"


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(text, encoding="utf-8")


def _copy(path: Path, place: Path) -> None:
    place.parent.mkdir(parents=True, exist_ok=True)
    shutil.copy(path, place)


if __name__ == "__main__":
    sys.exit(main())
