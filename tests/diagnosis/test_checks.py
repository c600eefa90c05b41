"""A cause is named only where every check that decides lets it: the same checks for all."""

from dataclasses import replace
from importlib import import_module
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
from diagnosis_support import ARM, PERIOD, equations_of, made, offset, system_of, three
from threshold_decisions import elastic_while

from modelgen.dataset import Record
from modelgen.description import DirectDrive
from modelgen.diagnosis.adequacy import explained as explaining
from modelgen.diagnosis.adequacy.checks import (
    Examined,
    admissible,
    confirmed,
    ended_by_suspects,
    significant,
)
from modelgen.diagnosis.adequacy.dominance import dominance
from modelgen.diagnosis.adequacy.figures_said import significance
from modelgen.diagnosis.adequacy.smooth_functions import SmoothFunction, functions
from modelgen.diagnosis.candidates import Candidate, FittedCandidate, with_causes
from modelgen.diagnosis.equations import Unknowns
from modelgen.diagnosis.options.thresholds import USUAL
from modelgen.diagnosis.pipeline import diagnose
from modelgen.diagnosis.result import to_json
from modelgen.diagnosis.selection import Cause, Ranked, Selection
from modelgen.diagnosis.validation import Check
from modelgen.effects import CATALOGUE

NAMES = ["evidence", "significant", "admissible", "gain", "undominated", "form", "explains"]
REPORTED = ["stable", "confirmed"]


def test_every_cause_has_the_same_checks_and_passes_those_that_decide() -> None:
    said = to_json(diagnose(ARM, three("stribeck_friction", 2, 0.5), experiment=False))
    (cause,) = said["causes"]
    assert (cause["effect"], cause["joint"], cause["joint_name"]) == ("stribeck_friction", 2, "j2")
    assert [c["name"] for c in cause["checks"]] == NAMES + REPORTED
    assert all(c["passed"] for c in cause["checks"])
    assert [c["name"] for c in cause["checks"] if not c["decides"]] == REPORTED
    assert said["suspects"] == []


def with_force(records: list[Record], joint: int, law: Any) -> list[Record]:
    """The records with an effort more at a joint, as its motor sees it."""
    found = []
    for r in records:
        given = np.asarray(r.input).copy()
        dq = np.gradient(r.q, r.step, axis=0)
        given[:, joint - 1] += law(r.q[:, joint - 1], dq)
        found.append(replace(r, input=given))
    return found


@pytest.mark.parametrize("joint", [1, 2])
def test_a_law_outside_the_catalogue_lends_its_evidence_to_no_name(joint: int) -> None:
    """A product of the speed's sine, the position's cosine and the other joint's speed."""
    records = three(None, 1, 0.0, seed=11)
    size = 0.25 * float(np.std(np.asarray(records[0].input)[:, joint - 1]))
    other = 2 - joint

    def law(q: np.ndarray, dq: np.ndarray) -> np.ndarray:
        return np.asarray(size * np.sin(4.0 * dq[:, joint - 1]) * np.cos(5.0 * q) * dq[:, other])

    found = diagnose(ARM, with_force(records, joint, law), experiment=False)
    assert not found.causes
    assert found.verdict in ("suspected", "outside_catalogue")


def test_a_gain_that_fades_is_no_friction_that_warms_up() -> None:
    """A drive that gives a fifth more effort when it is cold: friction is a part of that alone."""
    records = []
    for r in three(None, 1, 0.0, seed=12):
        given = np.asarray(r.input).copy()
        given[:, 0] *= 1.0 + 0.2 * np.exp(-(r.t - r.t[0]) / 12.0)
        records.append(replace(r, input=given))
    found = diagnose(ARM, records, experiment=False)
    assert not found.causes
    (failed,) = (
        c
        for suspect in found.suspects
        if (suspect.effect, suspect.joint) == ("friction_warm_up", 1)
        for c in suspect.checks
        if c.decides and c.passed is False
    )
    assert failed.name == "form"
    assert "a free function of the joint's effort and the time" in failed.text


