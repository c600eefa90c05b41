"""export_<arm>_model() makes an AcadosModel. acados is no dependency: a stub stands for its class."""

import sys
from pathlib import Path
from types import ModuleType
from typing import Any

import casadi as ca
import numpy as np
import pytest
from arms_support import generated, inputs, model

pytestmark = pytest.mark.xdist_group("ariane4")


class AcadosModel:
    """The attributes that acados reads, and no others."""

    __slots__ = ("f_expl_expr", "f_impl_expr", "name", "p", "u", "x", "xdot")


def module(name: str, variant: str) -> Any:
    made: Any = ModuleType("generated")
    exec(generated(name, variant).files[f"{name}_casadi.py"], made.__dict__)  # noqa: S102 - the text under test
    return made


@pytest.fixture
def stub(monkeypatch: pytest.MonkeyPatch) -> None:
    acados: Any = ModuleType("acados_template")
    acados.AcadosModel = AcadosModel
    monkeypatch.setitem(sys.modules, "acados_template", acados)


def exported(name: str, variant: str) -> AcadosModel:
    made: AcadosModel = getattr(module(name, variant), f"export_{name}_model")()
    return made


VARIANTS = ("default", "sincos", "runtime_geometry")


@pytest.mark.usefixtures("stub")
@pytest.mark.parametrize("variant", VARIANTS)
def test_everything_is_sx_and_of_the_right_shape(variant: str) -> None:
    made: Any = exported("ariane4", variant)
    assert made.name == "ariane4"
    for name, shape in {
        "x": (6, 1),
        "xdot": (6, 1),
        "u": (3, 1),
        "f_expl_expr": (6, 1),
        "f_impl_expr": (6, 1),
    }.items():
        value = getattr(made, name)
        assert isinstance(value, ca.SX)
        assert value.shape == shape
    for name in ("x", "xdot", "u", "p"):
        assert getattr(made, name).is_valid_input(), f"{name} must be free symbols"
    symbols = ca.symvar(ca.vertcat(made.f_expl_expr, made.f_impl_expr))
    known = ca.symvar(ca.vertcat(made.x, made.xdot, made.u, made.p))
    assert {s.name() for s in symbols} <= {s.name() for s in known}


@pytest.mark.usefixtures("stub")
@pytest.mark.parametrize("variant", VARIANTS)
def test_the_implicit_form_vanishes_where_the_explicit_one_says(variant: str) -> None:
    made: Any = exported("ariane4", variant)
    f = ca.Function("f", [made.x, made.u, made.p], [made.f_expl_expr])
    g = ca.Function("g", [made.x, made.xdot, made.u, made.p], [made.f_impl_expr])
    plain = model("ariane4")
    dynamics = next(f for f in plain.functions if f.name == "forward_dynamics")
    rng = np.random.default_rng(2)
    for _ in range(5):
        q, dq, u, parameters = inputs(plain, dynamics, rng)
        p = parameters
        if variant == "runtime_geometry":
            p = np.concatenate([parameters, geometry()])
        x = np.concatenate([q, dq])
        xdot = f(x, u, p)
        np.testing.assert_allclose(xdot[:3].full().ravel(), dq)
        np.testing.assert_allclose(g(x, xdot, u, p).full(), 0, atol=1e-8 * max(1.0, abs(u).max()))
        assert abs(g(x, xdot + 1, u, p).full()).min() > 1e-3, "the implicit form must depend on xdot"


def geometry() -> np.ndarray:
    """Values of the run-time geometry, in the order of its input."""
    made = model("ariane4", "runtime_geometry")
    return np.array([made.arm.symbols[name] for name in made.geometry])


@pytest.mark.usefixtures("stub")
@pytest.mark.parametrize("variant", VARIANTS)
def test_with_the_emitted_derivatives_it_is_the_same_model(variant: str) -> None:
    """What acados asks of an explicit model: the slope, and its sensitivities along given directions."""
    plain: Any = exported("ariane4", variant)
    called: Any = module("ariane4", variant).export_ariane4_model(custom_jacobian=True)
    rng = np.random.default_rng(4)
    q, dq, u, parameters = inputs(
        model("ariane4"), next(f for f in model("ariane4").functions if f.name == "forward_dynamics"), rng
    )
    p = np.concatenate([parameters, geometry()]) if variant == "runtime_geometry" else parameters
    seeds, found = rng.uniform(-1, 1, (6, 9)), []
    for made in (plain, called):
        for name in ("x", "xdot", "u", "p"):
            assert getattr(made, name).is_valid_input(), f"{name} must be free symbols"
        along = ca.jtimes(made.f_expl_expr, made.x, ca.DM(seeds))
        by_input = ca.jacobian(made.f_expl_expr, made.u)
        values = [made.f_expl_expr, along, by_input, ca.substitute(made.f_impl_expr, made.xdot, made.x)]
        whole = ca.Function("whole", [made.x, made.u, made.p], values)
        found.append([r.full() for r in whole(np.concatenate([q, dq]), u, p)])
    assert isinstance(called.f_expl_expr, ca.MX)
    for mine, other in zip(*found, strict=True):
        np.testing.assert_allclose(mine, other, rtol=0, atol=1e-10 * abs(other).max())


@pytest.mark.parametrize("name", ["ariane4", "scara"])
def test_importing_the_module_does_not_need_acados(checkout: Path, name: str) -> None:
    assert module(name, "default").functions()
    text = (checkout / "generated" / name / f"{name}_casadi.py").read_text()
    assert f"def export_{name}_model(" in text
    with pytest.raises(ImportError, match="acados_template"):
        exported(name, "default")


def test_row_wise_gains_leave_no_state_space_model() -> None:
    assert not hasattr(module("gravity_arm", "row_wise"), "export_gravity_arm_model")
