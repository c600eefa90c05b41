"""The first arms.yaml of a user: commented, and valid as it stands."""

from __future__ import annotations

from types import MappingProxyType

from modelgen.description.document import one_line
from modelgen.description.names import arm_name_problem
from modelgen.errors import InputError, suggest
from modelgen.resources import templates_folder

# Files beside each other, and what they are of; the first is the default.
STARTERS = MappingProxyType(
    {
        "levered": "a linear actuator on a lever, and a geared joint",
        "direct": "three geared joints",
        "industrial6": "six geared joints with a spherical wrist",
        "scara": "two parallel arms, a ball-screw and a tool axis",
        "tree": "two arms on a waist",
    }
)
DEFAULT = next(iter(STARTERS))
_NAME = "\n  my_arm:\n"  # of the arm in the files


def starter(name: str, kind: str = DEFAULT) -> str:
    """Text of an arms.yaml with one arm to start from, commented.

    Parameters
    ----------
    name : str
        Of the arm: a C identifier.
    kind : str
        "levered", "direct", "industrial6", "scara" or "tree": the arm that yours is most like.

    Returns
    -------
    str
        YAML that generates and can be simulated as it stands.

    Raises
    ------
    InputError
        Where the name cannot be an arm's, and where there is no such kind.
    """
    problem = arm_name_problem(name)
    if problem:
        raise InputError(f"the arm name '{one_line(name, 60)}' cannot be used: {problem}")
    if kind not in STARTERS:
        raise InputError(f"--from: there is no '{one_line(kind, 60)}'{suggest(kind, STARTERS)}")
    text = (templates_folder() / "description" / f"{kind}.yaml").read_text(encoding="utf-8")
    return text.replace(_NAME, f"\n  {_quoted(name)}:\n")


def _quoted(name: str) -> str:
    """YAML reads some words as values."""
    return f'"{name}"' if name.lower() in {"null", "true", "false"} else name
