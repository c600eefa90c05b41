"""The dynamics with the direction of dry friction left open.

Dry friction is a set: at rest it takes any value between its limits of the two directions (Filippov 1988;
Glocker 2001). Every law is affine in sign(v). A `Contact` is one such v; the accelerations are then
free + dry @ s, with s the sign where the contact slides and a value in [-1, 1] where it sticks.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import sympy as sp

from modelgen.backends import NumpyFunction
from modelgen.base_parameters.rules import slid
from modelgen.description.objects import Arm, EffectUse
from modelgen.effects import TIME_STEP, AppliedEffect, Part, Variables, applied_effects
from modelgen.errors import InputError
from modelgen.functions import EVALUATED, Function, Model, build_model
from modelgen.functions.bare import bare
from modelgen.functions.dynamics import Dynamics
from modelgen.functions.parametric import base_values, standard_values
from modelgen.graph import Expr
from modelgen.model.composite import solve
from modelgen.model.effect_forces import EffectForces
from modelgen.model.equations import Equations
from modelgen.model.motion import Rates
from modelgen.numeric import Array

_DIRECTION = sp.Symbol("direction", real=True)
Modes = tuple[int, ...]  # of every contact: 1 or -1 sliding, 0 sticking
HELD = 1e-10  # of a contact's own compliance, that others leave it where they hold it; as in driver.c


@dataclass(frozen=True)
class Slip:
    """Functions of an arm that a simulation of dry friction needs.

    model: the arm without smoothing of dry friction. contacts: (c, n), a contact's velocity is its row times
    dq. names: of the contacts. accelerations: outputs free (n), then dry (n x c, row by row), of q, dq,
    input, parameters and what else the arm's effects read. rates: of the states, where there are any.
    standard: whether `parameters` are the standard ones. kinks: zero where a law bends: where play closes.
    """

    model: Model
    contacts: Array
    names: tuple[str, ...]
    accelerations: Function
    rates: Function | None
    standard: bool = False
    kinks: Function | None = None


def slip(arm: Arm, *, standard: bool = False) -> Slip:
    """The functions of `arm`, drives and effects included. Raises InputError as build_model does.

    standard: they take the standard parameters in place of the base parameters, which do not tell the
    inertia of an elastic joint's drive from that of its link.
    """
    model = build_model(unsmoothed(arm), EVALUATED)
    e = Equations(model.arm if standard else slid(model.arm))
    values = standard_values(e) if standard else base_values(e, model.grouping)
    suffix = "_standard" if standard else ""
    whole = list(e.effects)
    signs = _signs(e)
    rest, dry = _split(whole, e, signs)
    rates = Rates(e.vector("dq"), e.zeros())
    e.effects = rest
    dynamics = Dynamics(e, values)
    outputs, _ = dynamics.forward_dynamics(rates.dq, e.vector("input"))
    matrix = dynamics.mass_matrix(rates.dq)
    columns: list[list[Expr]] = []
    for effects in dry.values():
        e.effects = effects
        efforts = EffectForces(e, rates, values).efforts()
        columns.append(solve(matrix, [-x for x in efforts])[0])
    count = len(model.standard) if standard else len(model.grouping.base)
    outputs = [*outputs, *(column[n] for n in range(e.n) for column in columns)]
    e.effects = whole
    accelerations = bare(f"accelerations{suffix}", e, count, outputs)
    own = _state_rates(e, values, count, suffix) if e.state_names() else None
    rows = np.array([_row(key, e.n) for key in dry]).reshape(len(dry), e.n)
    names = tuple(_name(key, model.arm) for key in dry)
    return Slip(model, rows, names, accelerations, own, standard, _kinks(e, values, count, suffix))


def unsmoothed(arm: Arm) -> Arm:
    """The arm with dry friction that jumps where the velocity changes its sign."""

    def sharp(uses: Sequence[EffectUse]) -> tuple[EffectUse, ...]:
        return tuple(
            replace(use, values={k: v for k, v in use.values.items() if k != "smoothing"}) for use in uses
        )

    joints = tuple(replace(joint, effects=sharp(joint.effects)) for joint in arm.joints)
    return replace(arm, joints=joints, effects=sharp(arm.effects))


_Key = tuple[tuple[int, float], ...]  # (coordinate, factor): what a contact's velocity is made of


def _split(
    effects: Sequence[AppliedEffect], e: Equations, signs: Sequence[float]
) -> tuple[list[AppliedEffect], dict[_Key, list[AppliedEffect]]]:
    """The effects without their dry parts, and the dry parts by contact, per unit of its direction."""
    rest: list[AppliedEffect] = []
    dry: dict[_Key, list[AppliedEffect]] = {}
    for effect in effects:
        kept: list[Part] = []
        for part in effect.parts:
            x = part.variables
            if not isinstance(x, Variables):
                kept.append(part)
                continue
            forces = [f.xreplace({sp.sign(x.velocity): _DIRECTION}) for f in part.forces]
            slopes = [sp.diff(f, _DIRECTION) for f in forces]
            kept.append(replace(part, forces=tuple(f.xreplace({_DIRECTION: sp.S.Zero}) for f in forces)))
            if any(slopes):
                n = e.arm.coordinates.index(part.joint)
                key: _Key = ((n, 1.0),)
                if part.place == "pair":
                    key = ((n, 1.0), (int(effect.values["other"]) - 1, float(effect.values["ratio"])))
                sign = sp.Float(signs[n]) if part.place == "motor" else sp.S.One
                forces = [sign * slope for slope in slopes]
                own = replace(effect, parts=(replace(part, forces=tuple(forces)),), potential=sp.S.Zero)
                dry.setdefault(key, []).append(own)
        rest.append(replace(effect, parts=tuple(kept)))
    return rest, dry


def _signs(e: Equations) -> list[float]:
    """Which way each motor turns as its joint's coordinate grows; no lever changes that on its stroke."""
    values = NumpyFunction(bare("k1", e, 0, [drive.k1 for drive in e.drives]))
    given = {a.name: np.zeros(a.size) for a in values.function.arguments}
    for n, drive in enumerate(e.drives):
        span = drive.transmission.joint_range()
        given["q"][n] = 0.0 if span is None else (span[0] + span[1]) / 2
    return [float(x) for x in np.sign(values(**given))]


