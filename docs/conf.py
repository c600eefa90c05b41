"""Sphinx's settings; docs/build.py puts the sources together and calls it."""

from __future__ import annotations

import re
from typing import Any

from docutils import nodes
from latex2mathml.converter import convert

project = "modelgen"
author = "The modelgen authors"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon"]
napoleon_google_docstring = False
napoleon_use_rtype = False
napoleon_use_ivar = True
# A class is found in its module, in its package and here.
suppress_warnings = ["ref.python"]
html_theme = "furo"
html_static_path = ["style"]
html_css_files = ["pages.css"]
html_title = "modelgen"
html_show_copyright = False
html_show_sourcelink = False
html_last_updated_fmt = None
myst_heading_anchors = 4
myst_enable_extensions = ["dollarmath"]
# MathML, which browsers draw without a script and without a network
html_math_renderer = "mathml"
autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_default_options = {"members": True}
autodoc_type_aliases = {"Array": "Array"}


def _plain(app: Any, what: str, name: str, thing: Any, options: Any, lines: list[str]) -> None:
    """Docstrings are plain text: names in backquotes are code, indented lines are as they stand.

    In those with sections, which napoleon reads, indented lines belong to the entry above.
    """
    if any(re.fullmatch(r"-{5,}", line) for line in lines):
        lines[:] = [_escaped(line) for line in lines]
        return
    result: list[str] = []
    block = False
    for line in lines:
        indented = line.startswith("    ")
        if indented and not block:
            result += ["", "::", ""]
        elif block and line.strip() and not indented:
            result.append("")
            block = False
        block = block or indented
        result.append(line if block else _escaped(line))
    lines[:] = [*result, ""]


def _escaped(line: str) -> str:
    """Text as text: stars, bars and underscores mean themselves."""
    line = re.sub(r"^(\s*)([-*+]|\w+[.)])(\s)", r"\1\\\2\3", line)
    parts = re.split(r"(`[^`]+`)", line)
    return "".join(
        f"`{p}`" if p.startswith("`") and len(p) > 1 else re.sub(r"([*|_\\`])", r"\\\1", p) for p in parts
    )


def _inline(translator: Any, node: Any) -> None:
    translator.body.append(convert(node.astext()))
    raise nodes.SkipNode


def _block(translator: Any, node: Any) -> None:
    style = "margin: 1em 0; padding: 2px 0; overflow-x: auto; overflow-y: hidden"
    made = convert(node.astext(), display="block").replace("<math ", '<math style="overflow: visible" ', 1)
    translator.body.append(f'<div style="{style}" tabindex="0">{made}</div>')
    raise nodes.SkipNode


def setup(app: Any) -> None:
    """Called by Sphinx."""
    app.add_html_math_renderer("mathml", (_inline, None), (_block, None))
    app.connect("autodoc-process-docstring", _plain, priority=400)  # before napoleon
