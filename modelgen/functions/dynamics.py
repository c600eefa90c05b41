"""Expressions of the functions that take parameters, for any way of giving them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from modelgen.geometry import Frames
from modelgen.graph import Expr
from modelgen.graph.live import cost
from modelgen.model.articulated import accelerations
from modelgen.model.composite import mass_matrix as links_mass_matrix
from modelgen.model.composite import solve
from modelgen.model.dynamics import joint_efforts
from modelgen.model.effect_forces import EffectForces
from modelgen.model.energy import link_energies
from modelgen.model.equations import Equations
from modelgen.model.motion import Rates, link_motions
from modelgen.model.ports import Surroundings

_ARTICULATED_FROM = 8  # joints; of fewer, articulated bodies take more operations in every shape


@dataclass(frozen=True)
class Dynamics:
    """The equations with values for all standard parameters (zeros where grouped away)."""

    equations: Equations
    values: Sequence[Expr]

    def cheapest(self, form: Callable[[Frames], list[Expr]]) -> list[Expr]:
        """The form whose frames make it cheaper: common factors put outside of what is turned, or not."""
        e = self.equations
        forms = [form(frames) for frames in (e.frames, e.frames_factored)]
        return min(forms, key=lambda outputs: cost(e.graph, outputs))

    def inverse_dynamics(self, dq: Sequence[Expr], ddq: Sequence[Expr]) -> list[Expr]:
        """Input by coordinate."""
        e = self.equations
        rates = Rates(dq, ddq)
        effects = EffectForces(e, rates, self.values)
        added = effects.inputs()

        def form(frames: Frames) -> list[Expr]:
            efforts = joint_efforts(frames, link_motions(frames, rates), e.link_values(self.values))
            return effects.required(
                [
                    effort * drive.inverse_gain + extra
                    for effort, drive, extra in zip(efforts, e.drives, added, strict=True)
                ]
            )

        return self.cheapest(form)

    def joint_efforts(self, dq: Sequence[Expr], ddq: Sequence[Expr]) -> list[Expr]:
        """Efforts of the drives at the joints [N m or N], K times the inputs of ideal drives."""
        e = self.equations
        rates = Rates(dq, ddq)
        added = EffectForces(e, rates, self.values).efforts()

        def form(frames: Frames) -> list[Expr]:
            efforts = joint_efforts(frames, link_motions(frames, rates), e.link_values(self.values))
            return [effort + extra for effort, extra in zip(efforts, added, strict=True)]

        return self.cheapest(form)

    def mass_matrix(self, dq: Sequence[Expr] | None = None) -> list[list[Expr]]:
        """n x n, drives included [kg m^2, kg m, kg], at the speeds `dq`, at rest by default."""
        e = self.equations
        links = links_mass_matrix(e.frames, e.link_values(self.values))
        effects = EffectForces(e, Rates(dq or e.zeros(), e.zeros()), self.values).masses()
        return [[a + b for a, b in zip(*rows, strict=True)] for rows in zip(links, effects, strict=True)]

    def forward_dynamics(self, dq: Sequence[Expr], given: Sequence[Expr]) -> tuple[list[Expr], list[Expr]]:
        """Joint accelerations for the inputs `given`, and what must be positive: see `solve`.

        By the mass matrix or by articulated bodies, whichever is cheaper.
        """
        e = self.equations
        rates = Rates(dq, e.zeros())
        effects = EffectForces(e, rates, self.values)
        added = effects.efforts()
        ideal = effects.effective(given)
        matrix = self.mass_matrix(dq)
        links = e.link_values(self.values)
        found: list[tuple[list[Expr], list[Expr]]] = []
        motions = []
        for frames in (e.frames, e.frames_factored):
            motions.append((frames, link_motions(frames, rates)))
            efforts = joint_efforts(*motions[-1], links)
            right = [
                i * gain - (effort + extra)
                for i, gain, effort, extra in zip(ideal, self.gains(), efforts, added, strict=True)
            ]
            found.append(solve(matrix, right))
        masses = effects.masses()
        apart = all(m.is_zero for k, row in enumerate(masses) for m in (*row[:k], *row[k + 1 :]))
        if e.n >= _ARTICULATED_FROM and apart:
            at_joints = [i * gain - extra for i, gain, extra in zip(ideal, self.gains(), added, strict=True)]
            drives = [row[k] for k, row in enumerate(masses)]
            for frames, moving in motions:
                found.append(accelerations(frames, moving, links, at_joints, drives))
        return min(found, key=lambda pair: cost(e.graph, [*pair[0], *pair[1]]))

    def loads(self) -> list[Expr]:
        """Forces at the motor coordinates that the links' weight takes."""
        e = self.equations
        around = Surroundings(e.frames, Rates(e.zeros(), e.zeros()), e.link_values(self.values))
        weights = [around.weight(n) or e.graph.zero for n in range(e.n)]
        return [
            weight * (drive.inverse_gain * drive.transmission.torque_constant)
            for weight, drive in zip(weights, e.drives, strict=True)
        ]

    def effects_step(self, dq: Sequence[Expr], ddq: Sequence[Expr], dt: Expr) -> list[Expr]:
        """States of the effects after dt."""
        return EffectForces(self.equations, Rates(dq, ddq), self.values).steps(dt)

    def gains(self) -> list[Expr]:
        """K, joint effort per input, by coordinate."""
        return [drive.k1 * drive.transmission.torque_constant for drive in self.equations.drives]

    def energy(self, dq: Sequence[Expr]) -> tuple[Expr, Expr]:
        """Kinetic and potential energy [J], drives and springs included."""
        e = self.equations
        rates = Rates(dq, e.zeros())
        kinetic, potential = link_energies(e.frames, rates, e.link_values(self.values))
        effects = EffectForces(e, Rates(e.zeros(), e.zeros()), self.values)
        for n, row in enumerate(effects.masses(stored=True)):
            for m, mass in enumerate(row[: n + 1]):
                half = 0.5 if m == n else 1.0
                kinetic = kinetic + mass * (dq[n] * dq[m]) * half
        return kinetic, potential + effects.potential()
