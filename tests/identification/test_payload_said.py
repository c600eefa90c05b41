"""A payload that the user names is in the record that he says, and as heavy: the efforts know better."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from geared_link import LINK, GearedLink, sines
from numpy.random import default_rng

import modelgen as mg
from modelgen.description import loads

MASS, AT = 0.8, 0.4  # kg, m along the link
LOADED = replace(LINK, moment=LINK.moment + MASS * AT, inertia=LINK.inertia + MASS * AT**2)


def log(link: GearedLink, seed: int) -> dict[str, np.ndarray]:
    """A record of two periods at 200 Hz."""
    random = default_rng([11, seed])
    t = np.arange(0.0, 16.0, 0.005)
    q, dq, ddq = sines(t, random.uniform(0.0, 2 * np.pi, 4))
    noise = random.normal(size=len(t))
    return {"t": t, "q1": q, "i1": link.currents(q, dq, ddq) + 0.02 * noise}


@pytest.mark.parametrize(
    ("links", "said", "shown"),
    [
        ((LOADED, LINK, LINK), {"0": MASS}, None),
        ((LOADED, LOADED, LINK), {"0": MASS, "1": MASS}, None),
        ((LOADED, LOADED, LOADED), {"0": MASS, "1": MASS}, None),  # a part of the link, for all that is known
        ((LINK, LOADED, LOADED), {"0": MASS}, -MASS),
        ((LINK, LINK, LINK), {"0": MASS}, 0.0),
        ((LOADED, LINK, LINK), {"0": 1.25 * MASS}, MASS),
        ((LOADED, LINK, LOADED), {"0": MASS, "1": MASS}, 0.0),
    ],
)
def test_a_payload_that_the_efforts_deny_is_asked_about(
    links: tuple[GearedLink, ...], said: dict[str, float], shown: float | None
) -> None:
    """Two training records, and one to test."""
    arm = loads(LINK.description())["one"]
    logs = [log(link, k) for k, link in enumerate(links)]
    payload = {number: (mass, AT, 0.0, 0.0) for number, mass in said.items()}
    found = mg.identify(arm, logs[:2], logs[2], payload=payload)
    asked = [x for x in found.to_json()["doubts"] if "beside the other training records" in x]
    assert len(asked) == (shown is not None), found.to_json()["doubts"]
    if shown is not None:
        figure, _, rest = asked[0].partition("its efforts show ")[2].partition(" ± ")
        assert float(figure) == pytest.approx(shown, abs=max(5 * float(rest.split(" ")[0]), 0.02 * MASS))
