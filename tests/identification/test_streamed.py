"""A log read block by block gives what it gives as a whole."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from simulation_support import middle, shipped
from typer.testing import CliRunner

import modelgen.identification.rows
from modelgen.cli.app import app
from modelgen.dataset import Stream, prepare, read
from modelgen.identification import identify, identify_streamed
from modelgen.simulation import Reference, computed_torque, simulate


def write_log(path: Path, seconds: float, seed: int) -> None:
    """ariane4 simulated under computed torque, with noise in its currents."""
    made = shipped("ariane4")
    rng = np.random.default_rng(seed)
    t = np.arange(round(seconds * 100) + 1) / 100
    a, b = rng.uniform(-0.08, 0.08, (2, 4, 3))
    w = 2 * np.pi * 0.2 * np.arange(1, 5)
    q = middle(made) + np.einsum("kj,kt->tj", a, np.sin(np.outer(w, t)))
    q += np.einsum("kj,kt->tj", b, np.cos(np.outer(w, t)))
    reference = Reference(t, q)
    found = simulate(
        made, q[0], reference.at(0.0)[1], seconds, 200.0, computed_torque(made, reference, 8.0), step=1e-3
    )
    assert not found.ended
    current = found.input + 0.02 * found.input.std(axis=0) * rng.normal(size=found.input.shape)
    table = np.column_stack([found.t, found.q, current])
    np.savetxt(path, table, delimiter=",", header="t,q1,q2,q3,i1,i2,i3", comments="")


def test_blocks_give_the_parameters_of_the_whole(tmp_path: Path) -> None:
    log, held = tmp_path / "train.csv", tmp_path / "test.csv"
    write_log(log, 40.0, 1)
    write_log(held, 10.0, 2)
    arm = shipped("ariane4").arm
    stream = Stream(str(log), arm, None, None, block=2000)
    assert len(stream) > 2
    calls = []
    test = [prepare(read(str(held), arm), stream.settings)]
    blocks = identify_streamed([stream], arm, test=test, progress=lambda *x: calls.append(x))
    whole = identify([prepare(read(str(log), arm), stream.settings)], arm, test=test)
    size = np.array([e.std or np.inf for e in whole.estimates])
    one, two = (np.array([e.value for e in x.estimates]) for x in (blocks, whole))
    np.testing.assert_allclose(one, two, rtol=1e-8)
    ours = np.array([e.std or np.inf for e in blocks.estimates])
    # Blocks cut the autocorrelation at their seams, and many rows need no correction for what the fit takes.
    np.testing.assert_allclose(ours, size, rtol=0.15)
    assert calls[-1] == (len(stream), len(stream))
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(modelgen.identification.rows, "compiler", lambda: None)
        patch.setattr(modelgen.identification.streamed, "KEPT", 0)
        calls.clear()
        slow = identify_streamed([stream], arm, test=test, progress=lambda *x: calls.append(x))
    assert calls[-1] == (3 * len(stream), 3 * len(stream))  # so few blocks are all a part
    for a, b in zip(blocks.estimates, slow.estimates, strict=True):
        assert (a.value, a.std) == pytest.approx((b.value, b.std), rel=1e-9)
    out = tmp_path / "out"
    done = CliRunner().invoke(
        app,
        [
            "identify",
            "--arm",
            "ariane4",
            "--train",
            str(log),
            "--test",
            str(held),
            "--stream",
            "--out",
            str(out),
            "--json",
        ],
    )
    assert done.exit_code == 0, done.stderr
    data = json.loads((out / "identification.json").read_text())
    assert [p["name"] for p in data["parameters"]] == [e.name for e in whole.estimates]
    refused = CliRunner().invoke(
        app, ["identify", "--arm", "ariane4", "--train", str(log), "--stream", "--out", str(out)]
    )
    assert refused.exit_code == 2
    assert "--test" in refused.stderr
