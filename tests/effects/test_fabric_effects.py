"""Effects that act on the fabric, against exact nets."""

import numpy as np
import pytest
from shared import drape, grid_of

import geomdrap as gd
from geomdrap.blind.draw import Options, draw, start_point
from geomdrap.blind.files import write_part
from geomdrap.surface import shapes

PLANE = shapes.plane(200.0, 160.0, 10.0)


def test_extended_yarns_on_a_plane_lie_on_a_larger_grid():
    net = drape(PLANE, "yarn-extension:strain_warp=0.02,strain_weft=-0.01")
    u, v = grid_of(net)
    np.testing.assert_allclose(net.points[..., 0], np.where(np.isnan(net.shear), np.nan, 1.02 * u), atol=1e-9)
    np.testing.assert_allclose(net.points[..., 1], np.where(np.isnan(net.shear), np.nan, 0.99 * v), atol=1e-9)
    assert np.nanmax(abs(net.shear)) < 1e-9
    np.testing.assert_allclose(np.diff(net.u), 5.0)  # u and v stay those of the flat fabric


def test_extended_yarns_on_a_cylinder_unroll_to_the_larger_grid():
    radius = 50.0
    surface = shapes.cylinder(radius, 120.0, 1.5, angle=180.0)
    net = drape(surface, "yarn-extension:strain_warp=0.03", origin=(0.0, 0.0, radius), angle=25.0)
    along = int(np.argmax(abs(surface.bounds).max(axis=0) > radius + 1.0))  # the axis of the cylinder
    across = 1 - along
    around = radius * np.arctan2(net.points[..., across], net.points[..., 2])
    u, v = grid_of(net)
    np.testing.assert_allclose(
        np.hypot(around, net.points[..., along]), np.where(np.isnan(around), np.nan, np.hypot(1.03 * u, v)), atol=0.03
    )
    assert np.nanmax(abs(net.cell_shear)) < 0.05
    assert gd.evaluate(net).checks.edge_error < 1e-9


def test_tension_grows_with_the_distance_from_the_axes():
    net = drape(PLANE, "tension-gradient:k_warp=0.4,k_weft=0.2")
    u, v = grid_of(net)
    present = np.isfinite(net.shear)
    # the sum of sides with the strain of their middle is the integral exactly
    np.testing.assert_allclose(net.points[present][:, 0], (u + 0.5 * 4e-4 * u * abs(u))[present], atol=1e-9)
    np.testing.assert_allclose(net.points[present][:, 1], (v + 0.5 * 2e-4 * v * abs(v))[present], atol=1e-9)


def test_skewed_cloth_is_sheared_the_same_everywhere_on_a_plane():
    net = drape(PLANE, "weave-skew:skew=4")
    np.testing.assert_allclose(net.cell_shear[net.cell_valid], -4.0, atol=1e-7)
    i, j = int(np.argmin(abs(net.u))), int(np.argmin(abs(net.v)))
    weft = net.points[i, j + 1] - net.points[i, j]
    assert np.degrees(np.arctan2(weft[1], weft[0])) == pytest.approx(94.0)


@pytest.mark.parametrize(("effect", "axis"), [("curvature_warp", 0), ("curvature_weft", 1)])
def test_a_steered_generator_on_a_plane_is_a_circle_to_the_left(effect, axis):
    radius = 100.0
    errors = []
    for pitch in (8.0, 4.0):
        net = drape(PLANE, f"steering:{effect}={1000.0 / radius}", pitch=pitch)
        i, j = int(np.argmin(abs(net.u))), int(np.argmin(abs(net.v)))
        line, s = (net.points[:, j], net.u) if axis == 0 else (net.points[i], net.v)
        near = np.isfinite(line[:, 0]) & (abs(s) < 60.0)
        along, left = radius * np.sin(s[near] / radius), radius * (1.0 - np.cos(s[near] / radius))
        exact = np.column_stack([along, left] if axis == 0 else [-left, along])
        errors.append(abs(line[near, :2] - exact).max())
    assert errors[1] < 0.02
    assert errors[0] / errors[1] > 3.5  # second order


def sliding_net(u, v, radius):
    """The net on a sphere whose warp yarns keep their distance: circles of latitude; its shear in degrees."""
    latitude = v / radius
    longitude = u / (radius * np.cos(latitude))
    points = [np.sin(longitude) * np.cos(latitude), np.sin(latitude), np.cos(longitude) * np.cos(latitude)]
    return radius * np.stack(points, axis=-1), np.degrees(np.arctan(u / radius * np.tan(latitude)))


def test_at_full_slip_warp_yarns_on_a_sphere_are_circles_of_latitude():
    radius, misses = 80.0, []
    surface = shapes.sphere_cap(radius, 60.0, 1.0)
    for pitch in (10.0, 5.0):
        net = drape(surface, "slip:coefficient=1", origin=(0.0, 0.0, radius), pitch=pitch, reach=(50.0, 50.0))
        points, shear = sliding_net(*grid_of(net), radius)
        inner = np.s_[1:-1, 1:-1]
        misses.append(
            (np.sqrt(np.nanmean((net.points - points)[inner] ** 2)), np.nanmax(abs(net.shear - shear)[inner]))
        )
    assert misses[0][0] < 0.015
    assert misses[0][0] / misses[1][0] > 3.0
    assert misses[1][1] < 0.1  # of up to 22 degrees