@pytest.mark.parametrize("repeats", [True, False])
@pytest.mark.parametrize(("wave", "passed"), [(0.0, True), (1.6, False)])
def test_a_law_that_leaves_much_of_what_is_not_noise_lends_it_no_name(
    wave: float, passed: bool, repeats: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A constant beside a wave over the position, that no cause explains; in noise of unit size."""
    rows, q, periods = made(lambda x: 0.6 + wave * np.sin(5.0 * x))
    if not repeats:
        rows, periods = [replace(r, prepared=PREPARED) for r in rows], [None] * len(periods)
        by_place = SmoothFunction("by place", {0: functions(q, 0.2)})
        monkeypatch.setattr(explaining, "smooth_functions", lambda system: [by_place])
        monkeypatch.setattr(explaining, "shapes_at", lambda j, equations: [])
    equations, bare = equations_of(rows, periods), system_of(rows, periods=periods)
    columns = [np.ones_like(x[:, :1])[:, None] for x in q]
    gain = bare.gain(columns)
    assert gain is not None
    trial = FittedCandidate(Candidate("friction_offset", 1), {}, columns, gain)
    system = system_of(rows, with_causes(equations, [trial]), periods)
    (check,) = explaining.explained(Selection([Cause(trial, gain.delta_bic, 5.0, 5.0)], system, []), {})
    assert check.decides
    assert check.passed is passed
    assert gain.delta_bic > 20.0  # it has evidence all the same


@pytest.mark.parametrize("harmonic", [0.25, 1.0 / 3.0, 2.0])
def test_a_wave_of_a_gear_s_stage_is_a_ripple(harmonic: float) -> None:
    """A planet's carrier turns once in three or four turns of the motor."""
    ratio = 80.0

    def law(q: np.ndarray, dq: np.ndarray) -> np.ndarray:
        return np.asarray(0.05 * np.sin(harmonic * ratio * q + 0.4))

    found = diagnose(ARM, with_force(three(None, 1, 0.0, seed=12), 1, law), experiment=False)
    (cause,) = found.causes
    assert (cause.effect, cause.joint) == ("torque_ripple", 1)
    found_there = cause.parameters["harmonic"]
    assert found_there.std is not None
    assert abs(found_there.value - harmonic) < 4.0 * found_there.std < 0.1 * harmonic


def turn(*candidates: tuple[str, int | None, float, str, bool]) -> list[Ranked]:
    return [
        Ranked(effect, joint, evidence, 5.0, 5.0, refused, taken)
        for effect, joint, evidence, refused, taken in candidates
    ]


def chosen(*turns: list[Ranked], effect: str = "friction_offset", joint: int = 1) -> tuple[Cause, Selection]:
    """A cause with an evidence of 100 that was taken in these turns."""
    rows, q, periods = made(offset)
    system = system_of(rows, periods=periods)
    columns = [offset(x[:, 0])[:, None, None] for x in q]
    gain = system.gain(columns)
    assert gain is not None
    trial = FittedCandidate(Candidate(effect, joint), {}, columns, replace(gain, delta_bic=100.0))
    cause = Cause(trial, 100.0, 5.0, 5.0)
    # Records with efforts: of a free motion nothing is held against a cause.
    driven: Any = equations_of([replace(r, prepared=PREPARED) for r in rows], [PERIOD] * len(rows))
    object.__setattr__(system, "equations", driven)
    return cause, Selection([cause], system, list(turns))


class _Prepared:
    input = np.zeros(1)


PREPARED: Any = _Prepared()
OWN = ("friction_offset", 1, 100.0, "", True)


@pytest.mark.parametrize(
    ("other", "dominated"),
    [
        (("time_delay", None, 120.0, "gain", False), True),  # what explains most was refused
        (("presliding", 1, 120.0, "positions", False), True),
        (("presliding", 1, 120.0, "values", False), False),  # it cannot be there itself
        (("joint_flexibility", 1, 120.0, "values", False), True),  # it swings, by whatever values
        (("joint_flexibility", 2, 120.0, "values", False), False),
        (("presliding", 2, 120.0, "gain", False), False),  # at another joint
        (("time_delay", None, 112.0, "gain", False), False),  # not clearly ahead
        (("time_delay", None, 120.0, "evidence", False), False),  # asks for more evidence itself
        (("presliding", 1, 120.0, "near rest", False), False),
    ],
)
def test_the_runner_up_is_not_the_name(
    other: tuple[str, int | None, float, str, bool], dominated: bool
) -> None:
    found = dominance(*chosen(turn(OWN, other)))
    assert (found.ahead > found.most) == dominated
    if dominated:
        assert found.place == other[:2]


@pytest.mark.parametrize(("constant", "dominated"), [(104.0, True), (96.0, False)])
def test_a_law_varies_only_where_the_constant_one_explains_less(constant: float, dominated: bool) -> None:
    """Where positions could feign the constant law, and not what fades, the latter is no more its name."""
    own = ("friction_warm_up", 1, 100.0, "", True)
    refused = ("coulomb_friction", 1, constant, "positions", False)
    elsewhere = ("coulomb_friction", 2, 200.0, "positions", False)
    found = dominance(*chosen(turn(own, refused, elsewhere), effect="friction_warm_up"))
    assert (found.ahead > found.most) == dominated


def test_what_is_refused_in_the_end_is_held_against_the_cause_too() -> None:
    found = dominance(*chosen(turn(OWN), turn(("presliding", 1, 130.0, "gain", False))))
    assert found.ahead == pytest.approx(30.0)


@pytest.mark.parametrize(("joint", "ended"), [(1, True), (2, False)])
def test_a_suspect_ends_the_naming_at_its_joint(joint: int, ended: bool) -> None:
    """What is found beside a suspect, and at its joint, has no name either."""
    cause, _ = chosen(turn(OWN))
    place = Candidate("asymmetric_viscous_friction", joint)
    later = replace(cause, trial=replace(cause.trial, candidate=place), delta_bic=60.0)
    checks = [Check("undominated", passed, True, 0.0, 15.0, "") for passed in (False, True)]
    first, second = ended_by_suspects([Examined(cause, (checks[0],)), Examined(later, (checks[1],))])
    assert first.failed
    assert [c.value for c in second.failed] == ([40.0] if ended else [])


@pytest.mark.parametrize("slow", [True, False])
def test_an_elastic_joint_that_shows_only_near_rest_is_a_form_of_friction(slow: bool) -> None:
    form = elastic_while(USUAL, slow)
    assert form.slow
    assert form.as_good == slow


@pytest.mark.parametrize("guessed", [True, False])
def test_a_law_whose_form_is_a_guess_ends_the_naming(guessed: bool) -> None:
    """A fluid about an arm whose end nobody knows leaves what other laws follow."""
    cause, _ = chosen(turn(OWN))
    end = {"tip_x": 0.4, "tip_y": 0.0, "tip_z": 0.0} if guessed else {}
    fluid = Candidate("fluid_drag", None, end)
    first = replace(cause, trial=replace(cause.trial, candidate=fluid))
    every = [Examined(one, (Check("undominated", True, True, 0.0, 15.0, ""),)) for one in (first, cause)]
    drag, beside = ended_by_suspects(every)
    assert not drag.failed
    assert bool(beside.failed) == guessed


@pytest.mark.parametrize(
    ("effect", "values", "possible"),
    [
        ("friction_warm_up", {"time": 1.4}, False),
        ("friction_warm_up", {"time": 20.0}, True),
        ("friction_warm_up", {"time": 20.0, "dry": -0.1, "speed": 10.0}, False),
        ("friction_warm_up", {"time": 20.0, "dry": -0.1, "viscous": 0.02, "speed": 10.0}, True),
        (
            "torque_ripple",
            {"harmonic": 1.0 / 80.0, "revolution": 2 * np.pi},
            False,
        ),  # one wave a turn: gravity
        ("torque_ripple", {"harmonic": 1.0, "revolution": 2 * np.pi}, True),
        ("spring", {"stiffness": 3.0}, True),
        ("payload_change", {"mass": 0.5, "x": 0.6, "y": 0.6}, True),
        ("payload_change", {"mass": 0.5, "x": 0.7, "y": 0.7}, False),  # of an arm of 0.45 m
    ],
)
def test_values_that_no_arm_has(effect: str, values: dict[str, float], possible: bool) -> None:
    assert isinstance(ARM.joints[0].drive, DirectDrive)
    assert ARM.joints[0].drive.ratio == 80.0
    assert (CATALOGUE[effect].impossible(ARM, 1, values) == "") == possible


@pytest.mark.parametrize(
    ("mass", "moment", "passed"),
    [
        (0.0, 2.0, False),
        (-0.5, 2.0, False),
        (0.5, 2.0, True),
        (0.5, 0.0, True),
        (0.06, 2.0, False),
        (0.06, 0.0, False),
    ],
)
def test_a_payload_has_a_mass(mass: float, moment: float, passed: bool) -> None:
    """In noise of unit size and 1200 rows the deviations of mass and moment are 0.03. Moments alone may be
    those of a tilt, or of an encoder that was set anew between two records.
    """
    random = np.random.default_rng(4)
    rows, _, periods = made(lambda x: 0.0 * x)
    columns = [random.normal(size=(len(r.effort), 1, 2)) for r in rows]
    own = Unknowns(np.zeros(2), np.eye(2))
    loaded = [
        replace(r, effort=r.effort + c @ np.array([mass, moment]), baseline=own)
        for r, c in zip(rows, columns, strict=True)
    ]
    bare = system_of(loaded, periods=periods)
    gain = bare.gain(columns)
    assert gain is not None
    trial = FittedCandidate(Candidate("payload_change", None, part=("mass", "moment_x")), {}, columns, gain)
    system = system_of(loaded, with_causes(bare.equations, [trial]), periods)
    described = replace(system.equations, evaluator=SimpleNamespace(arm=ARM))
    check = significant(0, Selection([Cause(trial, gain.delta_bic, 5.0, 5.0)], system, []), described)
    assert (check.name, check.decides, check.passed) == ("significant", True, passed)


@pytest.mark.parametrize(("mass", "shown"), [({"mass": 0.0}, False), ({"mass": 2.0}, True)])
def test_a_payload_without_a_mass_is_none_however_clear_its_place(
    mass: dict[str, float], shown: bool
) -> None:
    """A mass that stays at zero has no deviation: of its place alone nothing follows."""
    evidence: Any = None  # is not asked
    trial = FittedCandidate(Candidate("payload_change", None, part=("mass", "moment_x")), {}, [], evidence)
    spread = {"x": 0.01} | ({"mass": 0.1} if shown else {})
    found, text = significance(trial, ARM, {"x": 0.3, **mass}, spread)
    assert (found > 3.0) == shown
    assert ("does not show in these records" in text) != shown


@pytest.mark.parametrize(("compliance", "passed"), [(0.05, False), (0.3, True)])
def test_an_elastic_joint_is_not_as_good_as_rigid(
    compliance: float, passed: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """In noise of unit size and 1200 rows the deviation of the reciprocal of the stiffness is 0.03, whatever
    the stiffness that the search left it with.
    """
    random = np.random.default_rng(6)
    rows, _, periods = made(lambda x: 0.0 * x)
    shapes = [random.normal(size=(len(r.effort), 1, 1)) for r in rows]
    own = Unknowns(np.zeros(2), np.eye(2))
    soft = [
        replace(r, effort=r.effort + compliance * c[:, :, 0], baseline=own)
        for r, c in zip(rows, shapes, strict=True)
    ]

    def simulated(candidate: Candidate, values: dict[str, float], *of: Any, **more: Any) -> list[np.ndarray]:
        return [c / values["stiffness"] for c in shapes]

    measured = import_module("modelgen.diagnosis.selection.elastic_fit")
    monkeypatch.setattr(measured, "at_links", lambda *_: False)
    for module in ("deviations", "elastic_fit", "refit_elastic"):
        where = import_module(f"modelgen.diagnosis.selection.{module}")
        monkeypatch.setattr(where, "candidate_columns", simulated)
    bare = system_of(soft, periods=periods)
    searched = {"stiffness": 2.0 / compliance, "relaxation": 0.005}
    columns = simulated(Candidate("joint_flexibility", 1), searched)
    gain = bare.gain(columns)
    assert gain is not None
    trial = FittedCandidate(Candidate("joint_flexibility", 1), searched, columns, gain)
    system = system_of(soft, with_causes(bare.equations, [trial]), periods)
    model = SimpleNamespace(grouping=SimpleNamespace(base=()))
    described = replace(system.equations, evaluator=SimpleNamespace(arm=ARM), model=model)
    check = significant(0, Selection([Cause(trial, 20.0, 5.0, 5.0)], system, []), described)
    assert (check.name, check.decides, check.passed) == ("significant", True, passed)
    assert check.value == pytest.approx(compliance / 0.03, rel=0.15, abs=1.5)


def test_the_test_record_confirms_or_does_not_and_decides_nothing() -> None:
    for low, passed in ((0.5, True), (-0.5, False), (float("nan"), None)):
        check = confirmed(1.0, low)
        assert (check.passed, check.decides) == (passed, False)


def test_a_joint_that_a_value_means_is_called_by_its_name() -> None:
    cause, _ = chosen(effect="viscous_friction")
    pair = Candidate("transmission_coupling", 2, {"other": 1.0, "ratio": -1.0}, part=("dry",))
    gain = replace(cause.trial.gain, values=np.array([0.5]))
    trial = replace(cause.trial, candidate=pair, values={}, gain=gain)
    equations: Any = SimpleNamespace(arm=ARM, n=2, rows=[], thresholds=USUAL)
    check = admissible(replace(cause, trial=trial), equations)
    assert check.passed
    assert "other is j1;" in check.text
    assert "dry is 0.500 N m, may be 0" in check.text
    assert "ratio is -1.00, may be" in check.text


@pytest.mark.parametrize(("surplus", "passed"), [(-0.5, True), (-1.998, False), (-1.0, False)])
def test_a_cause_whose_value_no_arm_has_beside_the_others_is_not_admissible(
    surplus: float, passed: bool
) -> None:
    """Efforts of the other sign look like a torque constant below zero; no stand-in for that is shown."""
    cause, _ = chosen(effect="viscous_friction")
    alone, beside = (
        replace(
            cause.trial,
            candidate=Candidate("drive_gain_error", 2),
            values={},
            gain=replace(cause.trial.gain, values=np.array([x])),
        )
        for x in (0.002, surplus)
    )
    equations: Any = SimpleNamespace(arm=ARM, n=2, rows=[], thresholds=USUAL)
    check = admissible(replace(cause, trial=alone), equations, beside)
    assert check.decides
    assert check.passed is passed
    assert "99999" not in check.text
    assert ("error beyond what it may be, -0.9" in check.text) is not passed


def check_of_delay(joint: int | None, delay: float, joints: int, hold: float, known: str) -> Check:
    """The check of a delay [s]. hold: of the log [s], whose sampling period is 0.01 s; known: from what."""
    cause, _ = chosen(effect="time_delay")
    found = replace(cause.trial.gain, values=np.array([delay]))
    trial = replace(
        cause.trial, candidate=Candidate("time_delay", joint), values={"delay": delay}, gain=found
    )
    record = SimpleNamespace(step=0.01, hold=hold, hold_known=known)
    rows = [SimpleNamespace(prepared=SimpleNamespace(record=record))]
    equations: Any = SimpleNamespace(arm=ARM, n=joints, rows=rows, thresholds=USUAL)
    check = admissible(replace(cause, trial=trial), equations)
    assert check.decides
    return check


@pytest.mark.parametrize(
    ("joint", "delay", "passed"),
    [
        (2, 0.004, False),  # channels read one after the other within a sample
        (2, -0.0099, False),
        (2, 0.0101, True),
    ],
)
def test_a_delay_of_one_joint_within_a_sample_may_be_the_log_s(
    joint: int, delay: float, passed: bool
) -> None:
    check = check_of_delay(joint, delay, 2, 0.005, "")
    assert check.passed == passed
    assert passed or "is less than a sample of 0.01 s" in check.text


@pytest.mark.parametrize("known", ["", "data", "mapping"])
@pytest.mark.parametrize(
    ("hold", "delay", "passed"),
    [
        (0.005, -0.005, False),  # the log reads both at one instant
        (0.0, 0.005, False),  # a controller's output, held
        (0.0, -0.005, False),
        (-0.005, 0.01, False),
        (0.0, 0.0145, False),
        (0.005, 0.0145, True),  # no log is so late
        (-0.005, -0.0076, True),  # none is earlier than the interval before
        (0.0, 0.05, True),
    ],
)
def test_a_delay_of_all_joints_that_a_log_may_have_is_the_log_s(
    hold: float, delay: float, passed: bool, known: str
) -> None:
    check = check_of_delay(None, delay, 2, hold, known)
    assert check.passed == passed
    assert passed or "`hold` of the mapping says when" in check.text


@pytest.mark.parametrize("joint", [None, 1])
@pytest.mark.parametrize(("known", "passed"), [("mapping", True), ("", False), ("data", False)])
def test_of_a_single_joint_the_mapping_says_whose_a_delay_is(
    known: str, passed: bool, joint: int | None
) -> None:
    assert check_of_delay(joint, 0.007, 1, 0.0, known).passed == passed
