"""Thickness and bridging, against exact offsets and closings."""

import numpy as np
import pytest
from exact_nets import middles, sphere_shear
from shared import drape

import geomdrap as gd
from geomdrap.effects.parallel import parallel_surface
from geomdrap.effects.rolling_ball import closed_points
from geomdrap.surface import shapes

RADIUS = 20.0  # of the ball


@pytest.mark.parametrize("offset", [4.0, -4.0])
def test_the_parallel_surface_of_a_sphere_is_a_sphere(offset):
    moved = parallel_surface(shapes.sphere_cap(80.0, 60.0, 3.0), offset, "thickness")
    np.testing.assert_allclose(np.linalg.norm(moved.points, axis=1), 80.0 + offset, atol=2e-3)


def test_a_thick_ply_on_a_sphere_is_draped_on_the_larger_sphere():
    net = drape(shapes.sphere_cap(80.0, 60.0, 1.0), "thickness:offset=8", origin=(0.0, 0.0, 80.0), pitch=5.0)
    assert np.linalg.norm(net.origin) == pytest.approx(88.0, abs=0.02)
    miss = net.cell_shear - sphere_shear(middles(net.u), middles(net.v), 88.0)
    assert np.sqrt(np.nanmean(miss**2)) < 0.06
    assert np.nanmax(abs(net.cell_shear - sphere_shear(middles(net.u), middles(net.v), 80.0))) > 1.0


def test_flat_facets_keep_their_distance_at_sharp_edges():
    roof = shapes.grid_surface(lambda x, y: -abs(x), np.linspace(-20, 20, 9), np.linspace(-20, 20, 9))
    for offset in (3.0, -3.0):
        moved = parallel_surface(roof, offset, "thickness")
        away = moved.points[moved.triangles] - roof.points[roof.triangles[:, :1]]
        np.testing.assert_allclose((away * roof.normals[:, None]).sum(axis=2), offset, atol=1e-9)


def test_an_offset_into_too_tight_a_radius_is_refused_with_its_place():
    tube = shapes.cylinder(5.0, 40.0, 1.0, angle=180.0)
    with pytest.raises(gd.EffectError, match="curved more tightly than -6 mm"):
        parallel_surface(tube, -6.0, "thickness")


def groove(n, profile):
    lines = np.linspace(-40.0, 40.0, n)
    return shapes.grid_surface(lambda x, y: profile(x), lines, lines[::4])


def test_a_sharp_groove_gets_a_fillet_of_the_ball():
    surface = groove(81, abs)
    closed = closed_points(surface, RADIUS)
    x, z = closed[:, 0], closed[:, 2]
    contact = RADIUS * np.sqrt(0.5)
    fillet = RADIUS * np.sqrt(2.0) - np.sqrt(np.maximum(RADIUS**2 - x**2, 0.0))
    exact = np.where(abs(x) < contact, fillet, abs(x))
    np.testing.assert_allclose(z, exact, atol=3e-3)
    moved = (closed != surface.points).any(axis=1)
    assert abs(surface.points[moved, 0]).max() == pytest.approx(contact, abs=1.0)  # the contact lines, to a facet
    assert z[abs(x) < 0.1].min() == pytest.approx(RADIUS * (np.sqrt(2.0) - 1.0), abs=3e-3)


def test_a_smooth_valley_is_closed_to_second_order():
    tight = 10.0  # radius of curvature at the bottom; the ball touches where its distance from the axis is `reach`
    reach = np.sqrt(RADIUS**2 - tight**2)
    height = 0.5 * reach**2 / tight + tight
    errors = []
    for n in (41, 81):
        closed = closed_points(groove(n, lambda x: 0.5 * x**2 / tight), RADIUS)
        x = closed[:, 0]
        arc = height - np.sqrt(np.maximum(RADIUS**2 - x**2, 0.0))
        errors.append(np.sqrt(np.mean((closed[:, 2] - np.where(abs(x) < reach, arc, 0.5 * x**2 / tight)) ** 2)))
    assert errors[1] < 0.01
    assert errors[0] / errors[1] > 3.0


