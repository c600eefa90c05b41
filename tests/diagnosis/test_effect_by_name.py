"""Every effect of the catalogue can be asked for by its name, on logs that repeat, on logs that do not and on
free motions: the diagnosis has an answer, or says in one line why it has none.
"""

from functools import cache
from typing import Any

import numpy as np
import pytest

import modelgen as mg
from modelgen.dataset import Record
from modelgen.description import loads
from modelgen.diagnosis.equations import Study, study_of
from modelgen.diagnosis.extended import extend
from modelgen.diagnosis.options import Options
from modelgen.diagnosis.pipeline import decided
from modelgen.diagnosis.result import reported, to_json
from modelgen.effects import CATALOGUE, known_effects
from modelgen.errors import InputError

HEAD = "schema: 1\nconvention: khalil_kleinfinger\narms:\n  boom:\n"
LINKS = """
    links:
      lift: {mass: 4, com: [0.3, 0.02, 0], inertia: [0.01, 0, 0, 0.3, 0, 0.3]}
      stick: {mass: 2, com: [0.2, 0.0, 0.01], inertia: [0.01, 0, 0, 0.1, 0, 0.1]}
"""
DRIVEN = f"""{HEAD}
    gravity: [0, 0, -9.81]
    joints:
      - name: lift
        alpha: pi/2
        d: 0.1
        drive: {{type: levered, l1: 0.32, l2: 0.06, length: [0.27, 0.36], motor: [0, 20000], rev: 1,
                offset: -60 deg, torque_constant: 1.0e-4}}
        effects: [viscous_friction: {{coefficient: 2.0e-6}}, coulomb_friction: {{magnitude: 1.0e-4}}]
      - name: stick
        d: 0.4
        drive: {{type: direct, ratio: 60, torque_constant: 0.05}}
        effects: [viscous_friction: {{coefficient: 1.0e-3}}, coulomb_friction: {{magnitude: 0.02}}]
{LINKS}"""
SWINGING = f"""{HEAD}
    gravity: [9.81, 0, 0]
    joints:
      - {{name: lift, effects: [viscous_friction: {{coefficient: 0.05}}]}}
      - {{name: stick, d: 0.4, effects: [coulomb_friction: {{magnitude: 0.01}}]}}
{LINKS}"""
RATE, DURATION = 100, 8.0
KINDS = {"periodic": (1, 2, 3), "not repeated": (0.93, 2**0.5, np.pi), "free": ()}  # multiples of 1/4 Hz


def driven(arm: mg.Arm, multiples: tuple[float, ...], seed: int) -> Record:
    """A log of currents that the model gives for a sum of sines, with noise of half a percent."""
    random = np.random.default_rng(seed)
    size, phase = random.normal(scale=0.15, size=(2, 3)), random.uniform(0.0, 6.28, (2, 3))
    t = np.arange(0.0, DURATION, 1 / RATE)
    w = 2 * np.pi / 4.0 * np.array(multiples)

    def motion(t: np.ndarray) -> list[np.ndarray]:
        waves = np.exp(1j * (np.multiply.outer(t, w)[:, None] + phase)) * size
        parts = [(waves * (1j * w) ** k).sum(axis=2).imag for k in range(3)]
        return [parts[0] + [0.3, 0.0], *parts[1:]]

    model = mg.build_model(arm)
    assert model.nominal is not None
    given = model.functions["inverse_dynamics"](*motion(t + 0.5 / RATE), model.nominal)
    given = given * (1.0 + 0.005 * random.normal(size=given.shape))
    q = motion(t)[0]
    return mg.read_log({"t": t, "q1": q[:, 0], "q2": q[:, 1], "i1": given[:, 0], "i2": given[:, 1]}, arm)


def swinging(arm: mg.Arm, seed: int) -> Record:
    """A log of positions after a release."""
    start = f"{30 - 10 * seed} deg, {20 + 10 * seed} deg"
    found = mg.simulate(arm, q0=start, duration=3.0, rate=RATE)
    table = np.genfromtxt(found.table().splitlines(), delimiter=",", names=True)
    return mg.read_log({name: table[name] for name in ("t", "q1", "q2")}, arm)


@cache
def study(kind: str) -> Study:
    """Two training records and a test record of the kind."""
    text = DRIVEN if KINDS[kind] else SWINGING
    arm = loads(text, "arms.yaml", known_effects())["boom"]
    records = [driven(arm, KINDS[kind], k) if KINDS[kind] else swinging(arm, k) for k in range(3)]
    return study_of(arm, records, Options())


def answered(effect: str, kind: str) -> dict[str, Any] | str:
    """diagnosis.json of the effect alone, or why there is none."""
    options = Options(effects=((effect, None),))
    try:
        decision = decided(study(kind), options)
        extension = extend(study(kind).evaluator.arm, decision.selection, decision.band.equations)
        return to_json(reported(study(kind), decision, extension, options))
    except InputError as error:
        return str(error)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("effect", CATALOGUE)
def test_there_is_an_answer_or_a_reason(effect: str, kind: str) -> None:
    answer = answered(effect, kind)
    if isinstance(answer, str):
        assert answer.startswith(f"--effect {effect}: ")
        assert "\n" not in answer
        return
    assert {r["effect"] for turn in answer["ranking"] for r in turn} <= {effect}
    assert {c["effect"] for c in (*answer["causes"], *answer["suspects"])} <= {effect}
    # where nothing repeats no lack of fit is measured: what is not found is not said to be absent
    assert answer["verdict"] in ("cannot_tell", "suspected", "named") or kind == "periodic"
