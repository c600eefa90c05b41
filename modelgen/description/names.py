"""Names that become part of generated code, and names that are in use."""

from __future__ import annotations

import keyword
import re

from modelgen.description.expressions import FUNCTIONS, UNITS

_C_KEYWORDS = """
auto break case char const continue default do double else enum extern float for goto if inline int
long register restrict return short signed sizeof static struct switch typedef union unsigned void
volatile while alignas alignof and and_eq asm bitand bitor bool catch char8_t char16_t char32_t
class co_await co_return co_yield compl concept consteval constexpr constinit const_cast decltype
delete dynamic_cast explicit export false friend mutable namespace new noexcept not not_eq nullptr
operator or or_eq private protected public reinterpret_cast requires static_assert static_cast
template this thread_local throw true try typeid typename typeof typeof_unqual using virtual wchar_t
xor xor_eq
"""
C_KEYWORDS = frozenset(_C_KEYWORDS.split())
# <name>.h of ISO C23 and POSIX.1-2017, and what these read: the arm's header would hide it from a program.
_HEADERS = """
aio alloca assert complex cpio ctype dirent dlfcn endian errno fcntl features fenv float fmtmsg fnmatch ftw
glob grp iconv inttypes iso646 langinfo libgen limits locale math monetary mqueue ndbm netdb nl_types poll
pthread pwd regex sched search semaphore setjmp signal spawn stdalign stdarg stdatomic stdbit stdbool
stdckdint stddef stdint stdio stdlib stdnoreturn string strings stropts syslimits syslog tar termios tgmath
threads time uchar ucontext ulimit unistd utime utmpx wchar wctype wordexp
"""
HEADERS = frozenset(_HEADERS.split())
# lib<name> of the C and C++ run time: -l<name> would find the arm's.
LIBRARIES = frozenset(("c", "crypt", "dl", "gcc", "m", "nosys", "pthread", "rt", "stdcxx", "supc", "util"))
# Targets that CMake keeps for itself, and folders of every project.
TARGETS = frozenset(
    ("all", "clean", "depend", "edit_cache", "help", "install", "list_install_components", "package",
     "package_source", "rebuild_cache", "test")
)  # fmt: skip
# Names of devices, which no file or folder on Windows can have.
DEVICES = frozenset(("aux", "con", "nul", "prn", *(f"{d}{n}" for d in ("com", "lpt") for n in range(10))))
_TAKEN = (
    (HEADERS, "hides the C library's header <{}.h>"),
    (LIBRARIES, "is a library of the C run time, lib{}"),
    (TARGETS, "is a target that CMake keeps for itself"),
    (DEVICES, "is the name of a device on Windows, which no folder can have"),
)
# Standard parameters are capitals with the number of the joint, base parameters carry an R
# behind it; signals are numbered as in logs.
_STANDARD = re.compile(r"[A-Z]{1,4}[0-9]+R?|(q|qm|dq|ddq|dqm|ddqm|tau|i|temperature)[0-9]+")
_ARGUMENTS = frozenset(
    ("q", "dq", "ddq", "qm", "dqm", "ddqm", "dq_r", "ddq_r", "t", "dt", "input", "parameters", "state", "out")
)


def arm_name_problem(name: str) -> str | None:
    """Say why an arm cannot have this name, None where it can."""
    if name in C_KEYWORDS:
        return f"'{name}' is a keyword of C or C++; it prefixes the generated functions, choose another name"
    for taken, why in _TAKEN:
        if name.lower() in taken:
            return f"'{name}' {why.format(name.lower())}; choose another name, for example {name}_arm"
    if not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name):
        return "expected a C identifier that begins with a letter: letters, digits and _ (ASCII)"
    if "__" in name:
        return f"'{name}' holds two _ in a row, which C++ reserves"
    return None if len(name) <= 48 else "the name is longer than 48 characters"


def symbol_name_problem(name: str) -> str | None:
    """Say why a geometry symbol cannot have this name, None where it can."""
    if name == "pi" or name in FUNCTIONS:
        return f"'{name}' belongs to the expressions themselves, choose another name"
    if name in UNITS:
        return f"'{name}' is a unit, choose another name"
    if name in C_KEYWORDS or keyword.iskeyword(name):
        return f"'{name}' is a keyword, choose another name"
    if name in _ARGUMENTS:
        return f"'{name}' is an argument of the generated functions, choose another name"
    if _STANDARD.fullmatch(name):
        return f"'{name}' could be a standard parameter or a signal (XX2, M3, q1), choose another name"
    return None
