"""A foreign log through its mapping: columns of the names and units of docs/logs.md."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import replace

import numpy as np

from modelgen.dataset.drives import NumericDrive
from modelgen.dataset.mapping import units
from modelgen.dataset.mapping.files import Foreign, listed
from modelgen.dataset.mapping.formula import Formula, FormulaError, formula
from modelgen.dataset.mapping.schema import ColumnModel, JointModel
from modelgen.dataset.mapping.signals import Signal, check_once
from modelgen.dataset.objects import Reader, Wanted
from modelgen.description import Arm
from modelgen.description.document import Steps
from modelgen.description.messages import describe
from modelgen.errors import suggest
from modelgen.numeric import Array


class MappedReader:
    """A reader with the columns t, q<n> or qm<n>, dq<n>, ddq<n>, temperature<n>, i<n>, tau<n>, taum<n>, u<n>.

    taum<n> is a force at the motor coordinate, u<n> a duty cycle or a voltage. named: the log's columns that
    have such a name themselves, which are read where the mapping has no joints. Raises InputError where the
    mapping does not fit the arm or the file's columns.
    """

    def __init__(
        self,
        foreign: Foreign,
        reader: Reader,
        arm: Arm,
        drives: Sequence[NumericDrive],
        named: Sequence[str] = (),
    ) -> None:
        self.foreign, self.reader, self.arm, self.drives = foreign, reader, arm, drives
        self.by_column = reader.by_column
        document = foreign.document
        n = len(drives)
        joints = foreign.joints
        if joints is not None and len(joints) != n:
            expected = f"expected {n}, the coordinates of {arm.name}: {', '.join(arm.coordinate_names)}"
            raise foreign.error(f"found {len(joints)} joints, {expected}", ["joints"], key=True)
        self._remarks: list[str] = []
        self.effort_units: dict[str, str] = {}
        self._aliases = dict(document.names)
        for short, name in self._aliases.items():
            if name not in reader.names:
                raise foreign.error(f"{self._no_column(name)}", ["names", short])
        self._columns = (*reader.names, *self._aliases)
        self._rate = foreign.positive(document.rate, ["rate"])
        time = document.time
        factor = foreign.unit(time.unit, units.TIMES, ["time"])
        if time.column in getattr(reader, "instants", ()):
            factor = 1.0  # a date has its own unit
        stamped = formula("0", ()) if self._rate else self._formula(time.column, ["time", "column"])
        self._time = Signal(stamped, factor, 0.0)
        self._counted: float = getattr(reader, "origins", {}).get(time.column, 0.0)
        self.origin = self._counted  # of the time t, in what the log's own stamps count from [s]
        self._signals: dict[str, Signal] = {}
        self._groups: dict[str, list[str]] = {}  # coupled columns by kind, in the order of the joints
        if joints is None:
            self._signals = {name: Signal(formula(name, self._columns), 1.0, 0.0) for name in named}
        for k, joint in enumerate(joints or ()):
            self._joint(k, joint)
        check_once(foreign, self._signals, self._aliases)
        self._coupling = foreign.matrices(n)
        if self._coupling is not None:
            self._couple(n)
        self.names = ("t", *self._signals)
        for name in (
            *self._time.formula.names,
            *(x for s in self._signals.values() for x in s.formula.names),
        ):
            original = self._aliases.get(name, name)
            if (count := reader.names.count(original)) > 1:
                raise foreign.error(
                    f"the log's column {original} stands there {count} times, expected once", []
                )

    @property
    def remarks(self) -> tuple[str, ...]:
        """What the mapping and the file say for the user."""
        return (*self._remarks, *self.reader.remarks)

    @property
    def scales(self) -> dict[str, tuple[float, float]]:
        """Factor and offset of the columns that are plain columns of the log, by name."""
        if self._coupling is not None:
            return {}
        return {name: (s.factor, s.offset) for name, s in self._signals.items() if s.bits is None}

    def _originals(self, wanted: Wanted) -> Wanted:
        """The log's own columns, the time's first, of which the wanted ones are made."""

        def of(names: Iterable[str]) -> list[str]:
            signals = [self._signals[member] for name in names for member in self._members(name)]
            return [self._aliases.get(x, x) for signal in signals for x in signal.formula.names]

        def turns(name: str) -> bool:
            signals = [self._signals[member] for member in self._members(name)]
            return any(x.wrap is not None or x.bits is not None for x in signals)

        time = [self._aliases.get(name, name) for name in self._time.formula.names]
        return Wanted(
            tuple(dict.fromkeys([*time, *of(wanted.names)])),
            frozenset(of(wanted.positions)),
            frozenset(of(wanted.efforts)),
            frozenset(of(filter(turns, wanted.positions))),
        )

    def blocks(self, wanted: Wanted, rows: int) -> Iterator[Array]:
        """The wanted columns, block after block."""
        asked, names = self._originals(wanted), wanted.names
        start: float | None = None
        last: dict[Signal, float] = {}
        count = 0
        if not asked.names:  # the time alone of a log whose samples are counted
            asked = Wanted(tuple(dict.fromkeys(next(iter(self._signals.values())).formula.names)))
        for block in self.reader.blocks(asked, rows):
            columns = {name: block[:, i] for i, name in enumerate(asked.names)}
            columns |= {short: columns[name] for short, name in self._aliases.items() if name in columns}
            if start is None:
                raw = self._time.formula(columns)
                start = float(raw.flat[0]) if self.foreign.document.time.relative else 0.0
                self.origin = self._counted + self._time.factor * start
            made = self._block(names, columns, start, last, len(block))
            if self._rate:
                made[:, [i for i, name in enumerate(names) if name == "t"]] = (
                    (count + np.arange(len(block))) / self._rate
                )[:, None]
            count += len(block)
            yield made

    def _block(
        self,
        wanted: tuple[str, ...],
        columns: dict[str, Array],
        start: float,
        last: dict[Signal, float],
        rows: int,
    ) -> Array:
        # The first stamp is taken off before the unit: nanoseconds of an epoch have no digits to spare.
        t = np.broadcast_to(self._time.factor * (self._time.formula(columns) - start), (rows,))
        result = np.empty((rows, len(wanted)))
        coupled: dict[str, Array] = {}
        for i, name in enumerate(wanted):
            if name == "t":
                result[:, i] = t
            elif (kind := _kind(name)) in self._groups:
                if kind not in coupled:
                    table = [
                        np.broadcast_to(self._signals[m](columns, last), t.shape) for m in self._groups[kind]
                    ]
                    coupled[kind] = self._uncoupled(kind, np.stack(table, axis=1))
                result[:, i] = coupled[kind][:, self._groups[kind].index(name)]
            else:
                result[:, i] = self._signals[name](columns, last)
        return result

    def _members(self, name: str) -> list[str]:
        if name == "t":
            return []
        return self._groups.get(_kind(name), [name])

    def _uncoupled(self, kind: str, table: Array) -> Array:
        assert self._coupling is not None
        matrix, offset = self._coupling
        if kind in ("tau", "taum"):
            return np.asarray(table @ matrix)
        result = np.asarray(np.linalg.solve(matrix, table.T).T, dtype=np.float64)
        return np.asarray(result + offset) if kind == "q" else result

    def _joint(self, k: int, joint: JointModel) -> None:
        """The signals of one joint."""
        path: list[str | int] = ["joints", k]
        coordinate = self.arm.coordinate_units[k]
        motor = joint.position.side == "motor"
        unit = self.drives[k].unit if motor else coordinate
        name = f"{'qm' if motor else 'q'}{k + 1}"
        known, stroke = units.POSITIONS[unit], self.drives[k].of_length if motor else None
        if stroke is not None:
            known = {**known, **{name: stroke[0] * metres for name, metres in units.LENGTHS.items()}}
        place = self._signal(joint.position, known, [*path, "position"])
        if stroke is not None and joint.position.unit in units.LENGTHS:
            place = replace(place, offset=place.offset + stroke[1])
        wrap = self.foreign.positive(joint.position.wrap, [*path, "position", "wrap"])
        factor = abs(known[joint.position.unit])
        self._signals[name] = place if wrap is None else replace(place, wrap=factor * wrap)
        for kind, model, known in (
            ("dq", joint.velocity, units.VELOCITIES[coordinate]),
            ("ddq", joint.acceleration, units.ACCELERATIONS[coordinate]),
            ("temperature", joint.temperature, units.TEMPERATURES),
        ):
            if model is not None:
                key = {"dq": "velocity", "ddq": "acceleration"}.get(kind, kind)
                self._signals[f"{kind}{k + 1}"] = self._signal(model, known, [*path, key])
        if joint.effort is not None:
            self._effort(k, joint, [*path, "effort"])

    def _effort(self, k: int, joint: JointModel, path: list[str | int]) -> None:
        assert joint.effort is not None
        effort, drive = joint.effort, self.drives[k]
        described = self.arm.joints[self.arm.coordinates[k]]
        kind = units.EFFORTS[effort.unit][0]
        factors = {name: factor for name, (_, factor) in units.EFFORTS.items()}
        at_motor = effort.side == "motor" and drive.driven
        if kind == "current" and not drive.driven:
            raise self.foreign.error(
                f"found a current, but joint {described.name} has no drive: describe the drive, or scale the "
                "current to a torque",
                path,
            )
        if kind in ("torque", "force"):
            actuator = at_motor and drive.of_length is not None
            expected = "force" if actuator or (described.type == "prismatic" and not at_motor) else "torque"
            if kind != expected:
                raise self.foreign.error(
                    f"found the unit '{effort.unit}', expected a {expected}'s for joint {described.name}",
                    [*path, "unit"],
                )
        prefix = (
            "i"
            if kind == "current"
            else "u"
            if kind in ("duty", "voltage")
            else "taum"
            if at_motor
            else "tau"
        )
        name = f"{prefix}{k + 1}"
        self._signals[name] = self._signal(effort, factors, path)
        self.effort_units[name] = units.EFFORT_UNITS[kind]
        if prefix == "u":
            what = "duty cycle" if kind == "duty" else "voltage"
            self._remarks.append(
                f"{described.name}: the effort is a {what} [{units.EFFORT_UNITS[kind]}]: back-EMF sits in "
                "the viscous friction, and every parameter is per that unit"
            )

    def _couple(self, n: int) -> None:
        """Groups of columns that the coupling mixes; every joint must have them."""
        kinds = {_kind(name) for name in self._signals} - {"temperature"}
        # Currents and voltages first: with one among torques, that is the mistake.
        for kind in sorted(kinds, key=lambda kind: (kind not in ("i", "u"), kind)):
            names = [f"{kind}{k}" for k in range(1, n + 1)]
            absent = [name for name in names if name not in self._signals]
            if kind in ("i", "u"):
                raise self.foreign.error(
                    "efforts pass a coupling as torques or forces: scale currents by the torque constants",
                    ["coupling"],
                    key=True,
                )
            if absent:
                k = int(absent[0].removeprefix(kind)) - 1
                raise self.foreign.error(
                    f"a coupling mixes the joints: found no {absent[0]}, expected the same signals and "
                    "sides for all of them",
                    ["joints", k],
                )
            self._groups[kind] = names

    def _signal(self, model: ColumnModel, known: Mapping[str, float], path: list[str | int]) -> Signal:
        factor = self.foreign.unit(model.unit, known, path)
        scale = self.foreign.number(model.scale, [*path, "scale"])
        offset = self.foreign.number(model.offset, [*path, "offset"])
        if scale == 0.0:
            raise self.foreign.error("found 0, expected a scale other than 0", [*path, "scale"])
        made = self._formula(model.column, [*path, "column"])
        return Signal(made, factor * scale, factor * offset, bits=model.bits)

    def _formula(self, text: str, path: Steps) -> Formula:
        try:
            return formula(text, self._columns)
        except FormulaError as error:
            if text.startswith("/") or text.replace("_", "a").isalnum():
                raise self.foreign.error(self._no_column(text), path) from None
            raise self.foreign.error(f"found {describe(text)}: {error}{self._there_are()}", path) from None

    def _no_column(self, name: str) -> str:
        near = suggest(name, self.reader.names).split("available: ")[0].rstrip(" (,")
        return f"found no column {describe(name)} in the log{near}{self._there_are()}"

    def _there_are(self) -> str:
        return f" (columns: {listed(self.reader.names)})"


def _kind(name: str) -> str:
    return name.rstrip("0123456789")
