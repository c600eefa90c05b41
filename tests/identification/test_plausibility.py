"""Logs that were read wrongly, and results that no arm has: identify and diagnose ask the same question."""

from __future__ import annotations

import re
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from identification_support import model_of

import modelgen as mg
from modelgen.description import loads
from modelgen.effects import known_effects
from modelgen.identification import Estimate
from modelgen.identification.impossible import driving

ARMS = """
schema: 1
convention: khalil_kleinfinger
arms:
  two:
    gravity: [0, -9.81, 0]
    joints:
      - {name: shoulder, alpha: 0, d: 0, r: 0, drive: {type: direct, ratio: 50, torque_constant: 0.1},
         effects: [{viscous_friction: {coefficient: 0.002}}, {coulomb_friction: {magnitude: 0.02}}]}
      - {name: elbow, alpha: 0, d: 0.4, r: 0, drive: {type: direct, ratio: 30, torque_constant: 0.05},
         effects: [{viscous_friction: {coefficient: 0.001}}, {coulomb_friction: {magnitude: 0.01}}]}
    links:
      shoulder: {mass: 4, com: [0.2, 0.01, 0], inertia: [0.01, 0, 0, 0.06, 0, 0.06]}
      elbow: {mass: 2, com: [0.15, 0.02, 0], inertia: [0.005, 0, 0, 0.02, 0, 0.02]}
"""
Table = dict[str, np.ndarray]


@pytest.fixture(scope="module")
def arm() -> mg.Arm:
    return loads(ARMS, "arms.yaml", known_effects())["two"]


@pytest.fixture(scope="module")
def logs(arm: mg.Arm) -> list[Table]:
    return [log(arm, seed) for seed in (1, 2)]


def log(arm: mg.Arm, seed: int, centre: float = 0.0, beside: float = 1.1) -> Table:
    """20 s at 100 Hz of the arm as described, about a position of the shoulder. beside: frequencies of the
    elbow, those of the shoulder 1; where both are alike the motion repeats after 10 s.
    """
    random = np.random.default_rng(seed)
    t = np.arange(2000) / 100
    w = 2 * np.pi * np.outer([0.1, 0.2, 0.3, 0.5], [1.0, beside])
    size, phase = random.uniform(0.1, 0.4, w.shape), random.uniform(0, 6, w.shape)
    angle = t[:, None, None] * w + phase
    q = (size * np.sin(angle)).sum(axis=1) + np.array([centre, 0.0])
    dq, ddq = (size * w * np.cos(angle)).sum(axis=1), (-size * w**2 * np.sin(angle)).sum(axis=1)
    model = model_of(arm)
    current = np.asarray(
        model.functions["inverse_dynamics"](
            q=q, dq=dq, ddq=ddq, parameters=np.array(list(model.nominal.values()))
        )
    )
    current = current + 1e-3 * random.normal(size=current.shape)
    return {"t": t, "q1": q[:, 0], "q2": q[:, 1], "i1": current[:, 0], "i2": current[:, 1]}


def exchanged(table: Table, a: str, b: str) -> Table:
    return table | {a: table[b], b: table[a]}


WRONG: dict[str, Any] = {
    "efforts of two joints": (
        lambda x: exchanged(x, "i1", "i2"),
        "efforts of joints shoulder and elbow exchanged",
    ),
    "positions of two joints": (
        lambda x: exchanged(x, "q1", "q2"),
        "positions of joints shoulder and elbow exchanged",
    ),
    "columns of two joints": (
        lambda x: exchanged(exchanged(x, "q1", "q2"), "i1", "i2"),
        "columns of joints shoulder and elbow exchanged",
    ),
    "degrees": (
        lambda x: x | {k: np.degrees(x[k]) for k in ("q1", "q2")},
        "are the positions in degrees",
    ),
    "motor angles": (
        lambda x: x | {"q1": 50 * x["q1"], "q2": 30 * x["q2"]},
        "are the positions q1, q2 those of the motors",
    ),
    "one motor angle": (
        lambda x: x | {"q2": 30 * x["q2"]},
        "are the positions q2 those of the motors",
    ),
    "joint angles named motor angles": (
        lambda x: {k.replace("q", "qm"): v for k, v in x.items()},
        "are the positions qm1, qm2 those of the joints",
    ),
    "an encoder that counts the other way": (
        lambda x: x | {"q2": -x["q2"]},
        "are the positions of elbow counted the other way",
    ),
    "a drive that counts the other way": (
        lambda x: x | {"q1": -x["q1"], "i1": -x["i1"]},
        "are positions and efforts of shoulder counted the other way",
    ),
    "angles against the base": (
        lambda x: x | {"q2": x["q1"] + x["q2"]},
        "are the positions of elbow those of its link against the base, not against shoulder",
    ),
}


