"""Run-time geometry, given sines and cosines, row-wise gains, identified parameters."""

from dataclasses import replace
from functools import cache

import numpy as np
import pytest
from firmware.states import monitor_state
from numpy.random import default_rng
from witness.arms import ARMS, Emitted, build, random_arm, shipped
from witness.bodies import random_bodies
from witness.compare import agree
from witness.geometry import moving
from witness.levers import Drive
from witness.mechanism import Mechanism, states
from witness.program import run

from modelgen.base_parameters import group
from modelgen.description import Arm, Joint, LeveredDrive, geometry_symbol
from modelgen.errors import InputError
from modelgen.functions import STATUS_PIVOT, STATUS_STROKE, Function, Options
from modelgen.model.equations import Equations

NAMES = ["ariane4", "ariane4_free", "ariane6", "rx90", "scara", "two_fingers"]
EACH = [pytest.param(name, marks=pytest.mark.xdist_group(name)) for name in NAMES]
each_arm = pytest.mark.parametrize("name", EACH)


class Case:
    """An arm with random parameters at random states."""

    def __init__(self, name: str) -> None:
        self.folded = shipped(name)
        self.arm = self.folded.arm
        mechanism = Mechanism(self.arm)
        rng = np.random.default_rng(17)
        self.standard = mechanism.standard(random_bodies(self.arm, rng), rng)
        self.base = self.folded.base(self.standard)
        self.q, self.dq, self.ddq = states(self.arm, 5)
        self.given = self.folded("inverse_dynamics", self.q, self.dq, self.ddq, self.base)

    def inputs(self, function: Function) -> dict[str, np.ndarray]:
        """All inputs of a function by name."""
        suffix = function.name.endswith("_standard") or function.name == "effects_step"
        motor = self.folded("motor_from_joint", self.q, self.dq, self.ddq)
        known = {"q": self.q, "dq": self.dq, "ddq": self.ddq, "input": self.given}
        known |= dict(zip(("q_m", "dq_m", "ddq_m"), motor, strict=True))
        known |= {"dq_r": self.dq[::-1], "ddq_r": self.ddq[::-1]}
        known |= {"sin_q": np.sin(self.q), "cos_q": np.cos(self.q)}
        known |= {"parameters": self.standard if suffix else self.base}
        known |= {"dt": np.array([1e-3]), "gain": np.full_like(self.dq, 20.0), "forgetting": np.array([0.99])}
        for a in function.arguments:
            if a.name.endswith("state"):
                monitored = a.length == "N_MONITOR_STATES"
                known[a.name] = monitor_state(a.size, default_rng(3)) if monitored else 0.1 * self.dq
        return {a.name: known[a.name] for a in function.arguments if a.name != "geometry"}


def flat(found: object) -> np.ndarray:
    """Outputs side by side, one row a sample."""
    parts = found if isinstance(found, tuple) else (found,)
    return np.hstack([np.reshape(part, (len(part), -1)) for part in parts])


# -- run-time geometry -----------------------------------------------------------------------


@cache
def calibrated(name: str) -> Emitted:
    return shipped(name, "runtime_geometry")


def geometry(emitted: Emitted) -> np.ndarray:
    return np.array([float(emitted.arm.symbols[key]) for key in emitted.model.geometry])


@each_arm
def test_run_time_geometry_at_its_nominal_values_changes_nothing(name: str) -> None:
    case, free = Case(name), calibrated(name)
    assert free.functions.keys() == case.folded.functions.keys()
    levers = [i for i in moving(case.arm) if isinstance(case.arm.joints[i].drive, LeveredDrive)]
    for i in levers:
        for key in ("l1", "l2", "length0", "length1", "offset"):
            assert f"{key}_{i + 1}" in free.model.geometry
    assert set(case.arm.symbols) <= set(free.model.geometry)
    if not free.model.geometry:
        return
    for function in free.functions.values():
        given = case.inputs(case.folded.functions[function.name])
        found = free(function.name, **given, geometry=geometry(free))
        agree(flat(found), flat(case.folded(function.name, **given)))