def _state_rates(e: Equations, values: Sequence[Expr], count: int, suffix: str) -> Function:
    """Time derivatives of the states: slopes of their steps where the step begins."""
    whole = e.effects
    e.effects = [
        replace(
            effect,
            steps={k: sp.diff(x, TIME_STEP).subs(TIME_STEP, 0) for k, x in effect.steps.items()},
        )
        for effect in whole
    ]
    forces = EffectForces(e, Rates(e.vector("dq"), e.vector("ddq")), values)
    function = bare(f"state_rates{suffix}", e, count, forces.steps(e.graph.input("dt", 0)))
    e.effects = whole
    return function


def _kinks(e: Equations, values: Sequence[Expr], count: int, suffix: str) -> Function | None:
    """Differences of what the smaller or larger one is taken of, in laws with states: a contact of play."""
    forces = EffectForces(e, Rates(e.vector("dq"), e.vector("ddq")), values)
    found: list[Expr] = []
    for effect in e.effects:
        for part in effect.parts[:1] if effect.states else ():
            choices = sorted({a for f in part.forces for a in f.atoms(sp.Max, sp.Min)}, key=str)
            found += [forces.in_graph(effect, part, a.args[0] - a.args[1]) for a in choices]
    return bare(f"kinks{suffix}", e, count, found) if found else None


def _row(key: _Key, n: int) -> list[float]:
    row = [0.0] * n
    for k, factor in key:
        row[k] = factor
    return row


def _name(key: _Key, arm: Arm) -> str:
    return " and ".join(arm.joints[arm.coordinates[n]].name for n, _ in key)


def elastic(arm: Arm) -> bool:
    """Whether a joint has play or bends."""
    return any(e.elastic for e in applied_effects(arm))


