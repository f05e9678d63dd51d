"""Measured points and what a net says of them."""

from __future__ import annotations

import numpy as np
import pytest

import geomdrap as gd
from geomdrap.measurement.match import match
from geomdrap.measurement.rim import distance_to_rim
from geomdrap.surface import shapes


@pytest.fixture(scope="module")
def plane_net():
    return gd.drape(shapes.plane(200.0, 160.0, 10.0), (1.0, 2.0, 0.0), 30.0, 7.0)


@pytest.fixture(scope="module")
def cap_net():
    return gd.drape(shapes.sphere_cap(80.0, 60.0, 3.0), "centroid", 20.0, 6.0)


def _anywhere(net, n=200, seed=0):
    u, v = np.random.default_rng(seed).uniform(-40.0, 40.0, (2, n))
    points, shear = net.interpolate(u, v)
    known = np.isfinite(shear)
    return u[known], v[known], points[known], shear[known]


def test_directions_on_a_plane_are_the_heading_and_across(plane_net):
    warp, weft = plane_net.directions([3.0, -20.0], [8.0, 1.0])
    c, s = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    np.testing.assert_allclose(warp, [[c, s, 0]] * 2, atol=1e-6)
    np.testing.assert_allclose(weft, [[-s, c, 0]] * 2, atol=1e-6)


def test_the_angle_between_the_directions_is_that_of_the_shear(cap_net):
    u, v, _, shear = _anywhere(cap_net)
    warp, weft = cap_net.directions(u, v)
    between = 90.0 - np.degrees(np.arccos(np.einsum("ij,ij->i", warp, weft)))
    np.testing.assert_allclose(between, shear, atol=0.5)


def test_directions_are_unknown_where_points_are(cap_net):
    u, v = np.random.default_rng(1).uniform(-90.0, 90.0, (2, 400))
    points, _ = cap_net.interpolate(u, v)
    warp, weft = cap_net.directions(u, v)
    unknown = np.isnan(points[:, 0])
    assert 0 < unknown.sum() < 400
    np.testing.assert_array_equal(np.isnan(warp[:, 0]), unknown)
    np.testing.assert_array_equal(np.isnan(weft[:, 0]), unknown)


def test_a_node_on_any_side_of_a_ragged_net_is_read():
    net = gd.drape(shapes.sphere_cap(80.0, 60.0, 3.0), "centroid", 20.0, 6.0)
    valid = np.pad(net.cell_valid, 1)
    touched = valid[1:, 1:] | valid[:-1, 1:] | valid[1:, :-1] | valid[:-1, :-1]
    i, j = np.nonzero(touched)
    points, _ = net.interpolate(net.u[i], net.v[j])
    np.testing.assert_allclose(points, net.points[i, j], atol=1e-9)


def test_marks_are_matched_by_their_labels(cap_net):
    u, v, points, shear = _anywhere(cap_net)
    matched = match(cap_net, gd.Measurement("made", points + 5.0, u=u, v=v))
    assert matched.used.all()
    np.testing.assert_allclose(matched.point, points, atol=1e-12)
    np.testing.assert_allclose(matched.shear, shear, atol=1e-12)


def test_points_without_labels_are_found_on_the_net(cap_net):
    u, v, points, shear = _anywhere(cap_net)
    normal = cap_net.surface.normals[cap_net.surface.nearest(points).face]
    matched = match(cap_net, gd.Measurement("made", points + 0.4 * normal))
    assert matched.used.mean() > 0.97
    on = matched.used
    # the patch of a cell is a chord's height off the sphere, along whose normal the point was moved
    assert np.nanmax(np.hypot(matched.u - u, matched.v - v)) < 0.15
    np.testing.assert_allclose(matched.point[on], points[on], atol=1e-6)
    np.testing.assert_allclose(matched.shear[on], shear[on], atol=0.1)


def test_normals_point_to_the_side_of_the_ply(cap_net):
    u, v, points, _ = _anywhere(cap_net)
    matched = match(cap_net, gd.Measurement("made", points, u=u, v=v))
    facets = cap_net.surface.normals[cap_net.surface.nearest(points).face]
    assert (np.einsum("ij,ij->i", matched.normal, facets) > 0.98).all()


def test_each_row_without_a_prediction_has_a_reason(plane_net):
    points = np.array([[0.0, 0.0, 1.0], [150.0, 0.0, 0.0], [99.9, 79.9, 0.0], [0.0, 95.0, 3.0]])
    matched = match(plane_net, gd.Measurement("made", points))
    assert matched.used.tolist() == [True, False, False, False]
    assert matched.reason[1] == matched.reason[3] == "beyond the rim of the part"
    assert "between the last whole cell and the rim" in matched.reason[2]
    labels = match(plane_net, gd.Measurement("made", points, u=np.array([0, 150.0, 0, 0]), v=np.array([0, 0, 400.0, -20])))
    assert labels.used.tolist() == [True, False, False, True]
    assert "off the part" in labels.reason[1] or "beyond the rim" in labels.reason[1]
    assert labels.reason[2] == "beyond the rim of the net"


def test_marks_in_a_hole_say_so():
    surface = gd.read_surface("samples/parts/bracket.stl")
    net = gd.drape(surface, "centroid", 0.0, 5.0)
    from geomdrap.fishnet import Status

    i, j = np.argwhere(net.status == Status.IN_HOLE)[0]
    matched = match(net, gd.Measurement("made", np.zeros((1, 3)), u=net.u[[i]] + 0.1, v=net.v[[j]] + 0.1))
    assert matched.reason == ("in a hole of the part",)


def test_the_distance_from_the_rim_of_a_rectangle_is_exact():
    surface = shapes.plane(200.0, 160.0, 10.0)
    points = np.array([[0.0, 0.0, 0.0], [90.0, 3.0, 0.0], [-20.0, -75.5, 0.0]])
    np.testing.assert_allclose(distance_to_rim(surface, points), [80.0, 10.0, 4.5], atol=1e-9)


def test_a_closed_part_has_no_rim():
    assert np.isinf(distance_to_rim(shapes.icosphere(50.0, 2), np.array([[50.0, 0.0, 0.0]]))).all()
