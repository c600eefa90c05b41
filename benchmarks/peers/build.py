"""Building the programs that are measured."""

from __future__ import annotations

import hashlib
import importlib.metadata
import importlib.util
import subprocess
import sys
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

HERE = Path(__file__).parent
# valgrind 3.19 knows no AVX-512.
TARGET = ("-O3", "-march=x86-64-v3", "-DNDEBUG")
# As in docs/firmware.md; -std=c99 alone would forbid fused operations.
C = ("gcc", *TARGET, "-std=gnu11", "-ffp-contract=fast", "-fno-math-errno", "-fstack-usage")
CXX = ("g++", "-std=c++17", "-fstack-usage")
# What Pinocchio's own CMake target defines.
_PINOCCHIO = (
    "-DBOOST_MPL_LIMIT_LIST_SIZE=30",
    "-DBOOST_MPL_LIMIT_VECTOR_SIZE=30",
    "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
    "-DBOOST_FUSION_INVOKE_MAX_ARITY=12",
)


@dataclass(frozen=True)
class Built:
    """The harness with a peer's functions, and the objects that hold their code."""

    program: Path
    objects: Sequence[Path]


def run(command: Sequence[str], folder: Path | None = None) -> str:
    """Standard output of a command. Raises RuntimeError with what it wrote where it fails."""
    done = subprocess.run(command, capture_output=True, text=True, check=False, cwd=folder)
    if done.returncode:
        raise RuntimeError(f"{' '.join(command)}\n{done.stderr[-3000:]}")
    return done.stdout


def package(name: str) -> Path | None:
    """Folder of an installed Python package, None where there is none."""
    found = importlib.util.find_spec(name)
    if found is None or not found.submodule_search_locations:
        return None
    return Path(found.submodule_search_locations[0])


def object_file(source: Path, out: Path, *flags: str) -> Path:
    """A source of C or C++, compiled."""
    compiler = (*CXX, *TARGET) if source.suffix == ".cpp" else C
    run([*compiler, f"-I{HERE}", f"-I{source.parent}", *flags, "-c", str(source), "-o", str(out)])
    return out


def program(out: Path, objects: Sequence[Path], *flags: str) -> Path:
    """The harness with a peer's objects."""
    harness = out.parent / "harness.o"
    if not harness.exists():
        object_file(HERE / "harness.c", harness)
    run(["g++", str(harness), *map(str, objects), "-o", str(out), *flags, "-lm"])
    return out


def pinocchio_flags() -> list[str] | None:
    """Flags for Pinocchio's headers (wheel pin) with Eigen and CasADi (wheel casadi); None without them."""
    casadi = package("casadi")
    headers = Path(sys.prefix) / f"lib/python{sys.version_info.major}.{sys.version_info.minor}/site-packages"
    prefix = headers / "cmeel.prefix" / "include"
    if casadi is None or not (prefix / "pinocchio").exists():
        return None
    return [*_PINOCCHIO, f"-I{prefix}", f"-I{casadi}/include", f"-I{casadi}/include/eigen3"]


def _once(folder: Path, source: Path, *flags: str) -> Path:
    """A source compiled, anew where it, the arms' reader or a package has changed."""
    found = [importlib.metadata.version(name) for name in ("pin", "casadi")]
    texts = [path.read_text(encoding="utf-8") for path in (source, HERE / "pinocchio_model.hpp")]
    key = hashlib.sha256("\n".join([*texts, *found, *flags]).encode()).hexdigest()[:12]
    out = folder / f"{source.stem}-{key}.o"
    return out if out.exists() else object_file(source, out, *flags)


def pinocchio(folder: Path) -> Path | None:
    """The harness with Pinocchio's algorithms; takes minutes to compile."""
    flags = pinocchio_flags()
    if flags is None:
        return None
    compiled = _once(folder, HERE / "pinocchio.cpp", *flags)
    return program(folder / "pinocchio", [compiled])


def derivatives(folder: Path) -> Path | None:
    """The harness with Pinocchio's derivatives; takes a minute to compile."""
    flags = pinocchio_flags()
    if flags is None:
        return None
    return program(folder / "derivatives", [_once(folder, HERE / "pinocchio_derivatives.cpp", *flags)])


def tracer(folder: Path) -> Path | None:
    """The program that writes Pinocchio's algorithms as C, through CasADi; takes minutes to compile."""
    flags = pinocchio_flags()
    casadi = package("casadi")
    if flags is None or casadi is None:
        return None
    compiled = _once(folder, HERE / "pinocchio_traced.cpp", *flags, "-O1")
    out = folder / "tracer"
    run(["g++", str(compiled), "-o", str(out), f"-L{casadi}", "-lcasadi", f"-Wl,-rpath,{casadi}"])
    return out