def hold(free: Array, dry: Array, rows: Array, modes: Modes) -> Array:
    """s (c,): the directions of sliding contacts, and what keeps the sticking ones from accelerating.

    Where more contacts stick than can move (two joints, and what turns with both), they share the load as
    evenly as can be: they stick as long as any share of it lets them. free: (n,), dry: (n, c), rows: (c, n).
    Raises InputError where sticking contacts have no friction.
    """
    s = np.array(modes, dtype=float)
    stuck = [k for k, mode in enumerate(modes) if mode == 0]
    if stuck:
        pull, matrix = rows[stuck] @ (free + dry @ s), rows[stuck] @ dry[:, stuck]
        if not np.diag(matrix).all():
            raise InputError(
                "a joint with dry friction in its description has none among its parameters; "
                "expected a positive value, or the effect left out"
            )
        alone = np.abs(rows[stuck]).sum(axis=0).max() <= 1.0  # no two along the same coordinate
        s[stuck] = -(np.linalg.solve(matrix, pull) if alone else _borne(matrix, pull))
    return s


def _borne(matrix: Array, right: Array) -> Array:
    """x with matrix x = right, as even as can be where there are many; eliminated as in driver.c."""
    own, count = np.abs(np.diag(matrix)), len(right)
    m = np.column_stack([matrix, right])
    at: list[int] = []  # columns that have a pivot, in the order of its rows
    for i in range(count):
        row = len(at)
        best = row + int(np.argmax(np.abs(m[row:, i]))) if row < count else 0
        if row < count and abs(m[best, i]) > HELD * own[i]:
            m[[row, best]] = m[[best, row]]
            m[row + 1 :] -= np.outer(m[row + 1 :, i] / m[row, i], m[row])
            at.append(i)
    x = _backwards(m, at, np.zeros(count), 1.0)
    for i in set(range(count)) - set(at):
        x = _shared(x, _backwards(m, at, np.eye(count)[i], 0.0))
    return x


def _backwards(m: Array, at: list[int], x: Array, right: float) -> Array:
    """x of the eliminated equations; it is given where a column has no pivot."""
    for row in reversed(range(len(at))):
        i = at[row]
        x[i] = (right * m[row, -1] - m[row, i + 1 : -1] @ x[i + 1 :]) / m[row, i]
    return x


def _shared(x: Array, z: Array) -> Array:
    """x + t z whose largest element is least: where two are alike, or one vanishes."""
    pairs = [(x[a], z[a]) for a in range(len(x))]
    pairs += [(x[a] + k * x[b], z[a] + k * z[b]) for a in range(len(x)) for b in range(a) for k in (-1, 1)]
    tried = [0.0, *(-left / slope for left, slope in pairs if slope)]
    best: float = min(tried, key=lambda t: float(np.abs(x + t * z).max()))
    return np.asarray(x + best * z)


def accelerated(free: Array, dry: Array, s: Array, modes: Modes, own: list[int]) -> Array:
    """Accelerations (n,): exactly zero where a joint sticks."""
    ddq = free + dry @ s
    for k, mode in enumerate(modes):
        if mode == 0 and own[k] >= 0:
            ddq[own[k]] = 0.0
    return ddq


def settled(free: Array, dry: Array, rows: Array, modes: Modes, at_rest: list[int]) -> Modes:
    """Modes of the contacts `at_rest`, which have no speed; those of the others stay.

    A complementarity problem: a contact that would have to pull beyond its limits slides, and one that
    slides has an acceleration of its own direction. Its matrix is that of a positive definite form times
    positive magnitudes, so that the solution is one (Cottle, Pang and Stone 1992); found by pivoting.
    """
    found = list(modes)
    able = [k for k in at_rest if rows[k] @ dry[:, k] < 0.0]
    for k in at_rest:
        # Without friction of its own a contact cannot stick.
        found[k] = 0 if k in able else (1 if rows[k] @ free >= 0.0 else -1)
    for _ in range(40 * max(1, len(found))):
        now = tuple(found)
        s = hold(free, dry, rows, now)
        a = rows @ (free + dry @ s)
        back = [k for k in able if found[k] and a[k] * found[k] < 0.0]
        if back:
            found[back[0]] = 0
            continue
        over = [k for k in able if not found[k] and abs(s[k]) > 1.0]
        if not over:
            break
        k = max(over, key=lambda k: abs(s[k]))
        found[k] = 1 if s[k] > 0 else -1
    return tuple(found)
