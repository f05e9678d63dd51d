"""The simulated nets against closed forms, and against themselves at other sizes of the cells."""

from __future__ import annotations

import numpy as np
import pytest

from geomdrap.blind import sliding
from geomdrap.blind.closing import closed
from geomdrap.blind.lines import generators
from geomdrap.blind.ply import lay
from geomdrap.blind.recipe import Recipe
from geomdrap.blind.shear import angle_between, node_shear
from geomdrap.blind.sheet import bare, parallel
from geomdrap.blind.terms import added, bowl, bump, cap, frustum, ramp, roof
from geomdrap.blind.tools import TOOLS, Tool, cylinder, draw_tool, plane, sphere
from tests.exact_nets import sphere_shear


@pytest.mark.parametrize("tool", [plane(), cylinder(120.0, 90.0)], ids=["plane", "cylinder"])
def test_a_developable_tool_does_not_shear_the_ply(tool):
    ply = lay(tool, Recipe(angle=30.0), 8.0)
    assert np.isfinite(node_shear(ply.points)).sum() > 300
    assert np.nanmax(np.abs(node_shear(ply.points))) < 1e-9


def test_skew_on_a_plane_is_uniform_shear_of_the_other_sign():
    ply = lay(plane(), Recipe(skew=3.0), 8.0)
    assert node_shear(ply.points)[np.isfinite(node_shear(ply.points))] == pytest.approx(-3.0, abs=1e-9)


def test_extension_on_a_plane_stretches_the_marks():
    ply = lay(plane(), Recipe(extension=(0.02, 0.01), angle=90.0), 8.0)
    i, j = np.searchsorted(ply.u, 32.0), np.searchsorted(ply.v, -16.0)
    assert ply.points[i, j] == pytest.approx([16.0 * 1.01, 32.0 * 1.02, 0.0])


