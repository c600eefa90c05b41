"""One rule for efforts that are cut off: of whole logs, of logs that are streamed, and with payloads."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from identification_support import model_of

import modelgen as mg
from modelgen.dataset import Settings, Stream, choose, read
from modelgen.description import loads
from modelgen.effects import known_effects
from modelgen.identification.cut_off import without_cut_off
from modelgen.identification.cut_off_streamed import streamed_limits

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
RATE = 100.0
Table = dict[str, np.ndarray]


@pytest.fixture(scope="module")
def arm() -> mg.Arm:
    return loads(ARMS, "arms.yaml", known_effects())["two"]


def loaded(mass: float, place: tuple[float, float]) -> mg.Arm:
    """The arm whose elbow's link carries a point mass at x, y, by the theorem of Huygens and Steiner."""
    own, at, more = np.array([0.15, 0.02]), np.array(place), 2.0 + mass
    com = (2.0 * own + mass * at) / more
    inertia = 0.02 + 2.0 * ((own - com) ** 2).sum() + mass * ((at - com) ** 2).sum()
    text = ARMS.replace(
        "{mass: 2, com: [0.15, 0.02, 0], inertia: [0.005, 0, 0, 0.02, 0, 0.02]}",
        f"{{mass: {more}, com: [{com[0]}, {com[1]}, 0], inertia: [0.005, 0, 0, 0.02, 0, {inertia}]}}",
    )
    assert text != ARMS
    return loads(text, "arms.yaml", known_effects())["two"]


def log(arm: mg.Arm, seed: int, seconds: float = 20.0, growing: float = 0.0) -> Table:
    """The arm as described. growing: part of its motion that comes with time."""
    random, t = np.random.default_rng(seed), np.arange(round(seconds * RATE)) / RATE
    w = 2 * np.pi * np.outer([0.1, 0.2, 0.3, 0.5], [1.0, 1.1])
    size, phase = random.uniform(0.1, 0.4, w.shape), random.uniform(0, 6, w.shape)
    angle = t[:, None, None] * w + phase
    q, dq, ddq = ((size * w**k * np.sin(angle + k * np.pi / 2)).sum(axis=1) for k in range(3))
    g, slope = (1.0 - growing + growing * t / seconds)[:, None], growing / seconds
    q, dq, ddq = g * q, g * dq + slope * q, g * ddq + 2 * slope * dq
    model = model_of(arm)
    values = np.array(list(model.nominal.values()))
    current = np.asarray(model.functions["inverse_dynamics"](q=q, dq=dq, ddq=ddq, parameters=values))
    current = current + 1e-3 * random.normal(size=current.shape)
    return {"t": t, "q1": q[:, 0], "q2": q[:, 1], "i1": current[:, 0], "i2": current[:, 1]}


def cut(table: Table, share: float, step: float = 0.0) -> Table:
    """The log with the shoulder's current cut off at a share of its highest, in steps."""
    current = step * np.rint(table["i1"] / step) if step else table["i1"]
    top = share * float(np.abs(current).max())
    return table | {"i1": np.clip(current, -top, step * np.rint(top / step) if step else top)}


def written(table: Table, path: Path) -> str:
    rows = np.column_stack(list(table.values()))
    np.savetxt(path, rows, fmt="%.12g", delimiter=",", header=",".join(table), comments="")
    return str(path)


@pytest.mark.parametrize(("growing", "step"), [(0.0, 0.0), (0.6, 0.0), (0.0, 0.1), (0.6, 0.1)])
def test_blocks_leave_out_what_the_whole_log_does(
    growing: float, step: float, arm: mg.Arm, tmp_path: Path
) -> None:
    """Also where the motion grows, and blocks at its beginning have highest readings of their own."""
    file = written(cut(log(arm, 1, 80.0, growing), 0.7, step), tmp_path / "a.csv")
    settings = Settings(cutoff=4.0)
    whole = read(file, arm)
    ((record,), _) = without_cut_off([whole], [], choose(whole, settings), arm)
    assert record.cut_off is not None
    assert 0.02 < record.cut_off[:, 0].mean() < 0.6
    stream = Stream(file, arm, settings, block=1000)
    limits = streamed_limits([stream], arm)
    assert len(stream) >= 5
    flags = np.zeros_like(record.cut_off)
    for block in stream.records():
        found = limits.without(block).cut_off
        assert found is not None
        assert block.core is not None
        part = slice(*block.core)
        flags[block.first + part.start : block.first + part.stop] = found[part]
    trimmed = slice(stream.settings.trimmed(whole.step), -stream.settings.trimmed(whole.step))
    assert np.mean(flags[trimmed] != record.cut_off[trimmed]) < 0.01
    assert limits.remarks
    assert "the effort of shoulder is cut off at" in limits.remarks[0]


def test_a_streamed_log_that_is_cut_off_gives_what_the_arm_has(arm: mg.Arm, tmp_path: Path) -> None:
    train = written(cut(log(arm, 1, 80.0), 0.7), tmp_path / "a.csv")
    test = written(log(arm, 2), tmp_path / "b.csv")
    truth = model_of(arm).nominal
    for stream in (False, True):
        found = mg.identify(arm, train, test, stream=stream)
        for name, e in found.parameters.items():
            assert abs(e.value - truth[name]) < 5 * e.std, (stream, name)
        said = found.to_json()["log"]["remarks"]
        assert any("the effort of shoulder is cut off at" in x for x in said)


def test_a_streamed_log_is_asked_what_a_whole_one_is(arm: mg.Arm, tmp_path: Path) -> None:
    right, test = log(arm, 1, 30.0), written(log(arm, 2), tmp_path / "b.csv")
    for change, said in (
        ({"q2": -right["q2"]}, "are the positions of elbow counted the other way"),
        ({"i1": -right["i1"]}, "friction at shoulder comes out below zero"),
        ({"i1": right["i2"], "i2": right["i1"]}, "efforts of joints shoulder and elbow exchanged"),
    ):
        train = written(right | change, tmp_path / "a.csv")
        for stream in (False, True):
            with pytest.raises(mg.InputError, match=said):
                mg.identify(arm, train, test, stream=stream)


@pytest.mark.parametrize("share", [0.6, 0.8])
def test_what_is_cut_off_with_a_payload_is_left_out(share: float, arm: mg.Arm) -> None:
    """A record with the payload, and one without, both cut off: parameters are those of the arm."""
    light, heavy = cut(log(arm, 1), share), cut(log(loaded(0.8, (0.2, 0.05)), 3), share)
    found = mg.identify(arm, [light, heavy], log(arm, 2), payload={"1": (0.8, 0.2, 0.05, 0.0)})
    truth = model_of(arm).nominal
    for name, e in found.parameters.items():
        assert abs(e.value - truth[name]) < 5 * e.std, name
    said = [x for x in found.to_json()["log"]["remarks"] if "the effort of shoulder is cut off at" in x]
    assert len(said) == 2


def test_an_effort_that_is_cut_off_nearly_always_is_refused(arm: mg.Arm) -> None:
    train = log(arm, 1)
    low = float(np.quantile(train["i1"], 0.02))
    with pytest.raises(mg.InputError, match=r"efforts are cut off, that of shoulder at .* do not determine"):
        mg.identify(arm, train | {"i1": np.minimum(train["i1"], low)}, log(arm, 2))