@pytest.mark.parametrize(
    "surface",
    [
        shapes.sphere_cap(30.0, 60.0, 3.0),
        shapes.cylinder(15.0, 60.0, 3.0, angle=180.0),
        shapes.plane(60.0, 40.0, 5.0),
    ],
    ids=["sphere", "cylinder", "plane"],
)
def test_convex_parts_stay_exactly_as_they_are(surface):
    assert gd.effects.make("bridging", radius=RADIUS).on_surface(surface) is surface


def test_hollows_of_a_larger_radius_stay_exactly_as_they_are():
    surface = groove(41, lambda x: 0.5 * x**2 / (1.3 * RADIUS))
    assert (closed_points(surface, RADIUS) == surface.points).all()


def test_no_point_of_a_closed_surface_lies_in_the_tool_and_every_ball_still_fits():
    surface = groove(81, lambda x: 12.0 * np.cos(x / 5.0))
    closed = closed_points(surface, RADIUS)
    assert (closed[:, 2] - 12.0 * np.cos(closed[:, 0] / 5.0)).min() > -0.15
    again = closed_points(surface.moved(closed), RADIUS)
    assert np.linalg.norm(again - closed, axis=1).max() < 0.3  # closing twice closes once


def test_a_bowl_gets_a_spherical_bottom():
    tight = 10.0
    reach = np.sqrt(RADIUS**2 - tight**2)
    height = 0.5 * reach**2 / tight + tight
    lines = np.linspace(-30.0, 30.0, 61)
    bowl = shapes.grid_surface(lambda x, y: 0.5 * (x**2 + y**2) / tight, lines, lines)
    closed = closed_points(bowl, RADIUS)
    away = np.linalg.norm(closed - [0.0, 0.0, height], axis=1)
    bottom = np.hypot(*closed[:, :2].T) < reach - 1.0
    np.testing.assert_allclose(away[bottom], RADIUS, atol=0.05)
    beyond = np.hypot(*bowl.points[:, :2].T) > reach + 2.0
    np.testing.assert_allclose(closed[beyond], bowl.points[beyond], atol=0.02)


def test_large_flat_facets_are_split_where_the_ply_bridges():
    lines = np.array([-40.0, 0.0, 40.0])
    surface = shapes.grid_surface(lambda x, y: abs(x), lines, lines)
    closed = gd.effects.make("bridging", radius=RADIUS).on_surface(surface)
    assert len(closed.triangles) > 100
    bottom = closed.points[abs(closed.points[:, 0]) < 0.1, 2]
    np.testing.assert_allclose(bottom, RADIUS * (np.sqrt(2.0) - 1.0), atol=0.01)


def test_a_ball_that_fits_nowhere_is_refused():
    with pytest.raises(gd.EffectError, match=r"touches .* nowhere"):
        closed_points(shapes.sphere_cap(30.0, 80.0, 3.0).flipped(), 60.0)


def test_a_surface_is_made_once_for_a_fit_that_drapes_on_it_again():
    surface = groove(41, abs)
    bridged = gd.effects.make("bridging", radius=15.0)
    assert bridged.on_surface(surface) is gd.effects.make("bridging", radius=15.0).on_surface(surface)
    assert bridged.on_surface(surface) is not gd.effects.make("bridging", radius=16.0).on_surface(surface)


def test_bridging_before_thickness_whatever_order_they_are_given_in():
    surface = groove(81, abs)
    one = drape(surface, "bridging:radius=20", "thickness:offset=3", origin=(30.0, 0.0, 30.0))
    other = drape(surface, "thickness:offset=3", "bridging:radius=20", origin=(30.0, 0.0, 30.0))
    np.testing.assert_array_equal(one.points, other.points)
    assert [e.name for e in other.effects] == ["bridging", "thickness"]