def rebuilt(name: str, factors: dict[str, float]) -> Arm:
    """The arm with other levers and lengths written into its description."""
    arm = ARMS[name]
    joints = list(arm.joints)
    for n, joint in enumerate(joints, 1):
        if isinstance(joint.drive, LeveredDrive) and joint.moving:
            low, high = joint.drive.length
            drive = replace(
                joint.drive,
                l1=joint.drive.l1 * factors[f"l1_{n}"],
                l2=joint.drive.l2 * factors[f"l2_{n}"],
                length=(low * factors[f"length0_{n}"], high * factors[f"length1_{n}"]),
                offset=joint.drive.offset * factors[f"offset_{n}"],
            )
            joints[n - 1] = replace(joint, drive=drive)
    symbols = {key: value * factors[key] for key, value in arm.symbols.items()}
    return replace(arm, joints=tuple(joints), symbols=symbols)


@pytest.mark.parametrize("name", EACH[:3])
def test_run_time_geometry_at_other_values_is_another_arm(name: str) -> None:
    case, free = Case(name), calibrated(name)
    rng = np.random.default_rng(6)
    factors = {key: float(rng.uniform(0.998, 1.002)) for key in free.model.geometry}
    arm = rebuilt(name, factors)
    fresh = build(arm, Options())
    changed = geometry(free) * [factors[key] for key in free.model.geometry]
    shift = np.abs(flat(case.folded("drive_gain", case.q)) - flat(fresh("drive_gain", case.q)))
    assert shift.max() > 1e-4  # it is another arm
    # base parameters are those of the new lengths
    names = [b.name for b in fresh.model.grouping.base]
    assert names == [b.name for b in free.model.grouping.base]
    base = fresh.base(case.standard)
    for function in free.functions.values():
        given = case.inputs(fresh.functions[function.name])
        if "parameters" in given and len(given["parameters"]) == len(base):
            given["parameters"] = base
        agree(
            flat(free(function.name, **given, geometry=changed)),
            flat(fresh(function.name, **given)),
        )
    # and its drives are those of the points of the mechanism
    gains = [Drive(arm, i).gain(case.q[:, k]) for k, i in enumerate(moving(arm))]
    agree(free("drive_gain", case.q, geometry=changed), np.stack(gains, axis=1))


@pytest.mark.parametrize("name", ["drive_gain", "gravity", "motor_from_joint", "forward_dynamics"])
@pytest.mark.parametrize("rev", [1, -1])
def test_with_run_time_geometry_the_stroke_is_guarded_in_the_program(rev: int, name: str) -> None:
    """Folded: a range of q. At run time: what is positive on the stroke and on the lever's side."""
    lever = LeveredDrive(0.323, 0.058, (0.2679, 0.3684), (0.0, 2e4), rev, 0.4, 4e-3)
    arm = Arm("one", (Joint("j1", "revolute", drive=lever),), (None,), (9.81, 0.0, 0.0))
    free, folded = build(arm, Options(runtime_geometry=True)), build(arm, Options())
    assert free.functions[name].ranges == ()
    assert len(folded.functions[name].ranges) == 1
    low, high = Drive(arm, 0).span() or (0.0, 0.0)
    given = {a.name: [1.0] * a.size for a in free.functions[name].arguments}
    given["geometry"] = list(geometry(free))

    def trespasses(q: float) -> int:
        found = run(free.functions[name].program, {**given, "q": [q]}).guards
        values = [value for bit, value in found if bit == STATUS_STROKE]
        assert len(values) == 2
        return sum(not value > 0 for value in values)

    for q in (low + 1e-3, (low + high) / 2, high - 1e-3):
        assert trespasses(q) == 0
        assert trespasses(2 * lever.offset - q) == 1  # the same length, on the other side
    assert trespasses(low - 0.03) == trespasses(high + 0.03) == 1


