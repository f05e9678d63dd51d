"""Lay-up scatter is a Gaussian field of the size and length asked for, and its slopes are its own."""

from __future__ import annotations

import numpy as np
import pytest

from geomdrap.blind.scatter import KINDS, random_shift


@pytest.mark.parametrize("kind", KINDS)
def test_slopes_are_those_of_the_shift(kind):
    uv = np.random.default_rng(0).uniform(-100.0, 100.0, (40, 2))
    slope = random_shift(np.random.default_rng(1), uv, 0.5, 35.0, kind).slope
    for axis in (0, 1):
        step = 1e-3 * np.eye(2)[axis]
        ahead, behind = (random_shift(np.random.default_rng(1), uv + s * step, 0.5, 35.0, kind) for s in (1, -1))
        assert slope[:, :, axis] == pytest.approx((ahead.value - behind.value) / 2e-3, abs=1e-7)


def test_the_standard_deviation_and_the_correlation_are_as_asked():
    uv = np.array([[0.0, 0.0], [35.0, 0.0], [0.0, 70.0]])
    draws = np.stack([random_shift(np.random.default_rng(n), uv, 0.5, 35.0).value[:, 0] for n in range(1500)])
    assert draws.std(axis=0) == pytest.approx(0.5, abs=0.03)
    correlation = np.corrcoef(draws.T)[0]
    assert correlation[1:] == pytest.approx(np.exp(-0.5 * np.array([1.0, 4.0])), abs=0.06)


def test_warp_and_weft_shift_independently():
    draws = np.stack([random_shift(np.random.default_rng(n), np.zeros((1, 2)), 0.5, 35.0).value[0] for n in range(800)])
    assert abs(np.corrcoef(draws.T)[0, 1]) < 0.12
