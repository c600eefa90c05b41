"""Writing a folder whole or not at all, and comparing one with what it should hold."""

from __future__ import annotations

import os
import shutil
from collections.abc import Collection, Mapping
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from modelgen.errors import InputError

MARK = "manifest.json"  # a folder that holds it was generated, and may be replaced
# Folders that are made where they are asked for and never committed: two belong to a release of CasADi,
# the third holds copies of the C files.
ARTEFACTS = ("casadi", "plant", "ros2")
_AT_ONCE = 8  # files that are written side by side
_IGNORED = "__pycache__"  # left by Python beside a module that was imported


def check_output(out: Path, names: list[str]) -> None:
    """Raise InputError where `out` or a folder in it cannot be written, before any work is done."""
    for parent in [out, *out.parents]:
        if parent.exists() or parent.is_symlink():
            if not parent.is_dir():
                raise InputError(
                    f"cannot write to {out}: {parent} is a file, expected a folder; choose another --out"
                )
            if not os.access(parent, os.W_OK | os.X_OK):
                raise InputError(
                    f"cannot write to {out}: no permission to write in {parent}; choose another --out"
                )
            break
    for name in names:
        _check_replaceable(out / name)


def write_folder(folder: Path, files: Mapping[str, str]) -> None:
    """Put a folder with exactly these files in place of the one that may be there.

    The files are complete on the disk before the folder gets its name; an interruption at any time
    leaves the old folder or the new one. Raises InputError where the folder cannot be written or is
    none that was generated.
    """
    new, old = folder.with_name(f".{folder.name}.new"), folder.with_name(f".{folder.name}.old")
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        if old.exists() and not folder.exists():
            old.rename(folder)  # an earlier run was killed between its two renamings
        _check_replaceable(folder)
        _remove(new)
        _remove(old)
        try:
            # A disk takes little longer for several files than for one.
            with ThreadPoolExecutor(_AT_ONCE) as pool:
                for _ in pool.map(_write, [new / name for name in files], files.values()):
                    pass
            _replace(folder, new, old)
        except BaseException:
            _remove(new)
            raise
        _remove(old)
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError(f"cannot write {folder}: {reason}; what was there is unchanged") from error


def differences(
    folder: Path, files: Mapping[str, str], ignored: Collection[str] = ()
) -> list[tuple[str, str]]:
    """(path below the folder, "missing", "changed" or "extra") of all that differs, sorted by path.

    What lies in a folder of `ignored`, by its path below the folder, is not extra.
    """
    found = {}
    for name, text in files.items():
        path = folder / name
        if not path.is_file():
            found[name] = "missing"
        elif path.read_bytes() != text.encode():
            found[name] = "changed"
    for path in folder.rglob("*") if folder.is_dir() else ():
        name = path.relative_to(folder).as_posix()
        if name.partition("/")[0] in ignored:
            continue
        if not path.is_dir() and name not in files and _IGNORED not in path.parts:
            found[name] = "extra"
    return sorted(found.items())


def _check_replaceable(folder: Path) -> None:
    if not folder.exists() and not folder.is_symlink():
        return
    if not folder.is_dir():
        raise InputError(
            f"cannot write {folder}: it is a file, expected a folder; move it away or choose another --out"
        )
    if not (folder / MARK).is_file() and any(folder.iterdir()):
        raise InputError(
            f"cannot replace {folder}: it was not generated (no {MARK}); move it away or use another --out"
        )


def _write(path: Path, text: str) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    with path.open("wb") as file:
        file.write(text.encode())
        file.flush()
        os.fsync(file.fileno())


def _replace(folder: Path, new: Path, old: Path) -> None:
    """Two renamings; the first is undone where the second fails."""
    if not folder.exists():
        new.rename(folder)
        return
    folder.rename(old)
    try:
        new.rename(folder)
    except BaseException:
        old.rename(folder)
        raise


def _remove(folder: Path) -> None:
    if folder.is_symlink():
        folder.unlink()
    elif folder.exists():
        shutil.rmtree(folder)