def test_with_run_time_geometry_a_triangle_that_does_not_close_is_guarded() -> None:
    free = calibrated("ariane4")
    assert len(free.functions["joint_from_motor"].ranges) == 3  # the stroke in increments is no geometry
    motor = {"q_m": [10000.0, 3000.0, 10000.0], "dq_m": [0.0] * 3, "ddq_m": [0.0] * 3}
    program = free.functions["joint_from_motor"].program
    values = dict(zip(free.model.geometry, geometry(free), strict=True))

    def open_ones(**changed: float) -> list[int]:
        given = {**motor, "geometry": list({**values, **changed}.values())}
        guards: list[tuple[int, float]] = []
        try:
            guards = run(program, given).guards
        except (ValueError, ZeroDivisionError):  # past the guard, where C has returned
            return [-1]
        assert [bit for bit, _ in guards] == [STATUS_STROKE] * 3
        return [k for k, (_, value) in enumerate(guards) if not value > 0]

    assert open_ones() == []
    assert open_ones(l2_2=0.2) in ([1], [-1])
    assert open_ones(l1_1=0.5) in ([0], [-1])


def test_forward_dynamics_guards_every_pivot() -> None:
    case = Case("ariane4_free")
    function = case.folded.functions["forward_dynamics"]
    given = {key: list(value[0]) for key, value in case.inputs(function).items() if key != "parameters"}
    good = run(function.program, {**given, "parameters": list(case.base)})
    # Every pivot from the last joint on, then the least of what all but the first exceed 1e-9 of their
    # diagonal element by; the product of the pivots is the determinant of the mass matrix.
    assert [bit for bit, _ in good.guards] == [STATUS_PIVOT] * (4 + 1)
    *pivots, left = [value for _, value in good.guards]
    mass = case.folded("mass_matrix", q=np.array(given["q"]), parameters=case.base).reshape(4, 4)
    assert np.prod(pivots) == pytest.approx(np.linalg.det(mass), rel=1e-9)
    exceeded = [x - 1e-9 * mass[k, k] for x, k in zip(pivots[1:], (2, 1, 0), strict=True)]
    assert left == pytest.approx(min(exceeded), rel=1e-12)
    assert min(*pivots, left) > 0
    weightless = run(function.program, {**given, "parameters": list(-case.base)})
    assert any(value < 0 for _, value in weightless.guards)


# -- sines and cosines as inputs -------------------------------------------------------------


@each_arm
def test_given_sines_and_cosines_change_nothing(name: str) -> None:
    case, given_pairs = Case(name), shipped(name, "sincos")
    for function in given_pairs.functions.values():
        names = [a.name for a in function.arguments]
        if "q" in names:
            first = names.index("q")
            assert names[first : first + 3] == ["q", "sin_q", "cos_q"]
        if function.name not in ("joint_from_motor", "motor_from_joint"):
            assert function.operations["trig"] == 0
        found = flat(given_pairs(function.name, **case.inputs(function)))
        agree(found, flat(case.folded(function.name, **case.inputs(case.folded.functions[function.name]))))


# -- row-wise gains --------------------------------------------------------------------------


@cache
def row_wise(name: str) -> Emitted:
    return shipped(name, "row_wise")


def owners(emitted: Emitted) -> np.ndarray:
    """Row that each base parameter belongs to, by its name."""
    return np.array([int(b.name.rpartition("_row")[2]) - 1 for b in emitted.model.grouping.base])


@each_arm
def test_rows_with_consistent_parameters_are_the_known_ones(name: str) -> None:
    case, rows = Case(name), row_wise(name)
    stacked = rows.base(case.standard)
    agree(rows("inverse_dynamics", case.q, case.dq, case.ddq, stacked), case.given)
    agree(rows("regressor", case.q, case.dq, case.ddq) @ stacked, case.given)
    for function in ("gravity", "bias"):
        motion = (case.q,) if function == "gravity" else (case.q, case.dq)
        expected = case.folded(function, *motion, case.base)
        agree(rows(function, *motion, stacked) + case.given, expected + case.given)
    adaptive = (case.q, case.dq, case.dq[::-1], case.ddq)
    agree(
        rows("slotine_li_regressor", *adaptive) @ stacked,
        case.folded("slotine_li_regressor", *adaptive) @ case.base,
    )


