"""What a file has of an arm's effects: put on its coordinates, and measured against the effects."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from modelgen.description.objects import Arm
from modelgen.effects import AppliedEffect, DescriptionEffect, LinkEffect, applied_effects
from modelgen.effects.applied import effect_class, uses
from modelgen.exporting.machine import POWERS, Axis, Coupling, Machine, Properties
from modelgen.exporting.states import Efforts, States, force, largest
from modelgen.importing.bodies import together
from modelgen.importing.robot import Body
from modelgen.numeric import Array

EXACT, APPROXIMATED, LEFT_OUT = "exact", "approximated", "left out"
SAME = 1e-9  # of the largest effort of an effect, that is arithmetic
WITH = {"rest": "stiffness", "wave": "sine"}  # what a format has where it has the other


@dataclass(frozen=True)
class Format:
    """What a format can say, and how it is written.

    laws: properties by the names of `Definition.simulated`, each with what it is called there. solved: those
    that a solver keeps, so that they differ about rest. levers: whether it has linear actuators; pairs: what
    turns with two joints. write: from the machine and the lines of a heading. remarks: what it cannot say
    besides.
    """

    name: str
    title: str
    laws: Mapping[str, str]
    solved: frozenset[str]
    levers: bool
    pairs: bool
    write: Callable[[Machine, Sequence[str]], str]
    remarks: Callable[[Machine], list[str]]


@dataclass(frozen=True)
class Row:
    """What a file has of one effect.

    joint: None for the whole arm. status: exact, approximated or left out. error: the largest at any joint
    over the sampled states, None where it was not computed. text: what stands for it, or why nothing does.
    """

    effect: str
    joint: str | None
    status: str
    error: float | None
    text: str
    unit: str = "N m"

    def cells(self) -> tuple[str, str, str, str, str]:
        """As text: effect, joint, status, largest error, what stands for it."""
        error = "" if self.error is None else "0" if self.error == 0.0 else f"{self.error:.2g} {self.unit}"
        return self.effect, self.joint or "arm", self.status, error, self.text


class Account:
    """Puts effects on the coordinates of a machine, row by row."""

    def __init__(
        self,
        arm: Arm,
        machine: Machine,
        states: States,
        values: Mapping[str, float],
        efforts: Efforts,
        to: Format,
    ) -> None:
        self.arm, self.machine, self.values = arm, machine, values
        self.states, self.efforts, self.to = states, efforts, to

    def rows(self) -> list[Row]:
        """One for each effect; the machine has its properties then."""
        found = []
        for effect in applied_effects(self.arm):
            slides = effect.joint is not None and self.machine.links[effect.joint].kind == "prismatic"
            found.append(replace(self._row(effect), unit="N" if slides else "N m"))
        return found

    def _row(self, effect: AppliedEffect) -> Row:
        name = effect.effect.name
        joint = None if effect.joint is None else self.machine.links[effect.joint].name
        missing = [p.name for p, symbol in effect.parameters if symbol.name not in self.values]
        if missing:
            return Row(name, joint, LEFT_OUT, None, f"no value for {' and '.join(missing)}")
        if isinstance(effect.effect, LinkEffect):
            masses = effect.effect.masses(effect.values)
            if masses:
                return Row(name, joint, EXACT, 0.0, "a part of the link's mass and inertia")
        numbers = self._numbers(effect)
        found = self._kept(effect, effect.effect.simulated(numbers))
        place = effect.parts[0].place
        if "lag" in found:
            self._axis(effect).input["lag"] = found["lag"]
            return Row(name, joint, EXACT, 0.0, self.to.laws["lag"])
        if "bristle" in found:
            self._axis(effect).alone.append((place, found))
            return Row(name, joint, EXACT, 0.0, self.to.laws["bristle"])
        measured = self.efforts.of(effect) if effect.parameters else []
        total = largest(measured) if measured else None
        if not found:
            return Row(name, joint, LEFT_OUT, total, f"{self.to.title} has nothing like it")
        modelled = self._put(effect, place, found)
        said = ", ".join(dict.fromkeys(self.to.laws[law] for law in found if law in self.to.laws))
        error = largest([efforts - modelled for efforts in measured])
        rest = [self._at_rest(effect, place, found[law]) for law in found if law in self.to.solved]
        if error <= SAME * (total or 0.0) + self.efforts.noise:
            error = 0.0
        worst = max([error, *rest])
        return Row(name, joint, EXACT if worst == 0.0 else APPROXIMATED, worst, said)

    def _numbers(self, effect: AppliedEffect) -> dict[str, float]:
        """All parameters of an effect by name."""
        linear = {p.name: self.values[symbol.name] for p, symbol in effect.parameters}
        return {name: float(value) for name, value in effect.values.items() if name not in linear} | linear

    def _axis(self, effect: AppliedEffect) -> Axis:
        assert effect.joint is not None
        axis = self.machine.links[effect.joint].axis
        assert axis is not None
        return axis

    def _kept(self, effect: AppliedEffect, properties: Mapping[str, float]) -> Properties:
        """Those that the format has at the place of the effect."""
        place = effect.parts[0].place
        known = set(self.to.laws) | {more for more, law in WITH.items() if law in self.to.laws}
        if place == "pair":
            known = known & {"rest", *POWERS} if self.to.pairs else set()
        elif place == "input":
            known &= {"lag"}
        elif place == "joint" and self._axis(effect).lever is not None and self.to.levers:
            known -= {"force"}
        elif place not in ("joint", "motor"):
            known = set()
        return {name: value for name, value in properties.items() if name in known}

    def _put(self, effect: AppliedEffect, place: str, properties: Properties) -> Array:
        """Add them to the machine; the efforts (N, n) that they then make there."""
        axis, s = self._axis(effect), self.states
        efforts: Array = np.zeros_like(s.q)
        if place == "pair":
            number, ratio = self._pair(effect)
            other = self.arm.coordinates[number]
            assert effect.joint is not None
            label = f"{self.machine.links[effect.joint].name}_{self.machine.links[other].name}"
            self.machine.couplings.append(Coupling(label, effect.joint, other, ratio, properties))
            of_pair = force(s.pair(axis.number, number, ratio), properties)
            efforts[:, axis.number], efforts[:, number] = of_pair, ratio * of_pair
            return efforts
        own = axis.at_joint if place == "joint" else axis.at_motor
        if "wave" in properties:
            axis.alone.append((place, properties))
            own = {}
        for name, value in properties.items():
            own[name] = value if name == "rest" else own.get(name, 0.0) + value
        signal = s.joint(axis.number) if place == "joint" else s.carried(axis, self.to.levers)
        efforts[:, axis.number] = signal.slope * force(signal, properties)
        return efforts

    def _pair(self, effect: AppliedEffect) -> tuple[int, float]:
        """Number from 0 of the other joint that turns it, and its own turns per turn of that."""
        pair = effect.effect.coupled(self._numbers(effect))
        assert pair is not None
        return pair[0] - 1, pair[1]

    def _at_rest(self, effect: AppliedEffect, place: str, friction: float) -> float:
        """Largest effort of dry friction at a joint."""
        axis = self._axis(effect)
        slope = self.states.carried(axis, self.to.levers).slope if place == "motor" else np.ones(1)
        if place == "pair":
            slope = np.array([1.0, self._pair(effect)[1]])
        return float(friction * np.abs(slope).max())


def described_rows(arm: Arm) -> list[Row]:
    """Effects that the description itself has."""
    return [
        Row(
            use.name,
            None if joint is None else arm.joints[joint].name,
            EXACT,
            0.0,
            "carried out in the geometry and the drives",
        )
        for use, joint in uses(arm)
        if issubclass(effect_class(use), DescriptionEffect)
    ]


def loaded(arm: Arm, bodies: Sequence[Body]) -> tuple[Body, ...]:
    """The bodies with the point masses that effects put on their links."""
    found = [[body] for body in bodies]
    for effect in applied_effects(arm):
        if isinstance(effect.effect, LinkEffect):
            for mass, place in effect.effect.masses(effect.values):
                at = np.array([float(x) for x in place])
                for link in effect.effect.links(arm, effect.joint):
                    found[link].append(Body(float(mass), at, np.zeros((3, 3))))
    return tuple(together(parts) if len(parts) > 1 else parts[0] for parts in found)
