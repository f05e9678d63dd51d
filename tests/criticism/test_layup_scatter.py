"""Lay-up scatter: every channel sees the same random shift."""

import numpy as np
import pytest

from geomdrap.criticism.scatter import SEES, Smoothness, radial, scatter_covariance

KINDS = list(Smoothness)


@pytest.mark.parametrize("kind", KINDS)
def test_slopes_of_the_correlation_are_those_of_differences(kind):
    r = np.linspace(1.0, 90.0, 60)
    h = 1e-4
    k, g, second = radial(r, 30.0, kind)
    slope = (radial(r + h, 30.0, kind)[0] - radial(r - h, 30.0, kind)[0]) / (2 * h)
    np.testing.assert_allclose(g, -slope / r, rtol=1e-5, atol=1e-12)
    slope = (radial(r + h, 30.0, kind)[1] - radial(r - h, 30.0, kind)[1]) / (2 * h)
    np.testing.assert_allclose(second, -slope / r, rtol=1e-5, atol=1e-12)
    assert radial(np.zeros(1), 30.0, kind)[0][0] == 1.0


@pytest.mark.parametrize("kind", KINDS)
def test_shear_and_turns_are_the_slopes_of_the_shift(kind):
    # the covariance of a channel at x with a shift at y is the difference quotient of that of shifts
    rng = np.random.default_rng(0)
    x, y = rng.uniform(-50.0, 50.0, (2, 2))
    h = 1e-4

    def shifts(a, b):
        return scatter_covariance(np.array([a, b]), ("along", "across"), np.ones((2, 2), bool), 30.0, kind)

    # values come channel by channel: along at a, along at b, across at a, across at b
    east, north = np.array([h, 0.0]), np.array([0.0, h])
    along_v = (shifts(x + north, y)[0, 1] - shifts(x - north, y)[0, 1]) / (2 * h)
    across_u = (shifts(x + east, y)[2, 3] - shifts(x - east, y)[2, 3]) / (2 * h)
    mask = np.array([[False, False, True, True, True], [True, True, False, False, False]])
    got = scatter_covariance(np.array([x, y]), ("along", "across", "shear", "warp", "weft"), mask, 30.0, kind)
    along, across, shear, warp, weft = range(5)
    degree = np.degrees(1.0)
    assert got[shear, along] == pytest.approx(degree * along_v, rel=1e-6)
    assert got[shear, across] == pytest.approx(degree * across_u, rel=1e-6)
    assert got[warp, across] == pytest.approx(degree * across_u, rel=1e-6)
    assert got[weft, along] == pytest.approx(-degree * along_v, rel=1e-6)
    assert got[warp, along] == got[weft, across] == 0.0


@pytest.mark.parametrize("kind", KINDS)
def test_it_is_a_covariance(kind):
    rng = np.random.default_rng(1)
    at = rng.uniform(-100.0, 100.0, (40, 2))
    got = scatter_covariance(at, tuple(SEES), rng.random((40, 6)) < 0.8, 25.0, kind)
    np.testing.assert_allclose(got, got.T, atol=1e-12)
    assert np.linalg.eigvalsh(got).min() > -1e-9 * got.max()


def test_the_turn_of_the_warp_less_that_of_the_weft_is_the_shear():
    at = np.random.default_rng(2).uniform(-100.0, 100.0, (10, 2))
    channels = ("shear", "warp", "weft")
    got = scatter_covariance(at, channels, np.ones((10, 3), bool), 25.0, Smoothness.SMOOTH)
    difference = np.hstack([-np.eye(10), np.eye(10), -np.eye(10)])
    np.testing.assert_allclose(difference @ got @ difference.T, 0.0, atol=1e-9 * got.max())
