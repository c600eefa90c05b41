"""Base parameters: how many, which, and that what is printed is what is computed."""

import functools
import math
import time
from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
import pytest
from witness.arms import (
    ARMS,
    RANDOM,
    RANDOM_LINKS,
    SHIPPED,
    SHIPPED_LINKS,
    Emitted,
    build,
    generated,
    random_arm,
    shipped,
)
from witness.bodies import random_bodies
from witness.compare import agree
from witness.formulas import factors, value
from witness.geometry import number
from witness.mechanism import Mechanism
from witness.oracle import efforts, span

from modelgen.base_parameters import BaseParameter, for_reading, group
from modelgen.description import (
    Arm,
    DirectDrive,
    EffectUse,
    Joint,
    LeveredDrive,
    NoDrive,
    geometry_symbol,
)
from modelgen.functions import Options
from modelgen.model.equations import Equations

each_arm = pytest.mark.parametrize("make", [*SHIPPED, *RANDOM])
each_with_and_without = pytest.mark.parametrize("make", [*SHIPPED, *SHIPPED_LINKS, *RANDOM, *RANDOM_LINKS])

# Links alone: ranks that published generators agree on.
LINKS = {"ariane4_free": 22, "ariane6": 36, "rx90": 36, "puma560": 36, "wam7": 43}
# With drive inertia, viscous and dry friction at every joint; a direct drive's inertia joins links' ones.
EFFECTS = ("IA", "FV", "FC", "FO", "FS", "KS", "KO")
DEFAULTS = {"ariane4": 24, "ariane4_free": 34, "ariane6": 54, "rx90": 52, "puma560": 52, "wam7": 62}


@functools.cache
def witness(make: Callable[[], Emitted]) -> tuple[np.ndarray, list[str]]:
    """Regressor of the witnesses, made once an arm."""
    return efforts(make().arm)


def expressions(emitted: Emitted) -> dict[str, str]:
    return {base.name: base.expression for base in emitted.model.grouping.base}


def grouped(emitted: Emitted) -> dict[str, dict[str, float]]:
    """Factors of every printed group."""
    names = [p.name for p in emitted.model.standard]
    return {k: factors(text, names, emitted.arm.symbols) for k, text in expressions(emitted).items()}


# -- how many --------------------------------------------------------------------------------


@pytest.mark.parametrize("name", LINKS)
def test_number_for_the_links_alone(name: str) -> None:
    assert len(shipped(name, "links").model.grouping.base) == LINKS[name]


@pytest.mark.parametrize("name", DEFAULTS)
def test_number_with_drives_and_their_effects(name: str) -> None:
    assert len(shipped(name).model.grouping.base) == DEFAULTS[name]


@each_with_and_without
def test_number_is_the_rank_of_the_witnesses_regressor(make: Callable[[], Emitted]) -> None:
    emitted = make()
    matrix, _ = witness(make)
    found = span(matrix.reshape(-1, matrix.shape[2]))
    assert found.next < 1e-12  # there is a gap
    assert found.last > 1e-8
    assert len(emitted.model.grouping.base) == found.rank


@pytest.mark.parametrize("seed", range(100, 140))
def test_number_for_more_random_arms(seed: int) -> None:
    """Without the functions: chains and trees with sliding, fixed and locked joints, levers, fluids."""
    arm = random_arm(seed, dressed=seed % 2 == 0)
    matrix, _ = efforts(arm)
    assert len(group(Equations(arm)).base) == span(matrix.reshape(-1, matrix.shape[2])).rank


# -- which -----------------------------------------------------------------------------------


def combination(arm: Arm, base: Sequence[BaseParameter], size: int) -> np.ndarray:
    """Base parameters = combination times standard parameters."""
    result = np.zeros((len(base), size))
    for k, parameter in enumerate(base):
        assert parameter.terms[0] == (parameter.representative, 1.0)
        for index, factor in parameter.terms:
            result[k, index] = number(arm, factor)
    return result


