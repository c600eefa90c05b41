"""Several files beside each other: all of them, or none."""

from __future__ import annotations

import tempfile
from collections.abc import Mapping
from pathlib import Path

from modelgen.errors import InputError


def check_writable(option: str, path: Path) -> None:
    """Raises InputError where `path` cannot become a file: before the long work, not after it."""
    if path.is_dir():
        raise InputError(f"{option} {path}: found a folder, expected the name of a file")
    if path.parent.exists() and not path.parent.is_dir():
        raise InputError(f"{option} {path}: {path.parent} is a file, expected a folder")


def write_together(option: str, folder: Path, texts: Mapping[str, str]) -> None:
    """Write name to text into `folder`, every file complete before the first one appears.

    Raises InputError where that cannot be done.
    """
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder, prefix=".new-") as new:
            for name, text in texts.items():
                (Path(new) / name).write_text(text, encoding="utf-8", newline="\n")
            for name in texts:
                (Path(new) / name).replace(folder / name)
    except OSError as error:
        raise InputError(f"{option}: cannot write into {folder}: {error.strerror or error}") from error


def check_folder(option: str, path: Path) -> None:
    """Raises InputError where `path` cannot become a folder: before the long work, not after it."""
    if path.exists() and not path.is_dir():
        raise InputError(f"{option} {path}: found a file, expected a folder")


def write_new(path: Path, text: str) -> None:
    """Write a file that does not exist. Raises InputError where it does, or cannot be written."""
    try:
        with path.open("x", encoding="utf-8", newline="\n") as file:
            file.write(text)
    except FileExistsError:
        raise InputError(f"{path} exists and is left as it is; choose another file with --out") from None
    except OSError as error:
        raise InputError(f"cannot write {path}: {error.strerror}") from None


def write_whole(option: str, path: Path, content: bytes) -> None:
    """Write a file, complete before it appears; one that exists is replaced. Raises InputError."""
    try:
        with tempfile.TemporaryDirectory(dir=path.parent, prefix=".new-") as new:
            (Path(new) / path.name).write_bytes(content)
            (Path(new) / path.name).replace(path)
    except OSError as error:
        raise InputError(f"{option}: cannot write {path}: {error.strerror or error}") from error
