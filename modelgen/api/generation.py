"""Generated code of arms."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from modelgen.api.description import an_arm
from modelgen.api.model import COST, costs, total
from modelgen.api.results import Shown, Table
from modelgen.description import Arm
from modelgen.errors import InputError, suggest
from modelgen.functions.parameters_file import read_identification, values_beside, values_of
from modelgen.generation import TARGETS, Budget, GeneratedArm, Report
from modelgen.generation import generate as generate_folders
from modelgen.options import GenerationOptions, ModelOptions, changed
from modelgen.progress import Progress, silent


class Generated(Shown):
    """Results of a generation or of its check.

    Parameters
    ----------
    report : modelgen.generation.Report
        What the generation gives back.
    budget : Budget, optional
        The limits that it was held against.

    Attributes
    ----------
    arms : sequence of GeneratedArm
        By arm: files, operation counts, numbers of parameters.
    drift : sequence of Drift
        Files that differ from what would be generated; of a check alone.
    excess : sequence of Excess
        Functions above the budget; nothing is written then.
    """

    def __init__(self, report: Report, budget: Budget | None = None) -> None:
        self.arms, self.drift, self.excess = report.arms, report.drift, report.excess
        self.budget = budget

    def to_json(self) -> dict[str, Any]:
        """Plain data: what `modelgen generate --json` prints.

        Returns
        -------
        dict
            Arms with their functions' operation counts and files, and drift.
        """
        return {
            "arms": [_arm_data(arm) for arm in self.arms],
            "drift": [{"path": str(drift.path), "kind": drift.kind} for drift in self.drift],
        }

    def shown(self) -> Sequence[str | Table]:
        """The table of `modelgen generate`, a line of at most 60 columns per arm.

        Numbers of joints, of standard and of base parameters, operations (mul + add + neg) of the inverse
        dynamics, files.

        Returns
        -------
        sequence of str or Table
            In the order in which they are printed.
        """
        rows = [
            [
                arm.name,
                str(arm.joints),
                f"{arm.standard_parameters}→{arm.base_parameters}",
                str(total(arm.operations["inverse_dynamics"])),
                str(len(arm.files) + len(arm.artefacts)),
            ]
            for arm in self.arms
        ]
        columns = {
            "arm": "left",
            "joints": "right",
            "param.\n→ base": "right",
            "oper. of\ninverse\ndynamics": "right",
            "files": "right",
        }
        return [Table("", columns, rows, ("arm",))]

    def details(self) -> Table:
        """Operations of every function, as `modelgen generate --verbose` prints them.

        Returns
        -------
        Table
            By arm; a function and its twin for the standard parameters share an entry.
        """
        rows = [
            [arm.name, ", ".join(f"{n} {a}/{b}".rstrip("/") for n, a, b in costs(arm.operations))]
            for arm in self.arms
        ]
        heading = f"{COST}, base/standard parameters"
        return Table("", {"arm": "left", heading: "left"}, rows, ("arm",))

    def __repr__(self) -> str:
        arms = ", ".join(arm.name for arm in self.arms)
        files = sum(len(arm.files) + len(arm.artefacts) for arm in self.arms)
        said = f", {len(self.drift)} differ" if self.drift else ""
        return f"Generated {arms}: {files} files{said}"


def generate(
    arms: Arm | Sequence[Arm] | Mapping[str, Arm],
    out: Path | str = "generated",
    options: ModelOptions | None = None,
    generation: GenerationOptions | None = None,
    *,
    parameters: Path | str | Mapping[str, Any] | None = None,
    identification: Path | str | Mapping[str, Any] | None = None,
    check: bool = False,
    progress: Progress = silent,
) -> Generated:
    """Write C99 and CasADi functions of arms, one folder per arm.

    Parameters
    ----------
    arms : Arm, sequence of Arm, or mapping of str to Arm
        As `load_arms` gives them.
    out : Path or str
        The folder that gets one folder per arm.
    options : ModelOptions, optional
        How the functions are made.
    generation : GenerationOptions, optional
        Artefacts, budgets, processes.
    parameters : Path, str or mapping, optional
        Values of the only arm's base parameters to be folded in: <arm>_parameters.yaml, names with numbers,
        or the parameters of an identification. Default: <arm>_parameters.yaml beside the description,
        where there is one.
    identification : Path, str or mapping, optional
        identification.json of the only arm, or what it holds: its parameters are folded in, and gains and
        thresholds of the functions that watch the arm are set by its noise.
    check : bool
        Compare with what is there and write nothing.
    progress : callable, optional
        It is called with the name of each arm that is done, how many are done, and of how many.

    Returns
    -------
    Generated
        Operation counts, and what differs where it was a check.

    Raises
    ------
    InputError
        For an arm without a model, names that collide, and a folder that cannot be written.
    """
    chosen, more = options or ModelOptions(), generation or GenerationOptions()
    every = arms.values() if isinstance(arms, Mapping) else arms
    wanted = [an_arm(each) for each in ([every] if isinstance(every, Arm | str | Path) else every)]
    budget = _budget(more)
    own = values_beside(wanted, chosen) if parameters is None and identification is None else {}
    names = [arm.name for arm in wanted]
    if identification is not None:
        if parameters is not None:
            raise InputError("--identification holds parameters: give it or --parameters, not both")
        values, noise = read_identification(identification, wanted)
        chosen = changed(chosen, {"identified": values, "noise": noise})
    if parameters is not None:
        chosen = changed(chosen, {"identified": values_of(parameters, names)})
    done = 0

    def told(name: str) -> None:
        nonlocal done
        done += 1
        progress(name, done, len(wanted))

    progress("generating", 0, len(wanted))
    report = generate_folders(
        wanted,
        Path(out),
        chosen,
        check=check,
        artefacts=_artefacts(more),
        budget=budget,
        processes=more.processes,
        identified=own,
        progress=told,
    )
    return Generated(report, budget)


def _artefacts(o: GenerationOptions) -> list[str]:
    asked = {"casadi": o.casadi, "plant": o.casadi_plant, "ros2": o.ros2}
    return [name for name, wanted in asked.items() if wanted]


def _budget(o: GenerationOptions) -> Budget | None:
    """The budget, None where nothing is limited. Raises InputError for a target that does not exist."""
    if o.target not in TARGETS:
        raise InputError(f"--target: found '{o.target}'{suggest(o.target, TARGETS)}")
    nothing = o.max_flash is None and o.max_stack is None
    return None if nothing else Budget(o.target, o.max_flash, o.max_stack)


def _arm_data(arm: GeneratedArm) -> dict[str, Any]:
    return {
        "arm": arm.name,
        "joints": arm.joints,
        "standard_parameters": arm.standard_parameters,
        "base_parameters": arm.base_parameters,
        "functions": arm.operations,
        "files": sorted({**arm.files, **arm.artefacts}),
    }