@pytest.mark.parametrize("part", ["train", "test"])
def test_efforts_without_their_sign_are_asked_about(part: str, arm: mg.Arm) -> None:
    """Of an arm that hangs, whose efforts are on either side."""
    logs = {name: log(arm, seed, -np.pi / 2) for name, seed in (("train", 1), ("test", 2))}
    assert mg.identify(arm, logs["train"], logs["test"]).to_json()["doubts"] == []
    logs[part] = logs[part] | {name: np.abs(logs[part][name]) for name in ("i1", "i2")}
    with pytest.raises(mg.InputError, match=f"{part}: are the efforts of .* amounts without their sign"):
        mg.identify(arm, logs["train"], logs["test"])


def test_an_effort_that_is_switched_is_none_of_these(arm: mg.Arm) -> None:
    """A drive that is switched between two efforts, and moves as the model says."""
    bang = mg.read_log(switched(arm, 1), arm)
    found = mg.identify(arm, bang, mg.read_log(switched(arm, 2), arm))
    truth = model_of(arm).nominal
    for name, e in found.parameters.items():
        assert abs(e.value - truth[name]) < 5 * e.std, name


def switched(arm: mg.Arm, seed: int) -> Table:
    """20 s from hanging at rest, both currents switched between two values at random."""
    random, t = np.random.default_rng(seed), np.arange(2001) / 100
    signs = np.sign(np.repeat(random.normal(size=(201, 2)), 10, axis=0)[: len(t)])
    made = mg.simulate(
        arm,
        q0=[-np.pi / 2, 0.0],
        duration=20.0,
        rate=100.0,
        inputs={"t": t, "i1": 1.5 * signs[:, 0], "i2": 0.8 * signs[:, 1]},
        encoder="1048576",
    )
    return {name: np.asarray(x) for name, x in made.log.items()}


@pytest.mark.parametrize("name", ["i1", "i2", "q2"])
def test_records_that_disagree_are_asked_about(name: str, arm: mg.Arm, logs: list[Table]) -> None:
    """Another sign, another unit, another zero in the second of two records, which explain themselves."""
    other = log(arm, 3)
    assert mg.identify(arm, [logs[0], other], logs[1]).to_json()["doubts"] == []
    changed = {"i1": -other["i1"], "i2": 1.3 * other["i2"], "q2": other["q2"] + 0.2}[name]
    doubts = mg.identify(arm, [logs[0], other | {name: changed}], logs[1]).to_json()["doubts"]
    joint = "shoulder" if name == "i1" else "elbow"
    assert any(f"The training records disagree at {joint}" in x for x in doubts)


def test_a_record_that_was_read_wrongly_is_asked_about_where_another_was_not(
    arm: mg.Arm, logs: list[Table]
) -> None:
    other = log(arm, 3)
    with pytest.raises(mg.InputError, match=r"train\[1\]: are the positions of elbow counted the other way"):
        mg.identify(arm, [logs[0], other | {"q2": -other["q2"]}], logs[1])


def test_a_test_record_of_another_arm_is_asked_about(arm: mg.Arm, logs: list[Table]) -> None:
    train, test = logs
    doubts = mg.identify(arm, train, test | {"i1": -test["i1"]}).to_json()["doubts"]
    assert any("The error at shoulder is 200 % of its effort on the test records" in x for x in doubts)


