"""Templates, CMake functions and shipped arms lie beside the package, or inside it when installed."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path


def templates_folder() -> Path:
    """Folder of the Jinja templates.

    Raises FileNotFoundError where the installation is incomplete.
    """
    return _find("templates")


def cmake_folder() -> Path:
    """Folder of ModelgenGenerate.cmake.

    Raises FileNotFoundError where the installation is incomplete.
    """
    return _find("cmake")


def shipped_arms() -> Path:
    """The arms.yaml that comes with modelgen.

    Raises FileNotFoundError where the installation is incomplete.
    """
    return _find("arms.yaml")


def shipped_sizes() -> Path | None:
    """The measured sizes of the shipped arms' functions, None where they are not at hand."""
    try:
        return _find("sizes.json")
    except FileNotFoundError:
        return None


def gallery() -> Path | None:
    """The gallery of effects as a page, where `make docs` has built it; None elsewhere."""
    checkout = Path(str(files("modelgen"))).parent
    page = checkout / "build" / "docs" / "gallery.html"
    return page if (checkout / "pyproject.toml").is_file() and page.is_file() else None


def default_effects() -> tuple[str, ...]:
    """Names of the effects of a driven joint whose description lists none."""
    text = (files("modelgen") / "effects" / "defaults.txt").read_text(encoding="utf-8")
    return tuple(text.split())


def _find(name: str) -> Path:
    package = Path(str(files("modelgen")))
    checkout = package.parent
    # The checkout comes first: an editable installation leaves a copy that ages. pyproject.toml tells it
    # from a site-packages folder, where `templates` may belong to somebody else.
    beside = checkout / ("benchmarks" if name == "sizes.json" else "") / name
    candidates = [beside] if (checkout / "pyproject.toml").is_file() else []
    candidates.append(package / f"_{name}")
    for path in candidates:
        if path.exists():
            return path
    looked = " or ".join(str(path) for path in candidates)
    raise FileNotFoundError(f"modelgen's {name} is missing: expected {looked}; reinstall modelgen")
