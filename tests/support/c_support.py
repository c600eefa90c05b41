"""Compiling and calling generated C, and reading its text back."""

from __future__ import annotations

import ctypes
import re
import shutil
import subprocess
from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path

import numpy as np

from modelgen.backends import NumpyFunction
from modelgen.backends.c.dialect import arrays
from modelgen.functions.objects import Function, Model

WARNINGS = [
    "-pedantic",
    "-Wall",
    "-Wextra",
    "-Wconversion",
    "-Wdouble-promotion",
    "-Wshadow",
    "-Wfloat-equal",
    "-Wundef",
    "-Wmissing-prototypes",
    "-Wcast-qual",
    "-Werror",
]
KEPT = 100  # functions, more than an arm has
C_COMPILERS = [c for c in ("gcc", "clang") if shutil.which(c)] or ["cc"]
CXX_COMPILERS = [c for c in ("g++", "clang++") if shutil.which(c)] or ["c++"]


def write(files: Mapping[str, str], folder: Path) -> None:
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")


def run(command: Sequence[str]) -> str:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, " ".join(command) + "\n" + done.stderr[:3000]
    return done.stdout


def sources(folder: Path) -> list[str]:
    found = [str(path) for path in sorted((folder / "src").glob("*.c"))]
    assert found
    return found


def shared_library(folder: Path, arm: str, real: str, *, optimise: str = "-O0") -> Path:
    """The arm's C as a library, unoptimised unless told: compiling takes longer than a test's calls.

    A contraction to fused operations would hide what the text says.
    """
    library = folder / f"{real}.so"
    flags = [f"-D{arm.upper()}_REAL={real}", optimise, "-ffp-contract=off", "-std=c99", "-fPIC", "-shared"]
    include = ["-I", str(folder / "include")]
    run([C_COMPILERS[0], *flags, *include, one_source(folder), "-o", str(library), "-lm"])
    return library


def one_source(folder: Path) -> str:
    """A file that includes every source: one call of the compiler instead of two dozen."""
    path = folder / "all.c"
    path.write_text("".join(f'#include "{source}"\n' for source in sources(folder)), encoding="utf-8")
    return str(path)


class Library:
    """The functions of a compiled arm, called with NumPy arrays."""

    def __init__(self, path: Path, model: Model, real: str) -> None:
        self.path = path
        self.library = ctypes.CDLL(str(path))
        self.arm = model.arm.name
        self.type = np.dtype(np.float32 if real == "float" else np.float64)
        self.functions = {f.name: f for f in model.functions}

    def call(self, name: str, *inputs: Sequence[float] | np.ndarray) -> tuple[int, dict[str, np.ndarray]]:
        """Status and output arrays; these hold NaN before the call, so that what is not written shows."""
        function = self.functions[name]
        given = [np.ascontiguousarray(x, dtype=self.type) for x in inputs]
        assert [x.size for x in given] == [a.size for a in function.arguments]
        results = {key: np.full(size, np.nan, dtype=self.type) for key, size in arrays(function).items()}
        suffix = "_float" if self.type == np.float32 else ""
        symbol = getattr(self.library, f"{self.arm}_{name}{suffix}")
        symbol.restype = ctypes.c_int
        status = symbol(*(ctypes.c_void_p(x.ctypes.data) for x in [*given, *results.values()]))
        return status, results


def flat(function: Function, outputs: object) -> np.ndarray:
    """Outputs of NumPy or CasADi for one sample, in the order of the C arrays, one after the other."""
    several = outputs if isinstance(outputs, tuple | list) else (outputs,)
    assert len(several) == len(function.outputs)
    arrays_ = [np.asarray(getattr(o, "full", lambda o=o: o)(), dtype=float).ravel() for o in several]
    return np.concatenate(arrays_)


_made: dict[int, NumpyFunction] = {}


def in_numpy(function: Function) -> NumpyFunction:
    """The function in NumPy, translated once while the tests of an arm evaluate it again and again."""
    found = _made.get(id(function))  # which no other has: what was made of a function keeps it
    if found is None:
        if len(_made) > KEPT:
            _made.clear()
        found = _made[id(function)] = NumpyFunction(function)
    return found


def evaluated(function: Function, samples: Sequence[Sequence[np.ndarray]]) -> np.ndarray:
    """Outputs of NumPy for samples of the inputs, one row a sample, in the order of the C arrays."""
    columns = [np.array([given[i] for given in samples]) for i in range(len(function.arguments))]
    found = in_numpy(function)(*columns)
    several = found if isinstance(found, tuple) else (found,)
    return np.concatenate([np.reshape(part, (len(samples), -1)) for part in several], axis=1)


def flat_c(results: Mapping[str, np.ndarray]) -> np.ndarray:
    return np.concatenate(list(results.values()))


_TOKEN = re.compile(
    r"\s+|\"[^\"\n]*\"|(?P<number>(\d+\.\d*|\.\d+|\d+)([eE][-+]?\d+)?[fFuUlL]*)|(?P<name>[A-Za-z_]\w*)"
    r"|(?P<sign>--|\+\+|[-+*/<>=!|&]=|&&|\|\||[-+*/()\[\]{};,<>=!?:&|])"
)
_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)


def tokens(text: str) -> Iterator[str]:
    """The tokens of C text without comments and preprocessor lines. Raises ValueError for what is none."""
    text = re.sub(r"(?m)^\s*#.*$", "", _COMMENT.sub(" ", text))
    position = 0
    while position < len(text):
        match = _TOKEN.match(text, position)
        if match is None:
            raise ValueError(f"no token of C: {text[position : position + 20]!r}")
        position = match.end()
        if not match.group().isspace():
            yield match.group()


TRIGONOMETRY = {"SIN", "COS", "TAN", "ASIN", "ACOS", "ATAN", "ATAN2"}
OTHER = {"EXP", "LOG", "TANH", "ABS", "POW", "sign", "min", "max", "select"}


def counted(text: str, arm: str) -> dict[str, int]:
    """Operations in the body of the one function of a source file, read from its text."""
    found = list(tokens(text))
    begin = found.index("{", found.index(f"{arm}_{_function_name(found, arm)}"))
    counts = dict.fromkeys(("mul", "add", "neg", "div", "sqrt", "trig", "other"), 0)
    before = "{"
    body = iter(found[begin + 1 :])
    for token in body:
        if token == f"{arm.upper()}_C":
            while next(body) != ")":  # a literal carries its own sign
                pass
            before = ")"
            continue
        if token == "*":
            counts["mul"] += 1
        elif token == "/":
            counts["div"] += 1
        elif token in "+-":
            operand = before in (")", "]") or before[0].isalnum() or before[0] == "_"
            counts["add" if operand and before != "return" else "neg"] += 1
        elif token.startswith(f"{arm.upper()}_"):
            word = token[len(arm) + 1 :]
            counts["sqrt"] += word == "SQRT"
            counts["trig"] += 2 if word == "SINCOS" else word in TRIGONOMETRY
            counts["other"] += word in OTHER
        elif token.startswith(f"{arm}_"):
            counts["other"] += token[len(arm) + 1 :] in OTHER
        before = token
    return counts


def _function_name(found: Sequence[str], arm: str) -> str:
    """The name of the function that the file defines: `<arm>_status_t <arm>_<name>(`."""
    for kind, name, bracket in zip(found, found[1:], found[2:], strict=False):
        if kind == f"{arm}_status_t" and bracket == "(" and name.startswith(f"{arm}_"):
            return name[len(arm) + 1 :]
    raise ValueError("no function")
