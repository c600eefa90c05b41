"""Filters, derivatives, the hold, parallel filtering: against closed forms."""

import numpy as np
import pytest

from modelgen.dataset.filters import advanced, differences, low_pass


@pytest.mark.parametrize("half_width", [1, 2, 3])
def test_differences_are_exact_for_polynomials_of_their_order(half_width: int) -> None:
    t = np.linspace(-1.0, 1.0, 41)
    power = 2 * half_width
    first, second = differences(t[:, None] ** power, t[1] - t[0], half_width)
    inner = slice(half_width, -half_width)
    assert first[inner, 0] == pytest.approx(power * t[inner] ** (power - 1), abs=1e-12)
    assert second[inner, 0] == pytest.approx(power * (power - 1) * t[inner] ** (power - 2), abs=1e-10)


def test_the_low_pass_has_no_phase_and_halves_the_cut_off() -> None:
    t = np.arange(0.0, 20.0, 1e-3)
    wave = np.cos(2 * np.pi * 5.0 * t + 0.3)[:, None]
    filtered = low_pass(wave, 5.0, 1e3, 4)
    assert filtered[5000:-5000] == pytest.approx(0.5 * wave[5000:-5000], abs=1e-5)


@pytest.mark.parametrize("delay", [0.5, -0.5, 0.3, 2.25, -1.0])
def test_a_late_sample_is_moved_back_to_its_stamp(delay: float) -> None:
    k = np.arange(200.0)
    moved = advanced(np.cos(0.1 * (k + delay))[:, None], delay, held=False)
    # Cubic interpolation: error below 3/128 of the fourth difference.
    assert moved[5:-5, 0] == pytest.approx(np.cos(0.1 * k[5:-5]), abs=3 / 128 * 0.1**4 * 1.01)


@pytest.mark.parametrize("side", [1, -1])
def test_a_held_sample_gives_what_its_staircase_holds_at_low_frequencies(side: int) -> None:
    k = np.arange(400.0)
    w = 2 * np.pi / 40
    moved = advanced(np.cos(w * k)[:, None], side / 2, held=True)
    # The fundamental of the staircase: its Fourier integral over one period, by fine sampling.
    fine = np.arange(0, 40, 1 / 256) + 1 / 512
    staircase = np.cos(w * (np.floor(fine) if side > 0 else np.ceil(fine)))
    c, s = (2 * np.mean(staircase * f(w * fine)) for f in (np.cos, np.sin))
    assert moved[5:-5, 0] == pytest.approx(c * np.cos(w * k[5:-5]) + s * np.sin(w * k[5:-5]), abs=1e-5)