def hold(arm: Arm, base: Sequence[BaseParameter], matrix: np.ndarray, names: list[str]) -> None:
    """The base parameters tell all that `matrix` (rows x standard parameters) does: Y = Y_b B."""
    groups = combination(arm, base, len(names))
    leading = [parameter.representative for parameter in base]
    columns = matrix[:, leading] @ np.linalg.inv(groups[:, leading])
    gaps = np.abs(columns @ groups - matrix).max(axis=0)
    scale = np.abs(matrix).max(axis=0)
    links = [k for k, name in enumerate(names) if name[:2] not in EFFECTS]
    scale[links] = max(scale[links].max(), 1.0)  # a link's column may be rounding only
    assert (gaps <= 1e-9 * scale).all(), [names[k] for k in np.flatnonzero(gaps > 1e-9 * scale)]


@each_with_and_without
def test_groups_hold_for_every_standard_column(make: Callable[[], Emitted]) -> None:
    emitted = make()
    matrix, names = witness(make)
    hold(emitted.arm, emitted.model.grouping.base, matrix[:12].reshape(-1, len(names)), names)


@each_with_and_without
def test_what_has_no_effect_is_in_no_group_and_all_else_is(make: Callable[[], Emitted]) -> None:
    emitted = make()
    grouping = emitted.model.grouping
    used = {k for base in grouping.base for k, factor in base.terms if factor != 0}
    assert used.isdisjoint(grouping.without_effect)
    assert used | set(grouping.without_effect) == set(range(len(emitted.model.standard)))
    matrix, _ = witness(make)
    sizes = np.abs(matrix).max(axis=(0, 1))
    assert sizes[list(grouping.without_effect)].max(initial=0.0) < 1e-9
    assert sizes[sorted(used)].min() > 1e-9


@each_with_and_without
def test_names_are_unique_and_say_what_they_stand_for(make: Callable[[], Emitted]) -> None:
    emitted = make()
    base = emitted.model.grouping.base
    assert len({b.name for b in base}) == len(base)
    for b in base:
        standard = emitted.model.standard[b.representative]
        assert b.name == standard.name + ("R" if len(b.terms) > 1 else "")
        assert b.unit == standard.unit


def test_the_rx90_has_the_textbook_parameters() -> None:
    """Khalil and Dombre 2002, minimum inertial parameters of the Staubli RX-90, without motors."""
    d3 = r4 = 0.45
    onwards = {"M3": d3**2, "M4": d3**2, "M5": d3**2, "M6": d3**2}
    forearm = {"YY4": 1, "MZ4": 2 * r4, "M4": r4**2, "M5": r4**2, "M6": r4**2}
    expected = {
        "ZZ1R": {"ZZ1": 1, "YY2": 1, "YY3": 1, **onwards},
        "XX2R": {"XX2": 1, "YY2": -1, **{k: -v for k, v in onwards.items()}},
        "XZ2R": {"XZ2": 1, "MZ3": -d3},
        "ZZ2R": {"ZZ2": 1, **onwards},
        "MX2R": {"MX2": 1, "M3": d3, "M4": d3, "M5": d3, "M6": d3},
        "XX3R": {"XX3": 1, "YY3": -1, **forearm},
        "ZZ3R": {"ZZ3": 1, **forearm},
        "MY3R": {"MY3": 1, "MZ4": 1, "M4": r4, "M5": r4, "M6": r4},
        "XX4R": {"XX4": 1, "YY4": -1, "YY5": 1},
        "ZZ4R": {"ZZ4": 1, "YY5": 1},
        "MY4R": {"MY4": 1, "MZ5": -1},
        "XX5R": {"XX5": 1, "YY5": -1, "YY6": 1},
        "ZZ5R": {"ZZ5": 1, "YY6": 1},
        "MY5R": {"MY5": 1, "MZ6": 1},
        "XX6R": {"XX6": 1, "YY6": -1},
    }
    alone = ["XY2", "YZ2", "MY2", "XY3", "XZ3", "YZ3", "MX3", "XY4", "XZ4", "YZ4", "MX4"]
    alone += ["XY5", "XZ5", "YZ5", "MX5", "XY6", "XZ6", "YZ6", "ZZ6", "MX6", "MY6"]
    expected |= {name: {name: 1} for name in alone}
    found = grouped(shipped("rx90", "links"))
    assert found.keys() == expected.keys()
    for name, terms in expected.items():
        assert found[name] == pytest.approx(terms, rel=1e-12), name


