"""How many operations the dynamics take."""

from collections.abc import Callable

import pytest
from witness.arms import RANDOM, SHIPPED, SHIPPED_LINKS, Emitted, shipped
from witness.program import run

# Limits on multiplications, additions and negations together, for links without drives and effects.
ARMS = ("ariane4_free", "ariane6", "rx90", "puma560", "wam7")
LIMITS = {
    "inverse_dynamics_standard": (355, 615, 568, 626, 719),
    "inverse_dynamics": (300, 518, 476, 526, 611),
    "regressor_standard": (347, 811, 824, 924, 1557),
    "regressor": (280, 641, 653, 735, 1246),
    "mass_matrix": (112, 262, 225, 298, 358),
    "forward_dynamics": (430, 894, 823, 939, 1170),
}
EACH = [
    pytest.param(name, arm, limit, marks=pytest.mark.xdist_group(arm), id=f"{name}-{arm}")
    for name, row in LIMITS.items()
    for arm, limit in zip(ARMS, row, strict=True)
]
DYNAMICS = (
    "inverse_dynamics",
    "gravity",
    "bias",
    "regressor",
    "regressor_packed",
    "regressor_standard",
    "slotine_li_regressor",
    "mass_matrix",
    "forward_dynamics",
    "energy",
    "forward_kinematics",
    "jacobian",
    "drive_gain",
    "motor_from_joint",
)
TRIGONOMETRIC = ("sin", "cos", "tan", "asin", "acos", "atan", "atan2")


def executed(emitted: Emitted, name: str) -> dict[str, int]:
    """Operations by kind, counted while the program runs."""
    function = emitted.functions[name]
    inputs = {a.name: [0.4 + 0.1 * k for k in range(a.size)] for a in function.arguments}
    done = run(function.program, inputs).done
    counts = {"mul": done["mul"], "add": done["add"] + done["sub"], "neg": done["neg"], "div": done["div"]}
    counts |= {"sqrt": done["sqrt"], "trig": sum(done[call] for call in TRIGONOMETRIC)}
    counts["other"] = sum(done.values()) - sum(counts.values())
    return counts


@pytest.mark.parametrize(("name", "arm", "limit"), EACH)
def test_limits(name: str, arm: str, limit: int) -> None:
    counts = executed(shipped(arm, "links"), name)
    assert counts["mul"] + counts["add"] + counts["neg"] <= limit


@pytest.mark.parametrize("make", [*SHIPPED, *RANDOM[:12]])
def test_counts_are_those_of_what_is_executed(make: Callable[[], Emitted]) -> None:
    emitted = make()
    for name, function in emitted.functions.items():
        assert dict(function.operations) == executed(emitted, name), name


@pytest.mark.parametrize("make", [*SHIPPED, *SHIPPED_LINKS, *RANDOM])
def test_one_sine_and_one_cosine_for_a_revolute_joint(make: Callable[[], Emitted]) -> None:
    """Links, levers and offsets of the same joint share them."""
    emitted = make()
    arm = emitted.arm
    revolute = sum(arm.joints[i].type == "revolute" for i in arm.coordinates)
    for name in [n for n in emitted.functions if n.removesuffix("_standard") in DYNAMICS]:
        function = emitted.functions[name]
        inputs = {a.name: [0.4 + 0.1 * k for k in range(a.size)] for a in function.arguments}
        done = run(function.program, inputs).done
        assert done["sin"] <= revolute, name
        assert done["cos"] <= revolute, name
        assert not any(done[call] for call in TRIGONOMETRIC[2:]), name


@pytest.mark.parametrize("arm", ARMS)
def test_forward_dynamics_divides_once_a_joint(arm: str) -> None:
    emitted = shipped(arm, "links")
    assert executed(emitted, "forward_dynamics")["div"] == len(emitted.arm.coordinates)
    assert executed(emitted, "inverse_dynamics")["div"] == 0


@pytest.mark.parametrize("arm", ARMS)
def test_base_parameters_cost_no_more_than_standard_ones(arm: str) -> None:
    for variant in ("default", "links"):
        emitted = shipped(arm, variant)
        for name in ("inverse_dynamics", "regressor", "mass_matrix", "forward_dynamics"):
            with_base, with_standard = executed(emitted, name), executed(emitted, f"{name}_standard")
            assert sum(with_base.values()) <= sum(with_standard.values())


def test_a_sliding_joint_costs_no_trigonometry() -> None:
    emitted = shipped("screw_axis")
    assert all(executed(emitted, name)["trig"] == 0 for name in emitted.functions)
