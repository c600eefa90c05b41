"""Files of an arm's folder that build systems and people need beside the code."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Sequence

from modelgen.backends.provenance import Provenance
from modelgen.backends.text import render
from modelgen.functions.objects import Model
from modelgen.packaging.readme import readme
from modelgen.packaging.self_test import self_test
from modelgen.version import __version__

_TEMPLATES = {
    "CMakeLists.txt": "package/CMakeLists.txt.j2",
    "library.properties": "package/library.properties.j2",
    "idf_component.yml": "package/idf_component.yml.j2",
    "zephyr/module.yml": "package/module.yml.j2",
    "zephyr/CMakeLists.txt": "package/zephyr.cmake.j2",
    "zephyr/Kconfig": "package/Kconfig.j2",
}


def packaging_files(
    model: Model, provenance: Provenance, paths: Iterable[str], sizes: Sequence[Sequence[str]] = ()
) -> dict[str, str]:
    """Text of the packaging's files by path below the arm's folder, whose C files are at `paths`.

    `sizes`: rows of the README's table of measured sizes, its heading first.
    """
    arm = model.arm.name
    macro = arm.upper()
    values = {
        "arm": arm,
        "macro": macro,
        "provenance": provenance.head(arm),
        "version": version(model.arm.version),
        "default": provenance.real,
        "real": f"${{{macro}_REAL}}",
        "sources": sorted(path for path in paths if path.endswith(".c")),
    }
    files = {path: render(template, **values) for path, template in _TEMPLATES.items()}
    files[f"src/{arm}.h"] = render("package/forward.h.j2", **values)
    files["library.json"] = _platformio(arm, version(model.arm.version), provenance)
    files["examples/self_test/main.c"] = self_test(model, provenance)
    files["README.md"] = readme(model, provenance, sizes)
    return files


def version(given: str = "") -> str:
    """Three numbers, as every one of the build systems reads them: the arm's version, else the tool's."""
    found = re.match(r"\d+\.\d+\.\d+", given) or re.match(r"\d+\.\d+\.\d+", __version__)
    return found.group() if found else "0.0.0"


def _platformio(arm: str, version: str, provenance: Provenance) -> str:
    content = {
        "name": arm,
        "version": version,
        "description": " ".join([f"Dynamic model of the robot arm {arm}.", *provenance.lines(arm)]),
        "keywords": ["robotics", "dynamics"],
        "authors": [{"name": "modelgen"}],
        "frameworks": "*",
        "platforms": "*",
        "headers": f"{arm}.h",
        "build": {
            "includeDir": "include",
            "srcDir": "src",
            "flags": ["-ffp-contract=fast", "-fno-math-errno"],
        },
    }
    return json.dumps(content, indent=2) + "\n"