def test_motors_of_the_rx90_join_the_first_two_links() -> None:
    """Khalil and Dombre: with motors, IA1 and IA2 belong to ZZ1R and ZZ2R, by the square of the ratio."""
    found, links = grouped(shipped("rx90")), grouped(shipped("rx90", "links"))
    for n, ratio in ((1, 100), (2, 100)):
        extra = {k: f for k, f in found[f"ZZ{n}R"].items() if k not in links[f"ZZ{n}R"]}
        assert extra == pytest.approx({f"IA{n}": ratio**2})
    assert {f"IA{n}" for n in (3, 4, 5, 6)} <= found.keys()


def planar(**changes: object) -> Arm:
    """Two links in a vertical plane."""
    joints = (
        Joint("j1", "revolute"),
        Joint("j2", "revolute", d=geometry_symbol("d2"), antecedent=0),
    )
    arm = Arm("planar", joints, (None, None), (0.0, -9.81, 0.0), symbols={"d2": 0.5})
    return replace(arm, **changes)  # type: ignore[arg-type]


def test_the_planar_arm_has_the_textbook_parameters_in_symbols() -> None:
    assert expressions(build(planar())) == {
        "ZZ1R": "ZZ1 + d2**2*M2",
        "MX1R": "MX1 + d2*M2",
        "MY1": "MY1",
        "ZZ2": "ZZ2",
        "MX2": "MX2",
        "MY2": "MY2",
    }


def test_lying_flat_the_planar_arm_keeps_three() -> None:
    """Without gravity in its plane: ZZ1 + d2^2 M2, and of the second link what turns."""
    flat = build(planar(gravity=(0.0, 0.0, -9.81)))
    assert expressions(flat) == {"ZZ1R": "ZZ1 + d2**2*M2", "ZZ2": "ZZ2", "MX2": "MX2", "MY2": "MY2"}


def test_geometry_symbols_keep_their_names_in_print() -> None:
    found = expressions(shipped("ariane4_free", "links"))
    assert found["MX2R"] == "MX2 + d3*(M3 + M4)"
    assert found["XX2R"] == "XX2 - YY2 - d3**2*(M3 + M4)"
    assert found["MY3R"] == "MY3 + MZ4 + r4*M4"
    assert for_reading(found["XX2R"]) == "XX2 - YY2 - d3^2 (M3 + M4)"


def test_a_motor_on_the_first_joint_joins_the_link_by_the_square_of_its_ratio() -> None:
    drive = DirectDrive(30.0, 0.1)
    arm = Arm("one", (Joint("j1", "revolute", drive=drive, effects=(EffectUse("drive_inertia"),)),), (None,))
    assert expressions(build(arm, Options())) == {"ZZ1R": "ZZ1 + 900*IA1"}


def test_a_levers_inertia_stays_on_its_own() -> None:
    """Its ratio changes over the stroke, so ZZ1 and IA1 have different columns."""
    drive = LeveredDrive(0.3, 0.08, (0.24, 0.36), (0.0, 2e4), 1, 0.0, 4e-3)
    arm = Arm("one", (Joint("j1", "revolute", drive=drive, effects=(EffectUse("drive_inertia"),)),), (None,))
    assert expressions(build(arm, Options())) == {"ZZ1": "ZZ1", "IA1": "IA1"}