@pytest.mark.parametrize("zero", [0.4, 0.02, -0.02])
def test_efforts_whose_zero_is_off_are_asked_about(zero: float, arm: mg.Arm, logs: list[Table]) -> None:
    """What a constant explains of the rest is named with its size, in the unit of the log."""
    shifted = [x | {"i2": x["i2"] + zero} for x in logs]
    doubts = mg.identify(arm, *shifted).to_json()["doubts"]
    (said,) = (x for x in doubts if x.startswith("A constant effort of"))
    size, unit = said.split()[4:6]
    assert float(size) == pytest.approx(zero, rel=0.05)
    assert unit == "A"
    assert "at elbow explains" in said


@pytest.mark.parametrize("sharpness", [1.0, 4.0, np.inf])
def test_efforts_that_fall_short_are_asked_about(sharpness: float, arm: mg.Arm, logs: list[Table]) -> None:
    """A limit that is soft, or that lies before the noise, shows in no reading that stands there."""
    random = np.random.default_rng(6)

    def short(x: np.ndarray) -> np.ndarray:
        top = 0.8 * np.abs(x).max()
        if np.isinf(sharpness):
            return np.clip(x, -top, top) + 0.002 * random.normal(size=len(x))
        return x / (1.0 + np.abs(x / top) ** (2 * sharpness)) ** (0.5 / sharpness)

    doubts = mg.identify(arm, *[x | {"i1": short(x["i1"])} for x in logs]).to_json()["doubts"]
    assert any(x.startswith("The efforts of shoulder fall short of the model's") for x in doubts)
    assert not any("elbow" in x for x in doubts)


def test_an_effort_of_which_nothing_is_explained_is_asked_about(arm: mg.Arm, logs: list[Table]) -> None:
    random = np.random.default_rng(5)
    other = np.sin(17.0 * logs[0]["t"]) + 0.1 * random.normal(size=len(logs[0]["t"]))
    doubts = mg.identify(arm, logs[0] | {"i2": other}, logs[1]).to_json()["doubts"]
    assert any("of the changes of the effort of elbow unexplained" in x for x in doubts)
    noise = 0.02 * random.normal(size=(2, len(logs[0]["t"])))
    doubts = mg.identify(arm, logs[0] | {"i2": logs[0]["i2"] + noise[0]}, logs[1]).to_json()["doubts"]
    assert not any("unexplained" in x for x in doubts)


def test_noise_that_hides_an_effort_is_called_noise(arm: mg.Arm) -> None:
    """Noise slower than the cut-off passes the filter, but it does not repeat with the motion."""
    random = np.random.default_rng(7)
    logs = [log(arm, seed, beside=1.0) for seed in (1, 2)]
    slow = np.convolve(random.normal(size=2 * 2000 + 49), np.ones(50) / np.sqrt(50), mode="valid")
    noise = 0.8 * slow.reshape(2, 2000)
    noisy = [x | {"i2": x["i2"] + e} for x, e in zip(logs, noise, strict=True)]
    doubts = mg.identify(arm, *noisy).to_json()["doubts"]
    assert not any("unexplained" in x for x in doubts)
    assert (
        sum("of elbow" in x and "differ from one period of the motion to the next" in x for x in doubts) == 1
    )
    # What repeats is none of it.
    other = np.sin(17.0 * np.pi / 5.0 * logs[0]["t"]) + 0.1 * random.normal(size=2000)
    doubts = mg.identify(arm, logs[0] | {"i2": other}, logs[1]).to_json()["doubts"]
    assert any("of the changes of the effort of elbow unexplained" in x for x in doubts)


@pytest.mark.parametrize("name", WRONG)
@pytest.mark.parametrize("command", ["identify", "diagnose"])
def test_a_log_that_was_read_wrongly_is_asked_about(
    command: str, name: str, arm: mg.Arm, logs: list[Table]
) -> None:
    change, said = WRONG[name]
    train, test = [change(x) for x in logs]
    with pytest.raises(mg.InputError, match=re.escape(said)):
        getattr(mg, command)(arm, train, test)


