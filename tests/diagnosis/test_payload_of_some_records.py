"""A payload that some records have: which ones, wherever they lie in time, and whether the test record does.

The plant is a planar arm by Lagrange's equations; the payload is a point mass at its tool, by the Jacobian of
that place (Spong, Hutchinson and Vidyasagar 2006).
"""

from pathlib import Path

import made_up_plants as plants
import numpy as np
import pytest
from made_up_plants import LENGTH, PLAIN, TOOL, G, Plant, description, log, planar

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects
from modelgen.evaluation import Evaluator, Motion
from modelgen.functions import EVALUATED, build_model
from modelgen.numeric import Array

ARM = loads(description(2), "arms.yaml", known_effects())["made_up"]
MASS = 0.4  # kg
MASS_2, COM_2 = plants.MASS[1], plants.COM[1]  # of the second link


def payload(q: Array, dq: Array, ddq: Array) -> Array:
    """Torques (N, 2) that a point mass at the tool needs: J^T m (J ddq + dJ dq + g)."""
    (q1, q2), (d1, d2), (a1, a2) = q.T, dq.T, ddq.T
    both, turn = q1 + q2, d1 + d2
    jx = np.array([-LENGTH * np.sin(q1) - TOOL * np.sin(both), -TOOL * np.sin(both)])
    jy = np.array([LENGTH * np.cos(q1) + TOOL * np.cos(both), TOOL * np.cos(both)])
    ax = jx[0] * a1 + jx[1] * a2 - LENGTH * np.cos(q1) * d1**2 - TOOL * np.cos(both) * turn**2
    ay = jy[0] * a1 + jy[1] * a2 - LENGTH * np.sin(q1) * d1**2 - TOOL * np.sin(both) * turn**2
    return MASS * np.column_stack([jx[k] * ax + jy[k] * (ay + G) for k in range(2)])


LOADED = Plant(2, planar, payload)


@pytest.mark.parametrize(
    ("having", "test"),
    [((2,), False), ((2,), True), ((1,), False), ((3, 4), True), ((1, 2, 3), False)],
    ids=lambda x: "".join(map(str, x)) if isinstance(x, tuple) else ("loaded" if x else "bare"),
)
def test_the_records_that_have_it_are_found(tmp_path: Path, having: tuple[int, ...], test: bool) -> None:
    """With its mass and its place. The error on the test record falls to the noise, be it there or not."""
    count = 4 if max(having) > 2 else 2
    paths = [log(tmp_path / f"r{k}.csv", LOADED if k in having else PLAIN[2], k) for k in range(1, count + 1)]
    unseen = log(tmp_path / "unseen.csv", LOADED if test else PLAIN[2], 9)
    diagnosis = mg.diagnose(ARM, paths, unseen, experiment=False)
    found = diagnosis.to_json()
    (cause,) = found["causes"]
    assert (found["verdict"], cause["effect"]) == ("named", "payload_change")
    assert [Path(p).stem for p in cause["records"]] == [f"r{k}" for k in having] + ["unseen"] * test
    for name, true in (("mass", MASS), ("x", TOOL)):
        value = cause["parameters"][name]
        assert abs(value["value"] - true) < 4 * value["std"] < 0.2 * true
    checks = {c["name"]: c for c in cause["checks"]}
    assert checks["stable"]["passed"]
    assert checks["confirmed"]["passed"]
    assert max(found["error"]["after"]) < 0.03  # of which the noise is 0.02 before the filter
    link = diagnosis.found.parameters["MX2"]  # of the arm without it
    assert abs(link.value - MASS_2 * COM_2) < 4 * link.std < 0.02 * MASS_2 * COM_2
    before, after = (np.linalg.norm(found["simulation"][x]["rmse"]) for x in ("before", "after"))
    assert after < before


def test_a_payload_of_the_description_is_no_part_of_the_link(tmp_path: Path) -> None:
    """All records carry it, and the description says so: the link is identified without it, and the model of
    both predicts what the arm needs.
    """
    known = description(2).replace(
        "    joints:", "    effects: [payload_change: {mass: 0.4, x: 0.3}]\n    joints:"
    )
    arm = loads(known, "arms.yaml", known_effects())["made_up"]
    train = [log(tmp_path / f"r{k}.csv", LOADED, k) for k in (1, 2)]
    found = mg.identify(arm, train, log(tmp_path / "unseen.csv", LOADED, 9)).to_json()
    value = {p["name"]: p for p in found["parameters"]}["MX2"]
    assert abs(value["value"] - MASS_2 * COM_2) < 4 * value["std"] < 0.02 * MASS_2 * COM_2
    model, evaluator = build_model(arm, EVALUATED), Evaluator(arm)
    random = np.random.default_rng(5)
    q, dq, ddq = random.normal(size=(3, 20, 2))
    motion, base = Motion(np.arange(20) / 100, q, dq, ddq), random.normal(size=len(found["parameters"]))
    made = evaluator.regressor(model, motion, base) @ base + evaluator.known.inputs(motion)
    np.testing.assert_allclose(made, evaluator.inputs(motion, base), rtol=0, atol=1e-12)
    torques = payload(q, dq, ddq) / (np.array(plants.RATIO) * plants.CONSTANT)
    np.testing.assert_allclose(evaluator.known.inputs(motion), torques, rtol=0, atol=1e-12)