def test_a_screw_and_the_mass_it_moves_are_one() -> None:
    """M + (2 pi / lead)^2 IA on a level axis; upright, gravity tells them apart."""
    joint = Joint(
        "j1",
        "prismatic",
        drive=DirectDrive(2 * math.pi / geometry_symbol("lead"), 0.1),
        effects=(EffectUse("drive_inertia"),),
    )
    level = Arm("level", (joint,), (None,), (9.81, 0.0, 0.0), symbols={"lead": 0.005})
    (text,) = expressions(build(level, Options())).values()
    assert factors(text, ["M1", "IA1"], {"lead": 0.01}) == pytest.approx(
        {"M1": 1, "IA1": (2 * math.pi / 0.01) ** 2}
    )
    assert list(expressions(build(replace(level, gravity=(0.0, 0.0, -9.81)), Options()))) == ["M1", "IA1"]


def test_a_spring_s_preload_and_an_offset_on_a_gear_are_one() -> None:
    effects = (EffectUse("friction_offset"), EffectUse("spring"))
    joint = Joint("j1", "revolute", drive=DirectDrive(30.0, 0.1), effects=effects)
    found = grouped(build(Arm("one", (joint,), (None,), (9.81, 0.0, 0.0)), Options()))
    # FO / k_T and KO / (k_T ratio): the preload counts for a thirtieth
    assert found["FO1R"] == pytest.approx({"FO1": 1, "KO1": 1 / 30})


# -- what is printed -------------------------------------------------------------------------


@each_with_and_without
def test_printed_groups_evaluate_to_the_base_parameters(make: Callable[[], Emitted]) -> None:
    emitted = make()
    arm = emitted.arm
    mechanism = Mechanism(arm)
    rng = np.random.default_rng(5)
    standard = mechanism.standard(random_bodies(arm, rng), rng)
    names = dict(zip(mechanism.names(), standard, strict=True)) | dict(arm.symbols)
    printed = [value(base.expression, names) for base in emitted.model.grouping.base]
    agree(np.array([printed]), [emitted.base(standard)], 1e-11)


@pytest.mark.parametrize("name", ["ariane4", "ariane4_free", "scara"])
def test_symbols_in_print_hold_for_other_lengths(name: str) -> None:
    """The same arm with other values of its symbols has the same groups, by their formulas."""
    original = shipped(name)
    rng = np.random.default_rng(8)
    longer = {key: float(v * rng.uniform(0.8, 1.3)) for key, v in original.arm.symbols.items()}
    other = group(Equations(replace(original.arm, symbols=longer)))
    standard = [p.name for p in original.model.standard]
    assert [b.name for b in other.base] == [b.name for b in original.model.grouping.base]
    for printed, fresh in zip(original.model.grouping.base, other.base, strict=True):
        found = factors(printed.expression, standard, longer)
        expected = {standard[k]: number(replace(original.arm, symbols=longer), f) for k, f in fresh.terms}
        assert found == pytest.approx(expected, rel=1e-9, abs=1e-12), printed.name


def test_random_arms_with_symbols_print_them() -> None:
    with_symbols = [seed for seed in range(24) if random_arm(seed).symbols]
    assert len(with_symbols) >= 5
    texts = [text for seed in with_symbols for text in expressions(generated(seed)).values()]
    assert sum("length" in text for text in texts) >= 10


def test_a_lever_in_symbols_leaves_the_other_formulas_alone() -> None:
    """The oracle tries other lengths; a lever near its dead centre would not close with them."""
    n, long, short = (geometry_symbol(name) for name in ("n", "long", "short"))
    gear = Joint(
        "j1",
        "revolute",
        drive=DirectDrive(n, 0.1),
        effects=(EffectUse("friction_offset"), EffectUse("spring")),
    )
    lever = Joint(
        "j2",
        "revolute",
        alpha=1.0,
        antecedent=0,
        drive=LeveredDrive(long, short, (0.2679, 0.3684), (0.0, 2e4), 1, 0.0, 4e-3),
    )
    symbols = {"n": 30.0, "long": 0.323, "short": 0.058}
    arm = Arm("two", (gear, lever), (None, None), (9.81, 0.0, 0.0), symbols=symbols)
    (text,) = (text for name, text in expressions(build(arm, Options())).items() if name == "FO1R")
    assert factors(text, ["FO1", "KO1"], {"n": 50.0}) == pytest.approx({"FO1": 1, "KO1": 1 / 50})