def test_a_reading_that_explains_hardly_less_is_asked_about_too() -> None:
    """Degrees are those of a motor behind a gear of 57, by the log alone."""
    geared = loads(ARMS.replace("ratio: 50", "ratio: 57"), "arms.yaml", known_effects())["two"]
    train, test = [x | {"q1": np.degrees(x["q1"])} for x in (log(geared, 1), log(geared, 2))]
    with pytest.raises(mg.InputError, match="are the positions in degrees") as error:
        mg.identify(geared, train, test)
    assert "are the positions q1 those of the motors" in str(error.value)


def test_the_log_as_it_is_raises_no_doubt(arm: mg.Arm, logs: list[Table]) -> None:
    found = mg.identify(arm, *logs)
    assert found.to_json()["doubts"] == []
    assert found.test is not None
    assert (found.test.nrmse_percent < 2.0).all()


@pytest.mark.parametrize(
    ("right", "wrong", "said"),
    [
        ("mass: 2,", "mass: 0.1,", "The weight at elbow comes out 20"),
        ("mass: 4,", "mass: 0.4,", "The efforts are those of 9.5 times the nominal link shoulder"),
        ("[0.15, 0.02, 0]", "[150, 20, 0]", "The weight at elbow comes out 0.001"),
        ("[0, -9.81, 0]", "[0, 9.81, 0]", "The weight at shoulder comes out -1 times"),
        (
            "ratio: 30, torque_constant: 0.05",
            "ratio: 30, torque_constant: 0.5",
            "The weight at elbow comes out 10",
        ),
    ],
)
def test_a_result_far_from_the_nominal_links_is_asked_about(
    right: str, wrong: str, said: str, logs: list[Table]
) -> None:
    other = loads(ARMS.replace(right, wrong), "arms.yaml", known_effects())["two"]
    found = mg.identify(other, *logs)
    assert any(doubt.startswith(said) for doubt in found.to_json()["doubts"])
    assert said in found.to_json()["verdict"]


@pytest.mark.parametrize("mass", [2, 7])  # a nominal mass is no measured one
def test_a_link_not_far_from_its_nominal_self_is_no_doubt(mass: int, logs: list[Table]) -> None:
    other = loads(ARMS.replace("mass: 4,", f"mass: {mass},"), "arms.yaml", known_effects())["two"]
    assert mg.identify(other, *logs).to_json()["doubts"] == []


def words(page: str) -> str:
    """What a page says, without its markup."""
    return " ".join(re.sub("<[^>]+>", " ", page).split())


def test_an_inertia_below_zero_is_called_impossible(arm: mg.Arm, logs: list[Table]) -> None:
    """Efforts that lag by a quarter of a second look like an inertia below zero, which is said first."""
    late = [x | {k: np.roll(x[k], 25) for k in ("i1", "i2")} for x in logs]
    found = mg.identify(arm, *late)
    doubts, verdict = found.to_json()["doubts"], found.to_json()["verdict"]
    (doubt,) = (doubt for doubt in doubts if doubt.startswith("Impossible: the inertia at "))
    joints = doubt.removeprefix("Impossible: the inertia at ").partition(" comes out")[0]
    assert verdict.startswith(f"Physically impossible values at {joints}: do not use the parameters")
    assert found.shown()[-1] == verdict
    assert "Physically impossible values at" in repr(found)
    page = found.files()["report.html"]
    first = re.split("<dt[^>]*>", page)[1]  # the answer to the first question
    said = words(first)
    assert 0 < said.index("Physically impossible values") < said.index("parameters are determined to")
    assert "modelgen generate" not in words(page)  # no code from such values
    right = mg.identify(arm, *logs)
    assert "mpossible" not in right.files()["report.html"] + right.to_json()["verdict"] + repr(right)
    assert "modelgen generate" in words(right.files()["report.html"])


