"""Identified parameters become bodies that could exist, and come back as they were."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest
from exporting_support import base_parameters, only_exact

import modelgen as mg
from modelgen.exporting.completion import completed
from modelgen.exporting.states import States
from modelgen.functions.nominal import base_matrix
from modelgen.identification.bodies import violations
from modelgen.numeric import Array

ARMS = mg.load_arms(Path(__file__).parents[2] / "arms.yaml")


def without_links(arm: mg.Arm) -> mg.Arm:
    return replace(arm, links=tuple(None for _ in arm.links))


def back(arm: mg.Arm, parameters: dict[str, float] | None, folder: Path) -> mg.Model:
    """The model of what is imported of what was exported."""
    file = folder / "model.xml"
    mg.export(arm, to="mjcf", out=file, parameters=parameters)
    return mg.build_model(mg.import_robot(file, exact=True).arm)


@pytest.mark.parametrize("name", ARMS)
def test_what_was_exported_is_imported_with_the_same_base_parameters(name: str, tmp_path: Path) -> None:
    file = tmp_path / "model.xml"
    arm = only_exact(ARMS[name], mg.export(ARMS[name], to="mjcf", out=file))
    mg.export(arm, to="mjcf", out=file)
    ours, theirs = base_parameters(arm), base_parameters(mg.import_robot(file, exact=True).arm)
    if name == "two_fingers":
        # the import has the branch's first frame half a turn about its axis from the description's
        turned = {k: -v for k, v in theirs.items() if k in ("XZ4", "YZ4", "MX4", "MY4")}
        assert len(turned) == 4
        theirs |= turned
    assert theirs == pytest.approx(ours, rel=1e-9, abs=1e-12)


def test_identified_values_come_back_without_any_nominal_ones(tmp_path: Path) -> None:
    arm = ARMS["gravity_arm"]
    model = mg.build_model(arm)
    assert model.nominal is not None
    rng = np.random.default_rng(3)
    values = {name: value * (1 + 0.05 * rng.standard_normal()) for name, value in model.nominal.items()}
    imported = back(without_links(arm), values, tmp_path)
    assert imported.nominal is not None
    assert dict(imported.nominal) == pytest.approx(values, rel=1e-9, abs=1e-12)


@pytest.mark.parametrize("known", [True, False])
def test_bodies_that_could_exist_are_found_for_parameters_that_some_have(known: bool) -> None:
    arm = ARMS["rx90"]
    model = mg.build_model(arm).built
    rng = np.random.default_rng(5)
    standard = np.concatenate([_body(rng, link.mass) for link in arm.links if link is not None])
    standard = np.append(standard, rng.uniform(1e-5, 1e-3, len(model.standard) - len(standard)))
    theta = base_matrix(model) @ standard
    found, off = completed(model if known else replace(model, arm=without_links(arm)), theta)
    assert not off.any()
    assert not violations(model, found)
    assert np.abs(base_matrix(model) @ found - theta).max() <= 1e-9 * np.abs(theta).max()


def _body(rng: np.random.Generator, mass_of_link: float) -> Array:
    """Ten parameters of a cloud of mass points."""
    mass, place = rng.uniform(0.1, 0.2, 8) * mass_of_link, rng.uniform(-0.2, 0.2, (8, 3))
    inertia = sum(m * (p @ p * np.eye(3) - np.outer(p, p)) for m, p in zip(mass, place, strict=True))
    return np.concatenate([inertia[np.triu_indices(3)], mass @ place, [mass.sum()]])


def test_parameters_of_no_body_are_replaced_by_the_nearest_and_it_is_said() -> None:
    arm = ARMS["gravity_arm"]
    model = mg.build_model(arm)
    assert model.nominal is not None
    values = dict(model.nominal)
    # link 2 with less inertia about its joint than its own mass at its centre has
    values["ZZ2"] = 1e-4 * values["MX2"] ** 2
    found = mg.export(arm, to="mjcf", parameters=values)
    (note,) = [note for note in found.notes if "no bodies that could exist" in note]
    read = re.search(r"efforts are at most (\S+) N m off \((j\d)", note)
    assert read is not None
    # the file's own efforts, gravity and inertia, are as far from those asked for
    simulator = mujoco.MjModel.from_xml_string(found.text)
    data, off = mujoco.MjData(simulator), []
    states = States(arm)
    for q, dq, ddq in zip(states.q, states.dq, states.ddq, strict=True):
        data.qpos[:], data.qvel[:] = q, dq
        full = np.zeros((2, 2))
        mujoco.mj_fwdPosition(simulator, data)
        mujoco.mj_fwdVelocity(simulator, data)
        mujoco.mj_fullM(simulator, data, full)
        dry = simulator.dof_frictionloss * np.sign(dq)
        theirs = full @ ddq + data.qfrc_bias - data.qfrc_passive + dry
        off.append(theirs - model.functions["inverse_dynamics"](q, dq, ddq, np.array(list(values.values()))))
    n = int(read[2][1:]) - 1
    assert float(read[1]) == pytest.approx(np.abs(off).max(axis=0)[n], rel=0.05)


def test_a_file_beside_the_description_is_taken_where_it_has_no_values(tmp_path: Path) -> None:
    arm = ARMS["gravity_arm"]
    model = mg.build_model(arm)
    assert model.nominal is not None
    lines = [f"  {name}: {float(value)!r}\n" for name, value in model.nominal.items()]
    (tmp_path / "bare.yaml").write_text(
        "schema: 1\nconvention: khalil_kleinfinger\narms:\n  bare:\n    gravity: [9.81, 0, 0]\n    joints:\n"
        "      - {name: j1, alpha: 0, d: 0, r: 0, effects: [viscous_friction, coulomb_friction]}\n"
        "      - {name: j2, alpha: 0, d: 0.538534, r: 0, effects: [viscous_friction, coulomb_friction]}\n",
        encoding="utf-8",
    )
    (tmp_path / "bare_parameters.yaml").write_text(
        "schema: 1\narm: bare\nparameters:\n" + "".join(lines), encoding="utf-8"
    )
    found = mg.export(mg.load_arms(tmp_path / "bare.yaml")["bare"], to="mjcf")
    assert found.notes[0] == "parameters are those of bare_parameters.yaml beside the description"
    assert {row.status for row in found.rows} == {"exact", "approximated"}
