"""The external efforts by the arm's generalised momentum."""

from __future__ import annotations

from collections.abc import Sequence

from modelgen.functions.arguments import effort_units
from modelgen.functions.assembly import Assembly, vector
from modelgen.functions.dynamics import Dynamics
from modelgen.functions.objects import STATUS_INPUT, Function, InputRange
from modelgen.functions.parametric import WITH
from modelgen.functions.steps import stepping
from modelgen.geometry import Frames
from modelgen.graph import Expr
from modelgen.graph.differentiate import tangents
from modelgen.graph.live import cost
from modelgen.graph.vectors import dot
from modelgen.model.dynamics import joint_efforts
from modelgen.model.effect_forces import EffectForces
from modelgen.model.momentum import link_momenta
from modelgen.model.motion import Rates, link_motions

LARGEST_GAIN = 1e4  # 1/s
LONGEST_STEP = 1.0  # s


def momentum_observer(a: Assembly, dynamics: Dynamics, suffix: str, parameters: Sequence[str]) -> Function:
    """`momentum_observer_step` for one way of giving parameters (De Luca and Mattone 2003, 2005).

    external = gain (p - state), and the next state is state + dt (K input - friction - gravity + dT/dq
    + external): what acts on the arm from outside through a low pass of the bandwidth `gain`, without any
    acceleration.
    """
    e, n = dynamics.equations, a.n
    graph = e.graph
    dt = graph.input("dt", 0)
    gains, before = e.vector("gain"), e.vector("observer_state")
    momenta, forces = momentum_and_forces(dynamics)
    external = [k * (p - s) for k, p, s in zip(gains, momenta, before, strict=True)]
    after = [s + dt * (f + r) for s, f, r in zip(before, forces, external, strict=True)]
    efforts = effort_units(e.arm)
    function = a.function(
        f"momentum_observer_step{suffix}",
        "External efforts at the joints by the generalised momentum, with a delay of 1 / gain; state: zero "
        f"at first, then what the step before gave; {WITH[suffix]}.",
        ["q", "dq", "input", "dt", "gain", *parameters, "observer_state"],
        [
            (a.of_state("observer_state"), after),
            (vector("external", n, efforts, "efforts that act on the arm from outside"), external),
        ],
        guards=[(1.0 - k * dt, STATUS_INPUT) for k in gains],
        ranges=[
            *(InputRange("gain", k, 0.0, LARGEST_GAIN, STATUS_INPUT) for k in range(n)),
            InputRange("dt", 0, 0.0, LONGEST_STEP, STATUS_INPUT),
        ],
    )
    return stepping(function, "observer_state")


def momentum_and_forces(dynamics: Dynamics) -> tuple[list[Expr], list[Expr]]:
    """p (n), and its derivative where nothing acts from outside (n), drives and effects included.

    What dry friction takes of accelerations is left out: it is no momentum.
    """
    e = dynamics.equations
    dq, zeros = e.vector("dq"), e.zeros()
    links = e.link_values(dynamics.values)
    effects = EffectForces(e, Rates(dq, zeros), dynamics.values)
    masses = EffectForces(e, Rates(zeros, zeros), dynamics.values).masses()
    own = [dot(row, dq) for row in masses]
    along = {("q", k): x for k, x in enumerate(dq)}
    along |= {("sin_q", k): e.graph.input("cos_q", k) * x for k, x in enumerate(dq)}
    along |= {("cos_q", k): -(e.graph.input("sin_q", k) * x) for k, x in enumerate(dq)}
    rates = tangents(own, [along])[0]
    inputs = effects.effective(e.vector("input"))
    added = effects.efforts()

    def form(frames: Frames) -> tuple[list[Expr], list[Expr]]:
        still = [frames.lag_rates.get(k, e.graph.zero) for k in range(e.n)]
        weights = joint_efforts(frames, link_motions(frames, Rates(still, zeros)), links)
        momenta, slopes = link_momenta(frames, Rates(dq, zeros), links)
        forces = [
            i * k + slope + rate - (weight + extra)
            for i, k, slope, rate, weight, extra in zip(
                inputs, dynamics.gains(), slopes, rates, weights, added, strict=True
            )
        ]
        return [p + x for p, x in zip(momenta, own, strict=True)], forces

    forms = [form(frames) for frames in (e.frames, e.frames_factored)]
    return min(forms, key=lambda found: cost(e.graph, [*found[0], *found[1]]))
