"""Names of arms that would hide something: against the headers of this machine's C library."""

import subprocess
from pathlib import Path

from c_support import C_COMPILERS

from modelgen.description.names import arm_name_problem

INCLUDED = [
    "assert",
    "complex",
    "ctype",
    "dlfcn",
    "errno",
    "fenv",
    "float",
    "inttypes",
    "limits",
    "locale",
    "math",
    "netdb",
    "poll",
    "pthread",
    "sched",
    "semaphore",
    "setjmp",
    "signal",
    "stdarg",
    "stdio",
    "stdlib",
    "string",
    "termios",
    "tgmath",
    "threads",
    "time",
    "unistd",
    "wchar",
    "wctype",
]


def preprocessed(text: str, *options: str) -> subprocess.CompletedProcess[str]:
    """What the C preprocessor makes of a text."""
    command = [C_COMPILERS[0], *options, "-xc", "-"]
    return subprocess.run(command, input=text, capture_output=True, text=True, check=False)


def test_no_arm_hides_a_header_that_the_c_library_reads() -> None:
    found = [name for name in INCLUDED if preprocessed(f"#include <{name}.h>\n", "-E").returncode == 0]
    listed = preprocessed("".join(f"#include <{name}.h>\n" for name in found), "-M").stdout
    read = [Path(word) for word in listed.replace("\\\n", " ").split()]
    (folder,) = {path.parent for path in read if path.name == "stdio.h" and path.parent.name != "bits"}
    beside = {path.stem for path in read if path.parent == folder and path.stem.isidentifier()}
    assert {"stdio", "math", "string"} <= beside
    assert [n for n in sorted(beside) if not n.startswith("_") and arm_name_problem(n) is None] == []


def test_ordinary_names_are_free() -> None:
    for name in ("arm", "digger", "ur10e", "crane", "leg", "scara", "motor", "joint", "test_rig", "m1"):
        assert arm_name_problem(name) is None, name
