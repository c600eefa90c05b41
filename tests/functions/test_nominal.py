"""Nominal parameters are those of the bodies that the description describes."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from arms_support import ARMS, model

from modelgen.backends import NumpyFunction
from modelgen.errors import InputError
from modelgen.functions import Options, build_model, nominal_base, nominal_standard


def test_the_sum_of_the_masses_and_the_first_moments() -> None:
    values = nominal_standard(model("ariane4"))
    links = [link for link in ARMS["ariane4"].links if link]
    assert sum(values[f"M{i}"] for i in (1, 2, 3, 4)) == pytest.approx(sum(link.mass for link in links))
    assert [values["MX2"], values["MY2"], values["MZ2"]] == pytest.approx([8 * 0.21, 8 * 0.01, 8 * 0.02])
    assert values["FC2"] == 6.0e-3
    assert values["IA1"] == 3.5e-8
    assert "FV4" not in values, "the drive of a locked joint has left the model"


def test_a_links_tensor_about_the_origin_is_mujocos_mass_matrix() -> None:
    """A body on a ball joint at its origin: MuJoCo's mass matrix is the tensor about that origin."""
    link = next(link for link in ARMS["ariane4"].links if link)
    ixx, ixy, ixz, iyy, iyz, izz = link.inertia
    spec = f"""<mujoco><compiler balanceinertia="true"/><worldbody><body><joint type="ball"/>
      <inertial pos="{" ".join(map(str, link.com))}" mass="{link.mass}"
                fullinertia="{ixx} {iyy} {izz} {ixy} {ixz} {iyz}"/></body></worldbody></mujoco>"""
    made = mujoco.MjModel.from_xml_string(spec)
    data = mujoco.MjData(made)
    mujoco.mj_forward(made, data)
    full = np.zeros((3, 3))
    mujoco.mj_fullM(made, data, full)
    values = nominal_standard(model("ariane4"))
    found = [values[f"{name}1"] for name in ("XX", "XY", "XZ", "YY", "YZ", "ZZ")]
    np.testing.assert_allclose(found, full[np.triu_indices(3)], rtol=1e-9)


def test_base_and_standard_parameters_give_the_same_inputs() -> None:
    made = model("ariane4")
    functions = {f.name: NumpyFunction(f) for f in made.functions}
    standard = np.array(list(nominal_standard(made).values()))
    base = np.array(list(nominal_base(made).values()))
    q, dq, ddq = np.array([0.1, 0.9, 3.0]), np.array([0.2, -0.1, 0.3]), np.array([1.0, 2.0, -1.0])
    np.testing.assert_allclose(
        functions["inverse_dynamics"](q, dq, ddq, base),
        functions["inverse_dynamics_standard"](q, dq, ddq, standard),
        rtol=1e-12,
    )


def test_a_missing_value_is_named() -> None:
    arm = ARMS["ariane4"]
    with pytest.raises(InputError, match="link j2 has no nominal inertials"):
        nominal_base(build_model(replace(arm, links=(arm.links[0], None, *arm.links[2:])), Options()))
    joint = replace(arm.joints[0], effects=(replace(arm.joints[0].effects[0], values={}),))
    with pytest.raises(InputError, match=r"FV1, viscous friction coefficient .* has no nominal value"):
        nominal_base(build_model(replace(arm, joints=(joint, *arm.joints[1:])), Options()))
