"""Trends, likeness of neighbours, curvature: against exact values and against chance."""

from __future__ import annotations

import numpy as np
import pytest
from analytic_tools import measured

import geomdrap as gd
from geomdrap.criticism.compare_places import vertex_curvature
from geomdrap.criticism.compare_structure import morans_index
from geomdrap.criticism.compare_trends import rank_correlation
from geomdrap.measurement.local import neighbours
from geomdrap.surface import shapes


def _grid(n=16, spacing=10.0):
    u, v = (x.ravel() * spacing for x in np.mgrid[:n, :n])
    return np.column_stack([u, v])


def _smooth(places, rng, length=50.0, count=3):
    """Random smooth fields (n, count) with that correlation length."""
    apart = np.linalg.norm(places[:, None] - places, axis=2)
    root = np.linalg.cholesky(np.exp(-((apart / length) ** 2)) + 1e-8 * np.eye(len(places)))
    return root @ rng.normal(size=(len(places), count))


def test_the_curvature_of_a_sphere_is_one_over_its_radius_and_positive_outside():
    sphere = shapes.icosphere(50.0, 5)
    np.testing.assert_allclose(vertex_curvature(sphere), 1 / 50.0, rtol=0.03)
    np.testing.assert_allclose(vertex_curvature(sphere).mean(), 1 / 50.0, rtol=0.01)
    np.testing.assert_allclose(vertex_curvature(sphere.flipped()), -1 / 50.0, rtol=0.03)


def test_the_curvature_of_a_cylinder_is_that_across_its_axis():
    tube = shapes.cylinder(40.0, 100.0, 3.0)
    np.testing.assert_allclose(np.median(vertex_curvature(tube)), 1 / 40.0, rtol=0.02)


def test_a_plane_has_no_curvature():
    np.testing.assert_allclose(vertex_curvature(shapes.plane(100.0, 80.0, 10.0)), 0.0, atol=1e-12)


def test_equal_ranks_correlate_fully_and_reversed_ones_negatively():
    places = _grid()
    x = np.random.default_rng(0).normal(size=len(places))
    assert rank_correlation(x, np.exp(x), places)[0] == pytest.approx(1.0)
    rho, p, _ = rank_correlation(x, -(x**3), places)
    assert rho == pytest.approx(-1.0)
    assert p < 1e-6


def test_the_p_value_of_independent_noise_is_uniform():
    places, rng = _grid(), np.random.default_rng(0)
    p = [rank_correlation(*rng.normal(size=(2, len(places))), places)[1] for _ in range(200)]
    assert np.mean(np.array(p) < 0.05) == pytest.approx(0.05, abs=0.04)
    assert np.mean(p) == pytest.approx(0.5, abs=0.07)


def test_smooth_fields_that_have_nothing_to_do_with_each_other_are_rarely_called_related():
    """A test for independent points finds a relation in half of these."""
    from scipy.stats import spearmanr

    places, rng = _grid(14), np.random.default_rng(1)
    fields = _smooth(places, rng, count=200)
    pairs = [(fields[:, k], fields[:, k + 1]) for k in range(0, 200, 2)]
    p = np.array([rank_correlation(x, y, places)[1] for x, y in pairs])
    naive = np.array([spearmanr(x, y).pvalue for x, y in pairs])
    assert np.mean(naive < 0.05) > 0.4
    assert np.mean(p < 0.05) < 0.12
    assert np.mean(p < 0.01) < 0.06


def test_a_relation_of_smooth_fields_is_still_seen():
    places, rng = _grid(16), np.random.default_rng(2)
    fields = _smooth(places, rng, length=20.0, count=2)
    _, p, independent = rank_correlation(fields[:, 0], fields[:, 0] + 0.3 * fields[:, 1], places)
    assert p < 1e-3
    assert independent < len(places) / 2


@pytest.mark.parametrize("width", [1, 3])
def test_morans_index_of_noise_has_mean_0_and_the_spread_said(width):
    places, rng = _grid(), np.random.default_rng(0)
    near = neighbours(places, 8)
    z = np.array([i / s for i, s in (morans_index(rng.normal(size=(len(places), width)), near) for _ in range(400))])
    assert np.mean(z) == pytest.approx(0.0, abs=0.15)
    assert np.std(z) == pytest.approx(1.0, abs=0.12)


def test_morans_index_does_not_depend_on_the_axes():
    places, rng = _grid(), np.random.default_rng(0)
    near = neighbours(places, 8)
    values = _smooth(places, rng)
    turn, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    np.testing.assert_allclose(morans_index(values @ turn, near), morans_index(values, near), rtol=1e-9)


def test_springback_grows_with_the_shear_and_leaves_the_positions_alone():
    surface, m, laid = measured("springback")
    c = gd.compare(surface, m, **laid)
    trend = next(t for t in c.trends if (t.kind, t.against) == ("shear", "shear"))
    assert trend.rho > 0.7
    assert trend.p < 1e-4
    assert (np.diff(trend.rms)[2:] > 0).all()
    assert c.structure.shear.p < 1e-6
    assert c.structure.position.p > 0.01


def test_bins_hold_all_points_and_their_mean_square_is_the_whole():
    surface, m, laid = measured("steering")
    c = gd.compare(surface, m, **laid)
    for trend in c.trends:
        assert trend.kind in ("position", "shear")
        size = c.size if trend.kind == "position" else np.abs(c.shear)
        kept = c.trusted & np.isfinite(size)
        assert trend.n.sum() == kept.sum()
        assert np.sum(trend.n * trend.rms**2) == pytest.approx(np.sum(size[kept] ** 2))
