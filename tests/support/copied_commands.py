"""The commands on a page of results, read from it and run as a reader copies them."""

from __future__ import annotations

import re
import shlex
from collections.abc import Mapping
from html import unescape
from pathlib import Path
from typing import Any

from command_support import called
from typer.main import get_command

from modelgen.cli.app import app

FILES = {"ARMS", "LOG", "FILE"}  # placeholders of values that are files, but for what is written
SHORT = {
    "excite": ("--period", "5", "--starts", "1", "--iterations", "5", "--jobs", "1"),
    "diagnose": ("--effect", "friction_offset", "--no-experiment", "--jobs", "1"),
}


def commands(page: Path) -> list[list[str]]:
    """Words of every command of a page, as a shell splits them."""
    found = re.findall(r"<pre><code>(.*?)</code>", page.read_text(encoding="utf-8"), re.DOTALL)
    lines = [shlex.split(unescape(text)) for text in found]
    assert all(line[0] == "modelgen" for line in lines)
    return [line[1:] for line in lines]


def parsed(words: list[str], folder: Path) -> Mapping[str, Any]:
    """Values by name, of a command through the parser; every file that it reads is there."""
    group: Any = get_command(app)
    context = group.context_class(group, info_name="modelgen")
    name, command, rest = group.resolve_command(context, words)
    values: dict[str, Any] = command.make_context(name, rest, parent=context).params
    for parameter in command.params:
        given = values.get(parameter.name)
        if parameter.name == "out" or not given or parameter.metavar not in FILES:
            continue
        for text in given if isinstance(given, list | tuple) else [given]:
            assert (folder / str(text).partition("@")[0]).is_file(), (words, text)
    return values


def run(words: list[str], folder: Path) -> None:
    """The command itself, in the folder, with options that make it quick; it ends with those of its page."""
    done = called(*words, *SHORT.get(words[0], ()), cwd=folder)
    assert done.returncode == 0, (words, done.stderr)
    if words[0] in ("calibrate", "excite", "identify", "refine"):
        ((page, end),) = re.findall(r"^report: (.*?)\n(.*)\Z", done.stdout, re.DOTALL | re.MULTILINE)
        for line in commands(folder / page):
            assert re.search(f"{re.escape(shlex.join(['modelgen', *line]))}$", end, re.MULTILINE), line
