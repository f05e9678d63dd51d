"""A net read between its nodes."""

import numpy as np
import pytest
from exact_nets import sphere_shear

import geomdrap as gd
from geomdrap.fishnet.interpolate import _places
from geomdrap.surface import shapes


def test_on_a_plane_every_fabric_coordinate_is_found_exactly():
    net = gd.drape(shapes.plane(200.0, 200.0, 10.0), (1.0, 2.0, 0.0), 30.0, 7.0)
    u, v = np.random.default_rng(0).uniform(-60.0, 60.0, (2, 200))
    points, shear = net.interpolate(u, v)
    c, s = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    exact = net.origin + np.column_stack([u * c - v * s, u * s + v * c, 0.0 * u])
    np.testing.assert_allclose(points, exact, atol=1e-9)
    np.testing.assert_allclose(shear, 0.0, atol=1e-6)


def test_at_the_nodes_the_net_itself_is_read():
    net = gd.drape(shapes.sphere_cap(80.0, 60.0, 3.0), "centroid", 20.0, 6.0)
    i, j = np.nonzero(np.isfinite(net.shear))
    points, shear = net.interpolate(net.u[i], net.v[j])
    known = np.isfinite(shear)
    assert known.mean() > 0.8
    np.testing.assert_allclose(points[known], net.points[i, j][known], atol=1e-9)
    np.testing.assert_allclose(shear[known], net.shear[i, j][known], atol=1e-9)


def test_points_lie_on_the_surface():
    surface = shapes.sphere_cap(80.0, 60.0, 3.0)
    net = gd.drape(surface, "centroid", 20.0, 8.0)
    points, _ = net.interpolate(*np.random.default_rng(0).uniform(-50.0, 50.0, (2, 300)))
    assert surface.nearest(points[np.isfinite(points[:, 0])]).distance.max() < 1e-9


@pytest.mark.parametrize("pitch", [3.0, 9.0])
def test_points_are_the_nearest_ones_of_ribs_of_a_few_pitches(pitch):
    """They are looked for from the nodes beside, not on the whole part."""
    flat = shapes.plane(160.0, 160.0, 1.5)
    x, y, _ = flat.points.T
    surface = gd.Surface(np.column_stack([x, y, 4.0 * np.sin(x / 5.0)]), flat.triangles)
    net = gd.drape(surface, "centroid", 20.0, pitch)
    u, v = np.random.default_rng(0).uniform(-70.0, 70.0, (2, 500))
    points, _ = net.interpolate(u, v)
    places = _places(net, u, v)
    means = places.mean(net.points)
    assert places.ok.sum() > 300
    found = np.linalg.norm(points[places.ok] - means, axis=1)
    np.testing.assert_allclose(found, surface.nearest(means).distance, atol=1e-9)


@pytest.mark.parametrize("what", ["points", "shear"])
def test_between_the_nodes_it_is_second_order_in_the_pitch(what):
    radius = 100.0
    surface = shapes.icosphere(radius, 7)
    u, v = np.random.default_rng(1).uniform(-60.0, 60.0, (2, 400))
    finest = gd.drape(surface, "vertex:77", 12.0, 0.75, (70.0, 70.0)).interpolate(u, v)[0]
    sizes, errors = np.array([28.0, 14.0]), []
    for pitch in sizes:
        points, shear = gd.drape(surface, "vertex:77", 12.0, pitch, (112.0, 112.0)).interpolate(u, v)
        assert np.isfinite(shear).all()
        if what == "points":
            errors.append(np.sqrt(np.mean(((points - finest) ** 2).sum(axis=1))))
        else:
            exact = [sphere_shear([a], [b], radius)[0, 0] for a, b in zip(u, v, strict=True)]
            errors.append(np.sqrt(np.mean((shear - exact) ** 2)))
    assert np.polyfit(np.log(sizes), np.log(errors), 1)[0] > 1.7
    assert errors[-1] < (0.1 if what == "points" else 0.025)


def test_outside_the_net_there_is_nothing():
    net = gd.drape(shapes.plane(200.0, 200.0, 10.0), (0.3, 0.2, 0.0), 0.0, 10.0, (50.0, 50.0))
    for u, v in ((60.0, 0.0), (0.0, -50.1), (np.nan, 0.0), (np.inf, 0.0), (1e300, 0.0)):
        points, shear = net.interpolate(u, v)
        assert points.shape == (1, 3)
        assert shear.shape == (1,)
        assert np.isnan(points).all()
        assert np.isnan(shear).all()
    points, _ = net.interpolate([50.0, -50.0], [50.0, 50.0])
    assert np.isfinite(points).all()


def test_nothing_asked_gives_nothing():
    net = gd.drape(shapes.plane(), "centroid", 0.0, 10.0)
    points, shear = net.interpolate([], [])
    assert points.shape == (0, 3)
    assert shear.shape == (0,)


def test_in_the_hole_of_a_part_there_is_nothing():
    lines = np.linspace(-100.0, 100.0, 41)
    surface = shapes.grid_surface(
        lambda x, y: 0.0 * x, lines, lines, keep=lambda x, y: np.maximum(abs(x), abs(y)) > 30.0
    )
    net = gd.drape(surface, (-60.0, 1.0, 0.0), 0.0, 4.0)
    points, shear = net.interpolate([60.0], [-1.0])
    assert np.isnan(points).all()
    assert np.isnan(shear).all()


def test_a_net_says_what_it_is_in_a_line():
    surface = shapes.sphere_cap(80.0, 60.0, 6.0)
    net = gd.drape(surface, pitch=8.0, effects=[gd.effects.make("weave-skew", skew=1.0)])
    nodes = int(np.isfinite(net.points[..., 0]).sum())
    assert repr(net) == f"<Net of {nodes:,} nodes, pitch 8 mm, on '{surface.source}' + weave-skew>"
