"""The shipped recording is what the simulated arm gives, and small."""

from pathlib import Path

import numpy as np

from hidden.cases import RECORDS, Case, Hidden, make


def test_the_shipped_recording_comes_from_the_plant(checkout: Path, tmp_path: Path) -> None:
    shipped = checkout / "examples" / "diagnosis"
    assert sum(path.stat().st_size for path in shipped.iterdir()) < 3e6
    hidden = (Hidden("load_dependent_friction", 2, 1.5, magnitude=0.6956231879294291),)
    label = make(Case("levered3", 7, hidden, rate=250.0, name="digger"), tmp_path)
    assert abs(label.strength[0] - 1.5) < 0.05
    text = (tmp_path / "arms.yaml").read_text()
    for number, name in enumerate(("boom", "stick", "bucket"), 1):
        text = text.replace(f"- name: j{number}\n", f"- name: {name}\n").replace(
            f"      j{number}:\n", f"      {name}:\n"
        )
    assert text == (shipped / "arms.yaml").read_text()
    for name in RECORDS[:3]:
        made, kept = (
            np.loadtxt(folder / f"{name}.csv", delimiter=",", skiprows=1) for folder in (tmp_path, shipped)
        )
        # Another libm may round a coordinate to the next count, which the controller then answers.
        np.testing.assert_allclose(made[:, 1:4], kept[:, 1:4], atol=20)
        assert np.abs(made[:, 4:] - kept[:, 4:]).max() < 0.05 * np.abs(kept[:, 4:]).max()
