"""Expressions of the functions that take parameters, for any way of giving them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from modelgen.geometry import Frames
from modelgen.graph import Expr
from modelgen.graph.live import cost
from modelgen.model.composite import mass_matrix as links_mass_matrix
from modelgen.model.composite import solve
from modelgen.model.dynamics import joint_efforts
from modelgen.model.energy import link_energies
from modelgen.model.equations import Equations
from modelgen.model.motion import Rates, link_motions


@dataclass(frozen=True)
class Dynamics:
    """The equations with values for all standard parameters (zeros where grouped away)."""

    equations: Equations
    values: Sequence[Expr]

    def cheapest(self, form: Callable[[Frames], list[Expr]]) -> list[Expr]:
        """The form whose frames make it cheaper: common factors taken out of what is turned, or not."""
        e = self.equations
        forms = [form(frames) for frames in (e.frames, e.frames_factored)]
        return min(forms, key=lambda outputs: cost(e.graph, outputs))

    def inverse_dynamics(self, dq: Sequence[Expr], ddq: Sequence[Expr]) -> list[Expr]:
        """Input by coordinate."""
        e = self.equations
        rates = Rates(dq, ddq)
        added = e.effect_inputs(rates, self.values)

        def form(frames: Frames) -> list[Expr]:
            efforts = joint_efforts(frames, link_motions(frames, rates), e.link_values(self.values))
            return [
                effort * drive.inverse_gain + extra
                for effort, drive, extra in zip(efforts, e.drives, added, strict=True)
            ]

        return self.cheapest(form)

    def mass_matrix(self) -> list[list[Expr]]:
        """n x n, drives included [kg m^2, kg m, kg]."""
        e = self.equations
        matrix = links_mass_matrix(e.frames, e.link_values(self.values))
        for n, mass in enumerate(e.effect_masses(self.values)):
            matrix[n][n] = matrix[n][n] + mass
        return matrix

    def forward_dynamics(self, dq: Sequence[Expr], given: Sequence[Expr]) -> tuple[list[Expr], list[Expr]]:
        """Joint accelerations for the inputs `given`, and the pivots that must be positive."""
        e = self.equations
        rates = Rates(dq, e.zeros())
        added = e.effect_efforts(rates, self.values)
        matrix = self.mass_matrix()
        pivots: list[list[Expr]] = []

        def form(frames: Frames) -> list[Expr]:
            efforts = joint_efforts(frames, link_motions(frames, rates), e.link_values(self.values))
            right = [
                i * gain - (effort + extra)
                for i, gain, effort, extra in zip(given, self.gains(), efforts, added, strict=True)
            ]
            accelerations, found = solve(matrix, right)
            pivots.append(found)
            return accelerations

        return self.cheapest(form), pivots[0]

    def gains(self) -> list[Expr]:
        """K, joint effort per input, by coordinate."""
        return [drive.k1 * drive.transmission.torque_constant for drive in self.equations.drives]

    def energy(self, dq: Sequence[Expr]) -> tuple[Expr, Expr]:
        """Kinetic and potential energy [J], drives and springs included."""
        e = self.equations
        rates = Rates(dq, e.zeros())
        kinetic, potential = link_energies(e.frames, rates, e.link_values(self.values))
        for speed, mass in zip(dq, e.effect_masses(self.values), strict=True):
            kinetic = kinetic + mass * (speed * speed) * 0.5
        return kinetic, potential + e.effect_potential(self.values)
