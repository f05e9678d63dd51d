"""The checks of every run find what they are there to find."""

from dataclasses import replace

import numpy as np
import pytest

import geomdrap as gd
from geomdrap.fields.checks import curvature_residual, edge_error, off_surface
from geomdrap.fields.trim import trim
from geomdrap.surface import shapes


@pytest.fixture(scope="module")
def net():
    return gd.drape(shapes.sphere_cap(100.0, 60.0, 4.0), (0.0, 0.0, 100.0), 13.0, 5.0)


def moved(net, shift):
    """The net with the node nearest to u = v = 30 mm moved by hand."""
    points = net.points.copy()
    i, j = np.argmin(abs(net.u - 30.0)), np.argmin(abs(net.v - 30.0))
    points[i, j] += shift
    return replace(net, points=points, lattice=points)


def test_a_sound_net_passes(net):
    checks = gd.evaluate(net).checks
    assert checks.edge_error < 1e-6
    assert checks.off_surface < 1e-9
    assert checks.curvature_residual < 0.1


@pytest.mark.parametrize("amount", [0.01, 0.5])
def test_a_node_shifted_along_the_surface_lengthens_a_side(net, amount):
    along = net.points[np.argmin(abs(net.u - 35.0)), np.argmin(abs(net.v - 30.0))]
    here = net.points[np.argmin(abs(net.u - 30.0)), np.argmin(abs(net.v - 30.0))]
    way = (along - here) / np.linalg.norm(along - here)
    assert edge_error(moved(net, -amount * way)) == pytest.approx(amount / net.pitch, rel=0.2)


@pytest.mark.parametrize("amount", [0.001, 0.3])
def test_a_node_lifted_off_the_part_is_seen(net, amount):
    here = net.points[np.argmin(abs(net.u - 30.0)), np.argmin(abs(net.v - 30.0))]
    assert off_surface(moved(net, amount * here / 100.0)) == pytest.approx(amount, rel=0.05)


def test_a_node_moved_out_of_its_facet_is_seen(net):
    way = net.warp0 - (net.warp0 @ net.normal0) * net.normal0
    assert off_surface(moved(net, 20.0 * way)) > 5.0


def test_shear_that_the_curvature_does_not_explain_is_seen(net):
    trimmed = trim(net)
    true = curvature_residual(net, trimmed)
    wrong = replace(net)
    wrong.__dict__["shear"] = 1.1 * net.shear  # cached: stands for a net that shears too much
    found = curvature_residual(wrong, trimmed)
    assert found > 20.0 * true
    inner = np.abs(net.shear[1:-1, 1:-1])
    assert 0.05 * np.nanmax(inner) < found < 0.1 * np.nanmax(inner)


def test_a_net_without_the_parts_curvature_is_seen(net):
    # the fabric coordinates of another heading carry the deficits to other cells
    other = gd.drape(net.surface, (20.0, 0.0, 98.0), 13.0, 5.0, project=True)
    flat = gd.drape(shapes.plane(300.0, 300.0, 10.0), (0.0, 0.0, 0.0), 0.0, 5.0)
    faked = replace(flat)
    faked.__dict__["shear"] = np.degrees(np.outer(flat.u, flat.v) / 100.0**2)  # as on a sphere
    assert curvature_residual(faked, trim(flat)) > 10.0
    assert curvature_residual(flat, trim(flat)) < 1e-9
    assert gd.evaluate(other).checks.curvature_residual < 0.2


def test_the_curvature_is_not_checked_where_the_generators_do_not_cross_at_right_angles(net):
    skew = replace(net, fabric=replace(net.fabric, weft_angle=80.0))
    assert curvature_residual(skew, trim(net)) is None


def test_the_residual_falls_with_the_pitch_on_a_saddle():
    part = shapes.saddle(300.0, 300.0, 4.0)
    residuals = [
        gd.evaluate(gd.drape(part, (0.0, 0.0, 0.0), 13.0, pitch)).checks.curvature_residual for pitch in (20.0, 10.0)
    ]
    assert residuals[1] < 0.4 * residuals[0]
    assert residuals[1] < 0.02