def test_yarns_do_not_slip_where_nothing_shears():
    plain, slipped = drape(PLANE), drape(PLANE, "slip:coefficient=0.8")
    np.testing.assert_allclose(slipped.points, plain.points, atol=1e-9)


@pytest.mark.parametrize(("slip", "settles"), [(0.5, True), (0.8, False)])
def test_where_slip_and_shear_feed_each_other_the_net_says_so(tmp_path, slip, settles):
    """On the foot of this boss the weft generator never has the length that the cells beside it ask for."""
    case = draw(50004, Options(effect="slip", part="hat"))
    write_part(tmp_path / "hat.stl", case.tool)
    place = {"origin": tuple(start_point(case.tool, case.believed)), "angle": case.believed.angle, "project": True}
    net = gd.drape(
        gd.read_surface(tmp_path / "hat.stl"), pitch=4.0, effects=[gd.effects.make("slip", coefficient=slip)], **place
    )
    assert any("do not settle" in warning for warning in net.warnings) is not settles


def test_slip_grows_the_weft_of_skewed_cloth_from_the_axis_on():
    net = drape(PLANE, "slip:coefficient=1", "weave-skew:skew=20", origin=(0.0, 0.0, 0.0), reach=(40.0, 40.0))
    np.testing.assert_allclose(net.sides[1], 5.0 / np.cos(np.radians(20.0)), rtol=1e-6)


def test_a_displaced_net_on_a_plane_is_the_net_moved_and_turned():
    plain = drape(PLANE, angle=30.0, reach=(30.0, 30.0))
    moved = drape(PLANE, "placement:du=4,dv=-3,dangle=10", angle=30.0, reach=(30.0, 30.0))
    c, s = np.cos(np.radians(30.0)), np.sin(np.radians(30.0))
    np.testing.assert_allclose(moved.origin, [4 * c + 3 * s, 4 * s - 3 * c, 0.0], atol=1e-9)
    c, s = np.cos(np.radians(10.0)), np.sin(np.radians(10.0))
    turned = plain.points @ np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]]).T
    np.testing.assert_allclose(moved.points, moved.origin + turned, atol=1e-8)


def test_a_displaced_seed_on_a_sphere_lies_on_the_great_circle_and_takes_the_heading_along():
    radius = 80.0
    surface = shapes.sphere_cap(radius, 60.0, 2.0)
    start = np.array([10.0, 5.0, np.sqrt(radius**2 - 125.0)])
    plain = drape(surface, origin=start, angle=20.0)
    moved = drape(surface, "placement:du=12,dv=-7", origin=start, angle=20.0)
    length = np.hypot(12.0, 7.0)
    way = (12.0 * plain.warp0 - 7.0 * plain.weft0) / length
    up = plain.origin / np.linalg.norm(plain.origin)
    way -= (way @ up) * up
    way /= np.linalg.norm(way)
    a = length / radius
    np.testing.assert_allclose(moved.origin, radius * (np.cos(a) * up + np.sin(a) * way), atol=0.02)
    carried = np.cos(a) * way - np.sin(a) * up  # parallel transport turns the way and leaves what is across it
    across = np.cross(up, way)
    exact = (12.0 * carried + 7.0 * across) / length
    assert np.degrees(np.arccos(np.clip(moved.warp0 @ exact, -1, 1))) < 1.5  # facets are tilted by 0.7°


def test_the_net_is_a_smooth_function_of_the_placement():
    surface = shapes.sphere_cap(80.0, 60.0, 3.0)
    at = np.linspace(-1.0, 1.0, 9)
    nets = [drape(surface, f"placement:du={x},dv={0.5 * x},dangle={x}", origin=(9.0, 4.0, 79.0)) for x in at]
    track = np.array([net.interpolate([30.0], [25.0])[0][0] for net in nets])
    line = np.polynomial.polynomial.polyfit(at, track, 2)
    assert abs(track - np.polynomial.polynomial.polyval(at, line).T).max() < 0.01


def test_a_ply_that_is_laid_elsewhere_says_so():
    """The heading printed is the one asked for."""
    (said,) = [note for note in drape(PLANE, "placement:du=3,dv=-4,dangle=-20").notes if "placement" in note]
    assert "5 mm from the origin asked for" in said
    assert "turned by -20° from 0°" in said
    assert not any("placement" in note for note in drape(PLANE, "weave-skew:skew=1").notes)


def test_a_seed_displaced_off_the_part_is_refused():
    with pytest.raises(gd.DrapeError, match="moves the seed off the part"):
        drape(PLANE, "placement:du=150")