@each_arm
def test_each_row_has_its_own_columns_and_no_others(name: str) -> None:
    case, rows = Case(name), row_wise(name)
    owner = owners(rows)
    n = case.q.shape[1]
    assert list(owner) == sorted(owner)
    assert set(owner) == set(range(n))
    columns = rows("regressor", case.q, case.dq, case.ddq)
    for row in range(n):
        assert not columns[:, row, owner != row].any()
        assert (np.abs(columns[:, row, owner == row]).max(axis=0) > 0).all()
    table = rows.model.packed
    assert all(owner[column] == row for row, column in zip(table.rows, table.columns, strict=True))


@each_arm
def test_a_rows_scale_is_its_own(name: str) -> None:
    """A torque constant that is wrong by a factor scales one block and one input, nothing else."""
    case, rows = Case(name), row_wise(name)
    stacked, owner = rows.base(case.standard), owners(rows)
    scales = np.random.default_rng(2).uniform(0.5, 2, case.q.shape[1])
    scaled = rows("inverse_dynamics", case.q, case.dq, case.ddq, stacked * scales[owner])
    agree(scaled, case.given * scales)


def test_row_wise_parameters_have_no_mass_matrix() -> None:
    rows = row_wise("ariane4")
    assert not {"mass_matrix", "forward_dynamics", "energy"} & rows.functions.keys()
    assert {"mass_matrix_standard", "forward_dynamics_standard", "energy_standard"} <= rows.functions.keys()
    assert any("row-wise" in remark for remark in rows.model.remarks)
    with pytest.raises(InputError, match="row-wise"):
        build(ARMS["gravity_arm"], Options(gains="row_wise", identified={"ZZ1R": 1.0}))


def test_estimated_gains_leave_the_functions_and_name_the_unknowns() -> None:
    estimated = build(ARMS["ariane4"], Options(gains="estimated"))
    known = shipped("ariane4")
    assert [f.program for f in estimated.model.functions] == [f.program for f in known.model.functions]
    assert any("gamma1, gamma2, gamma3" in remark for remark in estimated.model.remarks)


# -- identified parameters -------------------------------------------------------------------

FOLDED = ["inverse_dynamics", "gravity", "bias", "mass_matrix", "forward_dynamics", "energy"]


@pytest.mark.parametrize("name", EACH[:2])
def test_identified_parameters_are_folded_in(name: str) -> None:
    case = Case(name)
    names = [base.name for base in case.folded.model.grouping.base]
    fixed = build(ARMS[name], Options(identified=dict(zip(names, case.base, strict=True))))
    for function in FOLDED:
        given = case.inputs(case.folded.functions[function])
        parameters = given.pop("parameters")
        found = flat(fixed(f"{function}_identified", **given))
        agree(found, flat(case.folded(function, **given, parameters=parameters)))
        counts = [sum(e.functions[f].operations.values()) for e, f in (
            (fixed, f"{function}_identified"), (fixed, function)
        )]  # fmt: skip
        assert counts[0] <= counts[1]


def test_identified_parameters_must_be_those_of_the_arm() -> None:
    names = [base.name for base in group(Equations(ARMS["gravity_arm"])).base]
    values = dict.fromkeys(names, 1.0)
    del values["MY1"]
    with pytest.raises(InputError, match="missing MY1"):
        build(ARMS["gravity_arm"], Options(identified=values))
    with pytest.raises(InputError, match="unknown MY9"):
        build(ARMS["gravity_arm"], Options(identified={**values, "MY1": 0.0, "MY9": 1.0}))


# -- random arms, options together ------------------------------------------------------------

MIXES = {
    "geometry": Options(runtime_geometry=True),
    "both": Options(runtime_geometry=True, sincos=True),
    "rows": Options(runtime_geometry=True, gains="row_wise"),
}


