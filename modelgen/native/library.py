"""Shared libraries of C sources, built once and kept in the user's cache."""

from __future__ import annotations

import ctypes
import hashlib
import os
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from functools import cache
from pathlib import Path

# No contraction to fused operations: the same results wherever doubles are IEEE 754.
_FLAGS = ("-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-shared")
# Whatever this processor has, and no errno: for what is rounded by libraries of linear algebra anyway.
_FAST = ("-std=gnu99", "-O3", "-march=native", "-ffp-contract=fast", "-fno-math-errno", "-fPIC", "-shared")


NO_COMPILER = "found no C compiler, expected cc, gcc or clang in PATH, or its name in CC"


@cache
def compiler() -> str | None:
    """Find the machine's C compiler: $CC, cc, gcc or clang; None where it has no compiler."""
    for name in (os.environ.get("CC"), "cc", "gcc", "clang"):
        found = shutil.which(name) if name else None
        if found:
            return found
    return None


def library_bytes(files: Mapping[str, str], main: str) -> bytes:
    """The library of the source `main` as a file. Raises RuntimeError as `shared_library` does."""
    tool = compiler()
    if tool is None:
        raise RuntimeError(NO_COMPILER)
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "made.so"
        _build(tool, _FLAGS, files, main, path)
        return path.read_bytes()


def shared_library(files: Mapping[str, str], main: str, *, fast: bool = False) -> ctypes.CDLL:
    """The library of the source `main`, which includes what it needs of `files` (text by path).

    fast: for this processor alone, with fused operations: last digits may differ from machine to machine.

    Libraries lie in $XDG_CACHE_HOME/modelgen (default ~/.cache/modelgen) under a digest of text, flags and
    compiler; a folder that cannot be written is replaced by a temporary one. Raises RuntimeError without a
    compiler, or with the compiler's first complaint.
    """
    tool = compiler()
    if tool is None:
        raise RuntimeError(NO_COMPILER)
    flags = _FAST if fast else _FLAGS
    own = _processor(tool) if fast else ""
    text = "\0".join(
        [tool, _version(tool), own, *flags, main, *(f"{k}\0{v}" for k, v in sorted(files.items()))]
    )
    name = f"{hashlib.sha256(text.encode()).hexdigest()[:24]}.so"
    path = _folder() / name
    if not path.exists():
        _build(tool, flags, files, main, path)
    return ctypes.CDLL(str(path))


def _build(tool: str, flags: tuple[str, ...], files: Mapping[str, str], main: str, path: Path) -> None:
    """Compile beside its place, then move: two processes may build the same library."""
    with tempfile.TemporaryDirectory(dir=path.parent) as scratch:
        for name, text in files.items():
            source = Path(scratch) / name
            source.parent.mkdir(parents=True, exist_ok=True)
            source.write_text(text, encoding="utf-8")
        built = Path(scratch) / "library.so"
        command = [tool, *flags, "-I", f"{scratch}/include", f"{scratch}/{main}", "-o", str(built), "-lm"]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode:
            complaint = next(
                (line for line in done.stderr.splitlines() if "error" in line), done.stderr[:200]
            )
            raise RuntimeError(f"{tool} failed: {complaint}")
        built.replace(path)


@cache
def _version(tool: str) -> str:
    return subprocess.run([tool, "--version"], capture_output=True, text=True, check=False).stdout


@cache
def _processor(tool: str) -> str:
    """Features that the compiler assumes of this processor, as its predefined macros."""
    command = [tool, "-march=native", "-dM", "-E", "-x", "c", os.devnull]
    return subprocess.run(command, capture_output=True, text=True, check=False).stdout


@cache
def _folder() -> Path:
    base = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache")
    folder = base / "modelgen" / f"{sys.platform}-{ctypes.sizeof(ctypes.c_void_p) * 8}"
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):
            pass
    except OSError:
        return Path(tempfile.mkdtemp(prefix="modelgen-"))
    return folder
