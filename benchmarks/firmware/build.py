"""Compiling an arm for a target, and reading what came out of it."""

from __future__ import annotations

import re
import subprocess
import sys
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from importlib.metadata import version
from pathlib import Path

from elftools.elf.elffile import ELFFile
from elftools.elf.sections import Symbol, SymbolTableSection

from firmware.targets import BOARD, COMMON_FLAGS, WARNINGS, Target

_ALLOCATED = 0x2  # SHF_ALLOC
# Parts of musl's library, which ziglang brings as source, that generated code may call.
_LIBRARY = {
    "float": ("acosf", "sqrtf", "sqrt_data", "__math_invalidf", "tanhf", "expm1f"),
    "double": (
        "acos",
        "sin",
        "cos",
        "__sin",
        "__cos",
        "__rem_pio2",
        "__rem_pio2_large",
        "scalbn",
        "floor",
        "sqrt",
        "sqrt_data",
        "__math_invalid",
    ),
}


def run(command: Sequence[str | Path], folder: Path | None = None) -> str:
    """Output of a program. Raises RuntimeError with what it wrote where it fails."""
    done = subprocess.run(
        [str(part) for part in command], cwd=folder, capture_output=True, text=True, check=False
    )
    if done.returncode:
        raise RuntimeError(f"{command[0]} failed ({done.returncode}):\n{(done.stderr + done.stdout)[-3000:]}")
    return done.stdout


def write(files: Mapping[str, str], folder: Path) -> None:
    """Generated files below a folder."""
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


def gcc_version(target: Target) -> str:
    """Name and version of the target's compiler, for example "arm-none-eabi-gcc 12.2.1"."""
    return f"{target.gcc} {run([target.gcc, '-dumpfullversion']).strip()}"


def zig_version() -> str:
    """Version of the Python package ziglang, for example "zig 0.14.1"."""
    return f"zig {version('ziglang')}"


def function_sizes(program: Path) -> dict[str, int]:
    """Bytes of every function of a program."""
    with program.open("rb") as file:
        return {
            plain(s.name): s["st_size"] for s in symbols(ELFFile(file)) if s["st_info"]["type"] == "STT_FUNC"
        }


def plain(name: str) -> str:
    """A function's name as the source has it: single precision adds a suffix to what is linked."""
    return name.removesuffix("_float")


def symbols(elf: ELFFile) -> Iterator[Symbol]:
    """The symbols of all tables."""
    for section in elf.iter_sections():
        if isinstance(section, SymbolTableSection):
            yield from section.iter_symbols()


@dataclass(frozen=True)
class Object:
    """One compiled source: bytes in flash, deepest frame, and the symbols that it needs."""

    path: Path
    flash: int
    stack: int
    undefined: frozenset[str]


def compile_arm(target: Target, arm: str, folder: Path, out: Path, extra: Sequence[str] = ()) -> list[Object]:
    """Every source below folder/src as an object below `out`, with the recommended flags."""
    out.mkdir(parents=True, exist_ok=True)
    sources = sorted((folder / "src").glob("*.c"))
    flags: list[str | Path] = [
        *COMMON_FLAGS,
        *WARNINGS,
        *target.flags,
        f"-D{arm.upper()}_REAL={target.real}",
        *extra,
    ]
    if target.real == "float":
        flags.append("-fsingle-precision-constant")
    run([target.gcc, *flags, "-fstack-usage", "-I", folder / "include", "-c", *sources], out)
    return [read_object(out / f"{source.stem}.o") for source in sources]


def read_object(path: Path) -> Object:
    """Sizes and undefined symbols of an object; the stack from the compiler's report beside it."""
    report = path.with_suffix(".su")
    lines = report.read_text(encoding="utf-8").splitlines() if report.exists() else []
    frames = [int(line.split("\t")[1]) for line in lines]
    with path.open("rb") as file:
        elf = ELFFile(file)
        flash = sum(
            section["sh_size"]
            for section in elf.iter_sections()
            if section["sh_flags"] & _ALLOCATED and not re.match(r"\.(ARM|eh_frame)", section.name)
        )
        undefined = _undefined(elf)
    return Object(path, flash, max(frames, default=0), undefined)


def _undefined(elf: ELFFile) -> frozenset[str]:
    return frozenset(plain(s.name) for s in symbols(elf) if s["st_shndx"] == "SHN_UNDEF" and s.name)


def link(
    target: Target,
    objects: Sequence[Object],
    sources: Sequence[Path],
    out: Path,
    extra: Sequence[str] = (),
) -> Path:
    """A program for the target's board; `sources` are compiled with it, with the flags `extra`."""
    board = [BOARD / name for name in target.startup]
    flags: list[str | Path] = [
        *COMMON_FLAGS,
        *target.flags,
        "-I",
        BOARD,
        "-nostartfiles",
        "-T",
        BOARD / target.script,
    ]
    # A segment that may be written and executed is no concern on an emulated board.
    flags.append("-Wl,--no-warn-rwx-segments")
    run([target.gcc, *flags, *extra, *board, *sources, *(o.path for o in objects), "-lm", "-o", out])
    return out


def link_functions(target: Target, objects: Sequence[Object], out: Path) -> Path:
    """A program of all functions for `machine`, without a main function."""
    script: list[str | Path] = [
        "-nostartfiles",
        "-Wl,--no-warn-rwx-segments,-e,0",
        "-T",
        BOARD / target.script,
    ]
    run([target.gcc, *target.flags, *script, *(o.path for o in objects), "-lm", "-o", out])
    return out


def zig_program(target: Target, arm: str, folder: Path, out: Path) -> tuple[Object, Path]:
    """The arm by the compiler of the Python package ziglang: one object, and a program of all functions.

    The program has no main function; see `machine`.
    """
    flags = [f"-D{arm.upper()}_REAL={target.real}", *WARNINGS, f"-I{folder / 'include'}"]
    return zig_link(target, sorted((folder / "src").glob("*.c")), flags, out)


def zig_link(target: Target, sources: Sequence[Path], extra: Sequence[str], out: Path) -> tuple[Object, Path]:
    """Sources by the compiler of ziglang, which needs no installed tool: one object, and a program."""
    import ziglang  # noqa: PLC0415 - of the test environment

    out.mkdir(parents=True, exist_ok=True)
    zig = [sys.executable, "-m", "ziglang"]
    musl = Path(ziglang.__file__).parent / "lib" / "libc" / "musl"
    # No tables for unwinding, and none of the checks that zig adds by default.
    flags = [*target.zig, "-O2", "-fno-math-errno", "-ffunction-sections", "-fno-sanitize=all"]
    flags += ["-fno-unwind-tables", "-fno-asynchronous-unwind-tables"]
    code, library, program = out / "code.o", out / "library.o", out / "program.elf"
    run([*zig, "cc", *flags, "-std=c99", "-ffp-contract=fast", *extra, "-c", *sources, "-o", code])
    parts = [musl / "src" / "math" / f"{name}.c" for name in _LIBRARY[target.real]]
    parts += [musl / "src" / "string" / "memset.c", BOARD / "memory.c"]
    inner = ("src/include", "src/internal", "arch/arm", "arch/generic")
    include = [f"-I{musl / name}" for name in inner]
    run([*zig, "cc", *flags, "-fno-builtin", *include, "-c", *parts, "-o", library])
    run([*zig, "ld.lld", "-e", "0", "-T", BOARD / "cortex_m.ld", code, library, "-o", program])
    return read_object(code), program
