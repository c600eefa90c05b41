"""Templates, CMake functions and shipped arms lie beside the package, or inside it when installed."""

from __future__ import annotations

from importlib.resources import files
from pathlib import Path

# Of a checkout, of what does not stand at its top.
_FOLDERS = {"sizes.json": "benchmarks", "gallery": "docs", "gallery.jsonl": "tests/hidden/runs"}


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


def gallery() -> tuple[Path, Path] | None:
    """Folder of the gallery's pictures, and what its records showed; None where they are not at hand."""
    try:
        return _find("gallery"), _find("gallery.jsonl")
    except FileNotFoundError:
        return None


def default_effects() -> tuple[str, ...]:
    """Names of the effects of a driven joint whose description lists none."""
    text = (files("modelgen") / "effects" / "defaults.txt").read_text(encoding="utf-8")
    return tuple(text.split())


def _find(name: str) -> Path:
    package = Path(str(files("modelgen")))
    checkout = package.parent
    # The checkout comes first: an editable installation leaves a copy that ages. pyproject.toml tells it
    # from a site-packages folder, where `templates` may belong to somebody else.
    beside = checkout / _FOLDERS.get(name, "") / name
    candidates = [beside] if (checkout / "pyproject.toml").is_file() else []
    candidates.append(package / f"_{name}")
    for path in candidates:
        if path.exists():
            return path
    looked = " or ".join(str(path) for path in candidates)
    raise FileNotFoundError(f"modelgen's {name} is missing: expected {looked}; reinstall modelgen")
