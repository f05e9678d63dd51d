"""Shear that stops at an angle, and shear that does not."""

import numpy as np
import pytest

from geomdrap.criticism.plateau import plateau

NOISE = 0.6
MODEL = np.random.default_rng(0).uniform(-24.0, 24.0, 300)


def seen(shear, seed=1):
    return shear + np.random.default_rng(seed).normal(0.0, NOISE, len(shear))


def test_shear_that_stops_is_found_at_its_angle():
    found = plateau(seen(np.clip(MODEL, -12.0, 12.0)), MODEL, NOISE)
    assert found is not None
    assert found.angle == pytest.approx(12.0, abs=0.4)
    assert found.sigma < 0.5


@pytest.mark.parametrize("seed", range(20))
@pytest.mark.parametrize("share", [1.0, 0.8, 0.6])
def test_shear_that_is_only_less_everywhere_has_no_plateau(share, seed):
    assert plateau(seen(share * MODEL, seed), MODEL, NOISE) is None


def test_shear_below_the_angle_says_nothing():
    assert plateau(seen(0.3 * MODEL), 0.3 * MODEL, NOISE) is None
    assert plateau(np.zeros(3), np.zeros(3), NOISE) is None


def test_points_without_shear_do_not_matter():
    measured = seen(np.clip(MODEL, -12.0, 12.0))
    measured[::5] = np.nan
    assert plateau(measured, MODEL, NOISE) is not None


def test_a_plateau_that_few_marks_reach_is_found():
    model = np.concatenate([np.random.default_rng(2).normal(0.0, 7.0, 280), np.linspace(29.0, 42.0, 14)])
    found = plateau(seen(np.clip(model, -26.0, 26.0)), model, NOISE)
    assert found is not None
    assert found.angle == pytest.approx(26.0, abs=0.8)


@pytest.mark.parametrize("seed", range(10))
def test_shear_that_is_only_scattered_has_no_plateau(seed):
    scattered = MODEL + np.random.default_rng(seed).normal(0.0, 1.5, len(MODEL))
    assert plateau(scattered, MODEL, 1.5) is None
    assert plateau(scattered, MODEL, NOISE) is None
