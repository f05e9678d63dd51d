"""The net on a sphere against the exact solution, from seeds anywhere."""

import numpy as np
import pytest
from exact_nets import anywhere_on_a_sphere, sphere_errors, sphere_shear
from scipy.integrate import solve_ivp

import geomdrap as gd
from geomdrap.surface import shapes

RADIUS = 100.0


def test_the_table_solves_the_equation_of_the_net():
    # (s γ')' = cos γ, γ(0) = 0, γ'(0) = 1
    found = solve_ivp(
        lambda s, y: [y[1] / s, np.cos(y[0])], [1e-9, 1.5], [1e-9, 1e-9], rtol=1e-11, atol=1e-13, dense_output=True
    )
    s = np.linspace(0.01, 1.5, 50)
    np.testing.assert_allclose(sphere_shear(s, [1.0], 1.0)[:, 0], np.degrees(found.sol(s)[0]), atol=1e-5)


@pytest.mark.parametrize(("level", "rms", "most"), [(6, 0.04, 0.15), (5, 0.10, 0.35)])
def test_the_shear_on_a_sphere_is_exact_from_any_seed(level, rms, most):
    surface = shapes.icosphere(RADIUS, level)
    rng = np.random.default_rng(2024)
    for _ in range(8):
        seed, angle = anywhere_on_a_sphere(rng, RADIUS)
        net = gd.drape(surface, seed, angle, RADIUS / 32, (RADIUS, RADIUS), project=True)
        assert net.points.shape == (65, 65, 3)
        assert np.isfinite(net.points).all()
        assert net.cell_valid.all()
        found = sphere_errors(net, RADIUS)
        assert found[0] <= rms
        assert found[1] <= most


@pytest.mark.slow
@pytest.mark.parametrize(("level", "rms", "most"), [(6, 0.04, 0.15), (5, 0.10, 0.35)])
def test_the_shear_on_a_sphere_is_exact_from_a_hundred_seeds(level, rms, most):
    surface = shapes.icosphere(RADIUS, level)
    rng = np.random.default_rng(7)
    found = []
    for _ in range(100):
        seed, angle = anywhere_on_a_sphere(rng, RADIUS)
        net = gd.drape(surface, seed, angle, RADIUS / 32, (RADIUS, RADIUS), project=True)
        assert net.cell_valid.all()
        found.append(sphere_errors(net, RADIUS))
    assert max(f[0] for f in found) <= rms
    assert max(f[1] for f in found) <= most


@pytest.mark.parametrize("seed", ["vertex:0", "vertex:40000", "edge", "middle of a face"])
def test_the_shear_on_a_sphere_is_exact_from_a_seed_on_the_mesh_itself(seed):
    surface = shapes.icosphere(RADIUS, 6)
    corners = surface.points[surface.triangles[1234]]
    place = {"edge": 0.5 * (corners[0] + corners[1]), "middle of a face": corners.mean(axis=0)}.get(seed, seed)
    net = gd.drape(surface, place, 31.0, RADIUS / 32, (RADIUS, RADIUS), project=True)
    assert net.cell_valid.all()
    rms, most = sphere_errors(net, RADIUS)
    assert rms <= 0.04
    assert most <= 0.15


def test_a_hemisphere_is_sheared_by_52_degrees_where_the_diagonal_meets_the_equator():
    # on the diagonal u = v the net reaches the equator where the shear is 52.43°
    surface = shapes.icosphere(RADIUS, 6)
    rng = np.random.default_rng(3)
    for _ in range(3):
        seed, angle = anywhere_on_a_sphere(rng, RADIUS)
        net = gd.drape(surface, seed, angle, RADIUS / 64, (1.2 * RADIUS, 1.2 * RADIUS), project=True)
        for su, sv in ((1, 1), (-1, 1), (-1, -1), (1, -1)):
            i0, j0 = int(np.argmin(abs(net.u))), int(np.argmin(abs(net.v)))
            steps = np.arange(min(i0, j0))
            i, j = i0 + su * steps, j0 + sv * steps
            height = net.points[i, j] @ seed / np.linalg.norm(seed)
            beyond = int(np.argmax(height < 0.0))
            share = height[beyond - 1] / (height[beyond - 1] - height[beyond])
            at = [net.shear[i[n], j[n]] for n in (beyond - 1, beyond)]
            assert su * sv * ((1 - share) * at[0] + share * at[1]) == pytest.approx(52.43, abs=0.5)


def test_no_cell_on_a_sphere_is_sheared_beyond_ninety_degrees():
    # the exact net folds at s = 1.8616, that is at u = v = 1.364 R
    surface = shapes.icosphere(RADIUS, 5)
    for seed, reach in (("vertex:77", 1.6), ("vertex:300", 1.4), ("vertex:12", 3.0)):
        net = gd.drape(surface, seed, 12.0, RADIUS / 40, (reach * RADIUS, reach * RADIUS))
        assert np.nanmax(abs(net.cell_shear)) < 90.0
        s = np.abs(np.outer(net.u, net.v)) / RADIUS**2
        assert np.isfinite(net.points[..., 0])[s < 1.4].all() or reach > 1.6


def test_the_shear_on_a_sphere_is_exact_almost_up_to_the_fold():
    surface = shapes.icosphere(RADIUS, 6)
    net = gd.drape(surface, "vertex:77", 12.0, RADIUS / 64, (1.25 * RADIUS, 1.25 * RADIUS))
    miss = net.shear - sphere_shear(net.u, net.v, RADIUS)
    assert np.isfinite(miss).all()
    assert np.nanmax(abs(miss[1:-1, 1:-1])) < 0.5
