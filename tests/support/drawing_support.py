"""Runs the scripts of a drawing's page, in Node or in a headless browser."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import tempfile
from html import unescape
from pathlib import Path
from typing import Any

import pytest


def browser() -> str:
    """Chromium; the test is skipped where there is none."""
    found = next(filter(None, map(shutil.which, ("chromium", "chromium-browser"))), None)
    if found is None:
        assert not os.environ.get("CI"), "the browser that CI installs is not there"
        pytest.skip("needs chromium")
    return found


def in_browser(html: str, folder: Path, width: int = 1280) -> str:
    """The document of a page after its scripts have run."""
    path = folder / "page.html"
    path.write_text(html, encoding="utf-8")
    with tempfile.TemporaryDirectory() as profile:
        quiet = [
            "--headless",
            "--no-sandbox",
            "--disable-gpu",
            "--no-first-run",
            "--disable-quic",
            "--disable-background-networking",
            f"--user-data-dir={profile}",
        ]
        size = [f"--window-size={width},900", "--virtual-time-budget=2000", "--dump-dom"]
        done = subprocess.run(
            [browser(), *quiet, *size, path.as_uri()], capture_output=True, check=True, timeout=120
        )
    return done.stdout.decode()


def evaluated(page: str, expression: str, folder: Path) -> Any:
    """A JavaScript expression over the page's `arm` and its script `model`, as data."""
    (model,) = re.findall(r'<script id="model">\n(.*?)\n</script>', page, re.DOTALL)
    (data,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    program = f"{model}\nconst arm = {data};\nconst found = JSON.stringify({expression});\n"
    node = shutil.which("node")
    if node is not None:
        path = folder / "model.js"
        path.write_text(program + "console.log(found);\n", encoding="utf-8")
        done = subprocess.run([node, path], capture_output=True, text=True, check=False, timeout=60)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)
    shown = in_browser(
        f"<pre></pre><script>{program}document.querySelector('pre').textContent = found;</script>", folder
    )
    return json.loads(unescape(re.findall(r"<pre>(.*?)</pre>", shown, re.DOTALL)[0]))
