"""Arms as models of simulators."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from modelgen.api.description import an_arm
from modelgen.api.results import Shown, Table
from modelgen.description import Arm
from modelgen.exporting import Exported, Row, check_file, check_format, export_model
from modelgen.files import write_whole
from modelgen.functions.nominal import is_nominal
from modelgen.functions.parameters_file import values_beside, values_of
from modelgen.options import ModelOptions


class ExportedModel(Shown):
    """An arm in the format of a simulator.

    Parameters
    ----------
    found : modelgen.exporting.Exported
        What the export gives back.

    Attributes
    ----------
    arm : Arm
        The arm as described.
    text : str
        The file; of an FMU its modelDescription.xml.
    content : bytes
        The file as it is written.
    rows : tuple of Row
        What the file has of each effect: `status` "exact", "approximated" or "left out", `error` the largest
        [N m, N] over sampled states within the limits, None where it is not known.
    notes : tuple of str
        What the user must know besides.
    """

    def __init__(self, found: Exported) -> None:
        self.found = found
        self.arm = found.arm
        self.text = found.text
        self.content = found.content
        self.rows: tuple[Row, ...] = found.rows
        self.notes = found.notes

    def write(self, path: Path | str) -> None:
        """Write the file, whole or not at all; one that exists is replaced.

        Parameters
        ----------
        path : Path or str
            The file.

        Raises
        ------
        InputError
            Where its folder does not exist or cannot be written.
        """
        check_file("--out", Path(path))
        write_whole("--out", Path(path), self.content)

    def to_json(self) -> dict[str, Any]:
        """Plain data: what `modelgen export --json` prints.

        Returns
        -------
        dict
            Arm, format, what the file has of each effect, notes.
        """
        effects = [
            {
                "effect": row.effect,
                "joint": row.joint,
                "status": row.status,
                "largest_error": row.error,
                "unit": row.unit,
                "text": row.text,
            }
            for row in self.rows
        ]
        return {
            "arm": self.arm.name,
            "format": self.found.form,
            "effects": effects,
            "notes": list(self.notes),
        }

    def shown(self) -> Sequence[str | Table]:
        """Lines and a table of the effects.

        Returns
        -------
        sequence of str or Table
            In the order in which they are printed.
        """
        columns = {"effect": "left", "joint": "left", "in the file": "left", "largest error": "right"}
        cells = [row.cells() for row in self.rows]
        table = [Table("", columns | {"as": "left"}, cells, ("effect", "in the file"))] if cells else []
        return [repr(self), *table, *(f"note: {note}" for note in self.notes)]

    def __repr__(self) -> str:
        n = len(self.arm.coordinates)
        joints = f"{n} joint{'' if n == 1 else 's'}"
        return f"{self.arm.name} as {self.found.title}: {joints}, {len(self.rows)} effects"


def export(
    arm: Arm,
    *,
    to: str,
    out: Path | str | None = None,
    parameters: Path | str | Mapping[str, Any] | None = None,
    fmi: str | None = None,
) -> ExportedModel:
    """Make the model of a simulator of an arm: MuJoCo's MJCF, URDF, or an FMU.

    Parameters
    ----------
    arm : Arm
        An arm whose links have inertials, or with `parameters`.
    to : str
        The format: "mjcf", "urdf" or "fmu".
    out : Path or str, optional
        File to write; one that exists is replaced. Default: none.
    parameters : path or mapping, optional
        Identified base parameters: <arm>_parameters.yaml of `identify`, or values by name. Bodies that could
        exist are found for them, as near to the description's links as can be. Default: the description's
        values; where it lacks some, the file beside it, if there is one.
    fmi : str, optional
        Version of FMI of an FMU, "2.0" or "3.0". Default: "2.0".

    Returns
    -------
    ExportedModel
        The file, and of every effect whether it is exact in it, approximated or left out.

    Raises
    ------
    InputError
        For a format or a version that does not exist, links without inertials, parameters that are not the
        arm's, and a file that cannot be written.
    """
    an_arm(arm)
    check_format(to, fmi)
    if out is not None:
        check_file("--out", Path(out))
    values, note = values_of(parameters, [arm.name]) or None, ""
    if values is None and not is_nominal(arm):
        values = values_beside([arm], ModelOptions()).get(arm.name)
        if values is not None:
            note = f"parameters are those of {arm.name}_parameters.yaml beside the description"
    found = ExportedModel(export_model(arm, to, values, [note] if note else [], fmi))
    if out is not None:
        found.write(out)
    return found