def test_tension_gradient_on_a_plane_grows_with_the_square_of_the_distance():
    k = 2e-4
    ply = lay(plane(), Recipe(gradient=(k, 0.0)), 8.0)
    x = ply.points[:, len(ply.v) // 2, 0]
    known = np.isfinite(x)
    assert x[known] == pytest.approx(ply.u[known] + np.sign(ply.u[known]) * 0.5 * k * ply.u[known] ** 2)


def test_steered_generators_on_a_plane_are_circles_to_the_left():
    curvature = 2e-3
    ply = lay(plane(), Recipe(curvature=(curvature, 0.0)), 4.0)
    middle = len(ply.u) // 2
    warp = ply.points[:, middle, :2]
    distance = np.linalg.norm(warp - [0.0, 1.0 / curvature], axis=1)
    assert np.nanmax(np.abs(distance - 1.0 / curvature)) < 1e-3


def test_heading_turns_counter_clockwise_from_x():
    ply = lay(plane(), Recipe(angle=30.0), 8.0)
    middle = len(ply.u) // 2
    assert ply.points[middle + 1, middle, :2] == pytest.approx([8.0 * np.cos(np.pi / 6), 4.0])
    assert ply.points[middle, middle + 1, :2] == pytest.approx([-4.0, 8.0 * np.cos(np.pi / 6)])


def test_shear_on_a_sphere_is_exact_to_second_order():
    errors = []
    for side in (8.0, 4.0):
        ply = lay(sphere(100.0, 70.0), Recipe(angle=20.0), side)
        near = np.abs(ply.u) <= 48.0
        shear = node_shear(ply.points)[np.ix_(near, near)]
        miss = shear - sphere_shear(ply.u[near], ply.v[near], 100.0)
        errors.append(np.sqrt(np.nanmean(miss**2)))
    assert errors[1] < 0.005
    assert errors[0] / errors[1] > 3.5


def test_full_slip_keeps_the_distance_of_the_warp_yarns():
    p = lay(sphere(100.0, 70.0), Recipe(slip=1.0), 4.0).points
    warp = p[1:, :-1] - p[:-1, :-1] + p[1:, 1:] - p[:-1, 1:]
    weft = 0.5 * (p[:-1, 1:] - p[:-1, :-1] + p[1:, 1:] - p[1:, :-1])
    shear = np.deg2rad(angle_between(warp, weft))
    assert np.nanmax(np.abs(shear)) > np.deg2rad(30.0)  # without slip the yarns would be 13 % closer there
    apart = np.linalg.norm(weft, axis=-1) * np.cos(shear) / 4.0
    assert np.nanmax(np.abs(apart - 1.0)) < 0.01


def test_the_net_does_not_depend_on_the_size_of_its_cells():
    tool = draw_tool("dome", np.random.default_rng(3))
    coarse, fine = (lay(tool, Recipe(angle=25.0), side) for side in (8.0, 4.0))
    m, n = len(coarse.u) // 2, len(fine.u) // 2
    k = np.arange(-10, 11)
    miss = coarse.points[np.ix_(m + k, m + k)] - fine.points[np.ix_(n + 2 * k, n + 2 * k)]
    assert np.sqrt(np.nanmean(np.sum(miss**2, -1))) < 0.03


def test_straightest_chords_follow_great_circles_of_an_offset_sphere():
    sheet = parallel(cap(100.0), 5.0)
    start, heading = np.zeros(2), np.array([[np.cos(0.7), np.sin(0.7), 0.0]])
    plan = generators(sheet, start, heading, np.full((1, 10), 6.0), np.zeros((1, 10)))[0]
    points = sheet(plan)[0]
    assert np.linalg.norm(points, axis=1) == pytest.approx(105.0)
    assert points @ [-np.sin(0.7), np.cos(0.7), 0.0] == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("name", TOOLS)
def test_slopes_and_curvatures_of_tools_are_those_of_their_heights(name):
    _derivatives_agree(draw_tool(name, np.random.default_rng(0)).term)


@pytest.mark.parametrize(
    "term",
    [
        bump(9.0, 1.0, 2.0, 20.0, 30.0),
        bowl(0.01, -0.02),
        ramp(0.8, 5.0, 4.0, 30.0),
        roof(0.7, 12.0, 20.0),
        frustum(0.9, 12.0, 30.0, 8.0, 4.0, 1.2),
        cap(90.0),
    ],
)
def test_slopes_and_curvatures_of_terms_are_those_of_their_heights(term):
    _derivatives_agree(added([term]))


def _derivatives_agree(term):
    x, y = np.random.default_rng(1).uniform(-40.0, 40.0, (2, 30))
    h = 1e-4
    z = term(x, y)
    by_x = [(a - b) / (2 * h) for a, b in zip(term(x + h, y), term(x - h, y), strict=True)]
    by_y = [(a - b) / (2 * h) for a, b in zip(term(x, y + h), term(x, y - h), strict=True)]
    for found, expected in ((z[1], by_x[0]), (z[2], by_y[0]), (z[3], by_x[1]), (z[4], by_y[1]), (z[5], by_y[2])):
        assert found == pytest.approx(expected, abs=1e-6)


def test_tangents_of_a_parallel_sheet_are_those_of_its_points():
    sheet = parallel(draw_tool("dome", np.random.default_rng(0)).term, 3.0)
    xy = np.random.default_rng(1).uniform(-60.0, 60.0, (20, 2))
    for axis, tangent in enumerate(sheet(xy)[1:]):
        step = 1e-4 * np.eye(2)[axis]
        assert tangent == pytest.approx((sheet(xy + step)[0] - sheet(xy - step)[0]) / 2e-4, abs=1e-7)
    assert np.linalg.norm(sheet(xy)[0] - bare(draw_tool("dome", np.random.default_rng(0)).term)(xy)[0], axis=1) == (
        pytest.approx(3.0)
    )


@pytest.mark.parametrize("middle", [0.0, 0.7, 1.0], ids=lambda m: f"{m} mm beside a grid line")
def test_the_closing_of_a_round_valley_is_the_ball_itself(middle):
    def groove(x, y):
        return tuple(a + b for a, b in zip(*_two(x - middle, y), strict=True))

    valley, radius = Tool("groove", groove, (60.0, 40.0)), 60.0
    z = closed(valley, radius)(np.array([[middle, 0.0], [middle + 4.0, 10.0], [middle + 55.0, 0.0]]))[0][:, 2]
    from scipy.optimize import minimize_scalar

    wall = lambda t: valley.height(np.array([middle + t]), np.array([0.0]))[0]  # noqa: E731
    lowest = -minimize_scalar(
        lambda t: -(wall(t) + np.sqrt(radius**2 - t * t)), bounds=(0.0, 59.0), method="bounded"
    ).fun
    assert z[0] == pytest.approx(lowest - radius, abs=0.02)
    assert z[1] == pytest.approx(lowest - np.sqrt(radius**2 - 16.0), abs=0.03)
    assert z[2] == pytest.approx(wall(55.0), abs=1e-3)


def _two(x, y):
    return ramp(1.0, 12.0, 6.0)(x, y), ramp(1.0, 12.0, 6.0, 180.0)(x, y)


def test_the_closing_of_a_tool_without_tight_valleys_is_the_tool():
    saddle = Tool("saddle", bowl(0.004, -0.004), (60.0, 60.0))
    xy = np.random.default_rng(0).uniform(-50.0, 50.0, (50, 2))
    assert closed(saddle, 60.0)(xy)[0][:, 2] == pytest.approx(saddle.height(*xy.T), abs=0.02)


def latitudes(ply, radius):
    """Where yarns lie that keep their distance from the warp generator of a sphere: on circles of latitude."""
    u, v = np.meshgrid(ply.u, ply.v, indexing="ij")
    latitude = v / radius
    longitude = u / (radius * np.cos(latitude))
    points = np.stack([np.cos(latitude) * np.sin(longitude), np.sin(latitude), np.cos(latitude) * np.cos(longitude)])
    return radius * points.transpose(1, 2, 0), np.degrees(np.arctan(u * np.tan(latitude) / radius))


def test_yarns_that_slip_altogether_lie_on_circles_of_latitude_of_a_sphere():
    errors = []
    for side in (8.0, 4.0):
        ply = lay(sphere(100.0, 60.0), Recipe(slip=1.0), side)
        points, shear = latitudes(ply, 100.0)
        known = np.isfinite(ply.points[..., 0])
        assert known.sum() > 250
        off = np.linalg.norm(ply.points - points, axis=2)[known]
        turned = (node_shear(ply.points) - shear)[np.isfinite(node_shear(ply.points))]
        errors.append((np.sqrt(np.mean(off**2)), np.sqrt(np.mean(turned**2))))
    (far, turn), (near, less) = errors
    assert near < 0.3 * far and far < 0.03  # second order: a quarter
    assert less < 0.35 * turn and turn < 0.02


def test_a_row_of_equations_of_a_wrong_shape_is_no_end_of_the_ply(monkeypatch):
    banded = sliding._banded
    monkeypatch.setattr(sliding, "_banded", lambda *given: banded(*given)[:, :-1])
    with pytest.raises(ValueError, match=r"(?i)shape|dimension|size|compatible"):
        lay(sphere(100.0, 60.0), Recipe(slip=1.0), 8.0)


@pytest.mark.parametrize("part", ["dome", "saddle", "double-bump"])
def test_nets_that_slip_agree_whatever_their_cells(part):
    """Also where yarns nearly meet at an angle; what is too sharp for the cells is left out.

    The finer net is four times as fine, so that neither was left out by its difference from the other.
    """
    tool = draw_tool(part, np.random.default_rng(3))
    shears = []
    for side in (8.0, 2.0):
        ply = lay(tool, Recipe(start=(5.0, -6.0), angle=35.0, slip=0.86), side)
        every = int(16.0 / side)
        near = len(ply.u) // 2 + every * np.arange(-9, 10)
        shears.append(node_shear(ply.points)[np.ix_(near, near)])
    change = shears[0] - shears[1]
    assert np.isfinite(change).sum() > 150
    assert np.sqrt(np.nanmean(change**2)) < 0.12
