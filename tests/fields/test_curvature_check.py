"""The curvature check of every run comes to nothing on smooth parts at a fine pitch, quadratically."""

import pytest

import geomdrap as gd
from geomdrap.surface import shapes

NEAR_TOP = (7.0, -11.0, 200.0)
SMOOTH = {  # the part, the seed, and its fine pitch, mm
    "sphere cap": (lambda: shapes.sphere_cap(100.0, 60.0, 2.0), NEAR_TOP, 2.0),
    "hemisphere": (lambda: shapes.hemisphere(75.0, 1.0), NEAR_TOP, 2.0),
    "hemisphere on a flange": (lambda: shapes.hemisphere_on_flange(50.0, 10.0, 20.0, 1.0), NEAR_TOP, 1.0),
    "saddle": (lambda: shapes.saddle(300.0, 200.0, 2.0), (7.0, -11.0, 0.0), 4.0),
    "cylinder": (lambda: shapes.cylinder(100.0, 200.0, 2.0, 180.0), (7.0, -11.0, 99.0), 4.0),
    "torus": (lambda: shapes.torus(120.0, 50.0, 1.0, angle=90.0), "centroid", 2.0),
    "cone beside its tip": (lambda: shapes.cone(0.5, 100.0, 2.0, sectors=24), (-30.0, -24.0, -18.0), 2.0),
    "crowned L": (lambda: shapes.l_shape(300.0, 150.0, 300.0, 2.0), "centroid", 4.0),
    "double dome": (lambda: shapes.double_dome(edge=2.0), "centroid", 2.0),
    "hood": (lambda: shapes.car_hood(edge=8.0), (33.34, -0.31, 23.12), 8.0),
    "bracket": (lambda: shapes.bracket(edge=2.0), "centroid", 2.0),
}
MESH = 0.07  # degrees: below, the facets show rather than the pitch


def residual(part, origin, pitch):
    checks = gd.evaluate(gd.drape(part, origin, 20.0, pitch, project=True)).checks
    assert checks.edge_error < 5e-9  # to which a cell is closed, see SETTLED in fishnet/cell.py
    return checks.curvature_residual


@pytest.mark.slow
@pytest.mark.parametrize("name", SMOOTH)
def test_the_shear_is_the_curvature_within_a_tenth_of_a_degree_and_of_second_order(name):
    make, origin, pitch = SMOOTH[name]
    part = make()
    fine = residual(part, origin, pitch)
    assert fine <= 0.1
    if name != "cone beside its tip":  # all of its curvature is in one point: within a cell of it there is no order
        twice, four_times = (residual(part, origin, k * pitch) for k in (2.0, 4.0))
        assert fine <= max(twice / 2.8, MESH)
        assert twice <= max(four_times / 2.7, MESH)  # coarse against the radii: on the way to second order


@pytest.mark.parametrize("name", ["sphere cap", "saddle", "cylinder"])
def test_the_shear_is_the_curvature_on_simple_parts(name):
    make, origin, pitch = SMOOTH[name]
    assert residual(make(), origin, pitch) <= 0.03