@pytest.mark.parametrize("turned", [("i1", "i2"), ("i2",)])
@pytest.mark.parametrize("consistent", [False, True])
def test_efforts_counted_the_other_way_are_refused(
    turned: tuple[str, ...], consistent: bool, arm: mg.Arm, logs: list[Table]
) -> None:
    wrong = [x | {k: -x[k] for k in turned} for x in logs]
    with pytest.raises(mg.InputError) as refused:
        mg.identify(arm, *wrong, consistent=consistent)
    joints = "elbow" if turned == ("i2",) else "shoulder, elbow"
    assert f"friction at {joints} comes out below zero, and inertia or weight" in str(refused.value)
    assert "is their sign the other way round, or that of torque_constant?" in str(refused.value)


def test_friction_below_zero_is_a_doubt(arm: mg.Arm, logs: list[Table]) -> None:
    """A shoulder that something drives the harder the faster it turns."""
    driven = [x | {"i1": x["i1"] - 0.5 * np.sign(np.gradient(x["q1"]))} for x in logs]
    doubts = mg.identify(arm, *driven).to_json()["doubts"]
    assert any("below zero, which would drive shoulder." in doubt for doubt in doubts)


def test_diagnose_has_the_doubts_of_identify(logs: list[Table]) -> None:
    other = loads(ARMS.replace("mass: 2,", "mass: 0.1,"), "arms.yaml", known_effects())["two"]
    found = mg.diagnose(other, *logs, experiment=False, effects=["friction_offset:1"])
    (doubt,) = found.to_json()["doubts"]
    assert doubt.startswith("The weight at elbow comes out 20")
    assert doubt in found.shown()


@pytest.mark.parametrize(("command", "noise"), [("identify", 0.0), ("identify", 1e-5), ("diagnose", 0.0)])
def test_a_joint_that_stands_in_one_record_is_left_out_there(
    command: str, noise: float, arm: mg.Arm, logs: list[Table]
) -> None:
    """A second record with the elbow held teaches of the shoulder, and does not spoil the elbow."""
    held = standing(arm, logs[0])
    held["q2"] = held["q2"] + noise * np.random.default_rng(3).normal(size=len(held["t"]))
    more: dict[str, Any] = (
        {"experiment": False, "effects": ["friction_offset:1"]} if command == "diagnose" else {}
    )
    found = getattr(mg, command)(arm, [logs[0], held], logs[1], **more)
    remarks = found.to_json()["log"]["remarks"]
    assert any("left out for elbow, at rest throughout" in remark for remark in remarks)
    nominal = model_of(arm).nominal
    for name in ("MX1R", "MX2", "ZZ2"):
        assert found.parameters[name].value == pytest.approx(nominal[name], rel=0.05)
    with pytest.raises(mg.InputError, match=r"joint elbow stands at 0\.4(, but for noise of .*,)? in all"):
        getattr(mg, command)(arm, [held, held | {"i1": held["i1"] + 1e-9}], logs[1], **more)


def standing(arm: mg.Arm, table: Table) -> Table:
    """The shoulder's motion with the elbow at 0.4 rad, held by a brake without any current."""
    t = table["t"]
    q = np.column_stack([table["q1"], np.full(len(t), 0.4)])
    dq = np.gradient(q, t, axis=0, edge_order=2)
    ddq = np.gradient(dq, t, axis=0, edge_order=2)
    model = model_of(arm)
    values = np.array(list(model.nominal.values()))
    current = np.asarray(model.functions["inverse_dynamics"](q=q, dq=dq, ddq=ddq, parameters=values))
    noise = 1e-3 * np.random.default_rng(9).normal(size=len(t))
    return {"t": t, "q1": q[:, 0], "q2": q[:, 1], "i1": current[:, 0] + noise, "i2": np.zeros(len(t))}