def symbolic(arm: Arm, seed: int) -> Arm:
    """The arm with angles and lengths of one joint in symbols."""
    joints = list(arm.joints)
    i = seed % len(joints)
    joint = joints[i]
    symbols = dict(arm.symbols) | {"tilt": 0.7, "turn": 0.4, "lift": 0.21}
    joints[i] = replace(
        joint,
        alpha=geometry_symbol("tilt"),
        gamma=2 * geometry_symbol("turn") if joint.gamma else 0.0,
        b=geometry_symbol("lift") if joint.b else 0.0,
        theta=geometry_symbol("turn") + 0.1,
    )
    return replace(arm, joints=tuple(joints), symbols=symbols)


@pytest.mark.parametrize("mix", MIXES)
@pytest.mark.parametrize("seed", range(12))
def test_random_arms_with_options_together(seed: int, mix: str) -> None:
    """Half of them driven, half of them with symbols everywhere, against the witnesses."""
    arm = random_arm(seed, dressed=seed % 2 == 0)
    if not arm.fluid_density and seed % 2:
        arm = symbolic(arm, seed)
    mechanism = Mechanism(arm)
    rng = np.random.default_rng(1)
    standard = mechanism.standard(random_bodies(arm, rng), rng)
    q, dq, ddq = states(arm, 5)
    expected = mechanism.regressor(q, dq, ddq) @ standard
    emitted = build(arm, MIXES[mix])
    motion = {"q": q, "dq": dq, "ddq": ddq}
    more = {"geometry": geometry(emitted)} if emitted.model.geometry else {}
    if MIXES[mix].sincos:
        more |= {"sin_q": np.sin(q), "cos_q": np.cos(q)}
    base = emitted.base(standard)
    agree(emitted("inverse_dynamics", **motion, **more, parameters=base), expected)
    agree(emitted("regressor", **motion, **more) @ base, expected)
    agree(emitted("regressor_standard", **motion, **more) @ standard, expected)
    forward = emitted("forward_dynamics_standard", q=q, dq=dq, input=expected, **more, parameters=standard)
    agree(forward, ddq)


# -- the rest --------------------------------------------------------------------------------


def test_an_unknown_link_of_the_jacobian_is_named() -> None:
    with pytest.raises(InputError, match="no link hand for the Jacobian; links: j1, j2"):
        build(ARMS["gravity_arm"], Options(jacobian_link="hand"))


@each_arm
def test_inputs_and_outputs_are_those_promised(name: str) -> None:
    """Names and their order."""
    emitted = shipped(name)
    n, p = len(emitted.arm.coordinates), len(emitted.model.grouping.base)
    signatures = {
        "inverse_dynamics": ["q", "dq", "ddq", "parameters"],
        "gravity": ["q", "parameters"],
        "bias": ["q", "dq", "parameters"],
        "regressor": ["q", "dq", "ddq"],
        "regressor_standard": ["q", "dq", "ddq"],
        "regressor_packed": ["q", "dq", "ddq"],
        "slotine_li_regressor": ["q", "dq", "dq_r", "ddq_r"],
        "mass_matrix": ["q", "parameters"],
        "forward_dynamics": ["q", "dq", "input", "parameters"],
        "energy": ["q", "dq", "parameters"],
        "forward_kinematics": ["q"],
        "jacobian": ["q"],
        "motor_from_joint": ["q", "dq", "ddq"],
        "joint_from_motor": ["q_m", "dq_m", "ddq_m"],
        "drive_gain": ["q"],
    }
    for function, inputs in signatures.items():
        assert [a.name for a in emitted.functions[function].arguments] == inputs
    shapes = {f.name: [(o.rows, o.columns) for o in f.outputs] for f in emitted.model.functions}
    assert shapes["regressor"] == shapes["slotine_li_regressor"] == [(n, p)]
    assert shapes["regressor_standard"] == [(n, len(emitted.model.standard))]
    assert shapes["regressor_packed"] == [(len(emitted.model.packed.rows), 1)]
    assert shapes["mass_matrix"] == [(n, n)]
    assert shapes["jacobian"] == [(6, n)]
    assert shapes["energy"] == [(1, 1), (1, 1)]
    assert shapes["forward_kinematics"] == [(4, 4)] * len(emitted.arm.joints)
