"""Figures of generators that are not on PyPI, as they were measured once, beside modelgen's of today.

Operations: multiplications, additions and negations, trigonometry apart; links alone, parameters at run
time.
SymPyBotics 1.0: Sousa 2014, doi:10.5281/zenodo.11365, github.com/cdsousa/SymPyBotics. OpenSYMORO: Khalil,
Vijayalingam, Khomutenko, Mukhanov, Lemoine and Ecorchard, "OpenSYMORO: an open-source software package for
symbolic modelling of robots", AIM 2014; github.com/symoro/symoro (0.1alpha, no releases), its dead code removed
before counting. The commits were not recorded.
"""

# ruff: noqa: E501 - lines of the page
from __future__ import annotations

from modelgen.functions import build_model
from peers.arms import LINKS_ALONE, subject

ARMS = ("ariane4_free", "ariane6", "rx90", "puma560", "wam7")
# modelgen's function -> generator -> operations on ARMS.
QUOTED = {
    "inverse_dynamics_standard": {
        "SymPyBotics": (422, 722, 663, 744, 839),
        "OpenSYMORO": (409, 699, 652, 722, 822),
    },
    "inverse_dynamics": {"OpenSYMORO": (345, 587, 547, 609, 698)},
    "regressor_standard": {
        "SymPyBotics": (579, 1493, 1308, 1725, 2049),
        "OpenSYMORO": (602, 1503, 1313, 1673, 2104),
    },
    "regressor": {"SymPyBotics": (421, 1036, 954, 1175, 1430), "OpenSYMORO": (458, 1088, 987, 1188, 1484)},
    "mass_matrix": {"OpenSYMORO": (171, 422, 353, 500, 592)},
    "forward_dynamics": {"OpenSYMORO": (1144, 2023, 1735, 2083, 2432)},
}
TEXT = """\
Operations (multiplications, additions and negations; trigonometry apart) of links alone with parameters at run
time; `_standard`: ten parameters per link, the others: base parameters. modelgen's are counted in this run, the
others quoted from one run of SymPyBotics 1.0 ([Sousa 2014](https://doi.org/10.5281/zenodo.11365)) and of
OpenSYMORO 0.1alpha (Khalil, Vijayalingam, Khomutenko, Mukhanov, Lemoine, Ecorchard, *OpenSYMORO: an open-source
software package for symbolic modelling of robots*, AIM 2014; [repository](https://github.com/symoro/symoro), its
dead code removed before counting), whose commits were not recorded. puma560: theirs on Craig's frames.
"""


def counted() -> dict[str, list[int]]:
    """modelgen's operations on ARMS, by function."""
    found: dict[str, list[int]] = {name: [] for name in QUOTED}
    for arm in ARMS:
        counts = {f.name: f.operations for f in build_model(subject(arm).arm, LINKS_ALONE).functions}
        for name, values in found.items():
            values.append(sum(counts[name][kind] for kind in ("mul", "add", "neg")))
    return found


def table(ours: dict[str, list[int]]) -> list[str]:
    """Lines of the table, modelgen's figures in bold."""
    lines = ["| function | generator | " + " | ".join(ARMS) + " |", "|---|---|" + "---:|" * len(ARMS)]
    for name, others in QUOTED.items():
        for who, figures in others.items():
            lines.append(f"| `{name}` | {who} | " + " | ".join(map(str, figures)) + " |")
        lines.append("| | **modelgen** | " + " | ".join(f"**{x}**" for x in ours[name]) + " |")
    return lines