def test_a_spring_that_the_model_lacks_is_not_taken_for_another_reading(
    arm: mg.Arm, logs: list[Table]
) -> None:
    """Of small positions the model is linear in them, which explains a spring: no question of units."""
    sprung = [x | {"i2": x["i2"] + 2.0 * x["q2"]} for x in logs]
    found = mg.identify(arm, *sprung)
    assert found.test is not None
    assert found.test.nrmse_percent[1] > 15.0


def test_consistent_parameters_hide_no_question(arm: mg.Arm, logs: list[Table]) -> None:
    late = [x | {k: np.roll(x[k], 25) for k in ("i1", "i2")} for x in logs]
    found = mg.identify(arm, *late, consistent=True)
    assert any("sign of the efforts the other way round" in doubt for doubt in found.to_json()["doubts"])


def test_what_is_assumed_of_a_payload_without_a_place_is_asked(arm: mg.Arm, logs: list[Table]) -> None:
    found = mg.identify(arm, *logs, payload={"0": 0.5})
    assert any("at the origin of the last link's frame: where is it?" in x for x in found.to_json()["doubts"])
    placed = mg.identify(arm, *logs, payload={"0": (0.5, 0.1, 0.0, 0.0)})
    assert not any("where is it?" in x for x in placed.to_json()["doubts"])


@pytest.mark.parametrize("share", [0.6, 0.9])
def test_what_is_cut_off_of_an_effort_is_left_out(share: float, arm: mg.Arm, logs: list[Table]) -> None:
    train, test = logs
    top = share * float(np.abs(train["i1"]).max())
    cut = train | {"i1": np.clip(train["i1"], -top, top)}
    found, truth = mg.identify(arm, cut, test), model_of(arm).nominal
    assert any("it seems to be cut off there" in x for x in found.to_json()["log"]["remarks"])
    for name, e in found.parameters.items():
        assert abs(e.value - truth[name]) < 5 * e.std, name


def test_a_diagnosis_names_nothing_for_what_is_cut_off(arm: mg.Arm, logs: list[Table]) -> None:
    train, test = logs
    top = 0.6 * float(np.abs(train["i1"]).max())
    cut = [x | {"i1": np.clip(x["i1"], -top, top)} for x in (train, log(arm, 3))]
    effects = ["torque_constant_saturation:1", "friction_offset:1", "load_dependent_friction:1"]
    found = mg.diagnose(arm, cut, test, experiment=False, effects=effects)
    assert found.to_json()["causes"] == []


@pytest.mark.parametrize("step", [0.01, 0.25, 1.0])
def test_coarse_currents_are_not_cut_off(step: float, arm: mg.Arm, logs: list[Table]) -> None:
    coarse = [{k: step * np.rint(x / step) if k[0] == "i" else x for k, x in t.items()} for t in logs]
    found = mg.identify(arm, *coarse)
    assert not any("constant" in doubt or "fall short" in doubt for doubt in found.to_json()["doubts"])
    assert not any("cut off" in remark for remark in found.to_json()["log"]["remarks"])
    truth = model_of(arm).nominal
    hits = [abs(e.value - truth[name]) < 3 * e.std for name, e in found.parameters.items()]
    assert sum(hits) >= len(hits) - 1


def test_friction_below_zero_is_possible_where_another_law_of_it_is_above() -> None:
    """As found at a UR10's first joint: a power of the speed less a part that is in proportion to it."""
    below = Estimate("FV1", -19.8, 2.0, "N m s/rad", True, joint=1, standard="FV1")
    power = Estimate("FN1", 55.9, 2.6, "N m", True, joint=1, standard="FN1")
    v = np.linspace(0.0, 0.9, 50)  # rad/s, of its motion
    assert (power.value * (v / 0.975) ** 0.41 + below.value * v >= 0.0).all()
    assert driving([below, power]) == []
    elsewhere = replace(power, name="FN2", standard="FN2", joint=2)
    turned = replace(power, value=-55.9)
    dry = Estimate("FC1", 8.0, 0.9, "N m", True, joint=1, standard="FC1")
    assert driving([below]) == driving([below, dry]) == [below]
    assert driving([below, elsewhere]) == driving([below, turned]) == [below]