def test_many_symbols_take_no_longer_than_few() -> None:
    """A factor is sought over the symbols that it depends on."""
    arm = ARMS["scara"]
    extra = {name: 0.1 + 0.03 * k for k, name in enumerate(("h1", "h2", "h4", "e1", "e4", "w4"))}
    h1, h2, h4, e1, e4, w4 = (geometry_symbol(name) for name in extra)
    joints = list(arm.joints)
    joints[0] = replace(joints[0], r=h1, d=e1)
    joints[1] = replace(joints[1], r=h2)
    joints[3] = replace(joints[3], d=e4, r=h4, theta=w4)
    start = time.process_time()
    found = group(Equations(replace(arm, joints=tuple(joints), symbols={**arm.symbols, **extra})))
    assert time.process_time() - start < 5.0
    printed = {b.name: b.expression for b in found.base}
    assert printed["MX2R"] == "MX2 + MX3 + e4*M4"
    standard = [p.name for p in shipped("scara").model.standard]
    turned = factors(printed["ZZ2R"], standard, {**arm.symbols, "e4": 0.3})
    l2 = arm.symbols["l2"]
    assert turned == pytest.approx({"ZZ2": 1, "ZZ3": 1, "MX3": 2 * l2, "M4": 0.3**2 + 2 * 0.3 * l2})


# -- whatever the units and the speeds -------------------------------------------------------


def in_other_units(arm: Arm, factor: float) -> Arm:
    """The same arm, its motor coordinates counted `factor` times as finely."""

    def drive(joint: Joint) -> Joint:
        found = joint.drive
        if isinstance(found, NoDrive):
            return joint
        constant = found.torque_constant / factor
        if isinstance(found, DirectDrive):
            return replace(joint, drive=replace(found, ratio=found.ratio * factor, torque_constant=constant))
        motor = found.motor[0] * factor, found.motor[1] * factor
        return replace(joint, drive=replace(found, motor=motor, torque_constant=constant))

    return replace(arm, joints=tuple(drive(joint) for joint in arm.joints))


@pytest.mark.parametrize("name", ["ariane4", "ariane6", "rx90"])
@pytest.mark.parametrize("factor", [1e-6, 1e3, 1e6])
def test_a_finer_encoder_changes_no_group(name: str, factor: float) -> None:
    found = group(Equations(in_other_units(ARMS[name], factor)))
    expected = shipped(name).model.grouping
    assert [b.name for b in found.base] == [b.name for b in expected.base]


@pytest.mark.parametrize("velocity", [1.0, 0.02, 1e-3, 1e-4])
def test_the_stribeck_effect_of_a_slow_joint_is_not_overlooked(velocity: float) -> None:
    arm = ARMS["gravity_arm"]
    use = EffectUse("stribeck_friction", {"velocity": velocity})
    joints = (arm.joints[0], replace(arm.joints[1], effects=(*arm.joints[1].effects, use)))
    names = [b.name for b in group(Equations(replace(arm, joints=joints))).base]
    assert names == [*expressions(shipped("gravity_arm")), "FS2"]


# -- row by row ------------------------------------------------------------------------------


@each_arm
def test_each_row_has_the_rank_of_its_own_regressor(make: Callable[[], Emitted]) -> None:
    """Row-wise gains: a joint's parameters are what its own row can tell."""
    arm = make().arm
    matrix, names = efforts(arm, samples=3 * len(make().model.standard) + 10)
    equations = Equations(arm)
    for n in range(matrix.shape[1]):
        grouping = group(equations, n)
        assert len(grouping.base) == span(matrix[:, n]).rank
        hold(arm, grouping.base, matrix[:40, n], names)
        assert all(b.name.endswith(f"_row{n + 1}") for b in grouping.base)
