"""Outlines of the flat pattern, yarn lines within them, and zones over the limit angle."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_parts import plate_with_holes

import geomdrap as gd
from geomdrap.fields.contour import clip_to_rectangle, signed_area, simplify
from geomdrap.fields.flat import locked_zones, yarn_lines
from geomdrap.surface import shapes

SQUARE = np.array([[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])


def inside(points, polygon):
    """Even-odd rule, straight from its definition."""
    a, b = polygon, np.roll(polygon, -1, axis=0)
    x, y = points[:, :1], points[:, 1:]
    crosses = (a[:, 1] > y) != (b[:, 1] > y)
    with np.errstate(divide="ignore", invalid="ignore"):
        at = a[:, 0] + (y - a[:, 1]) / (b[:, 1] - a[:, 1]) * (b[:, 0] - a[:, 0])
    return ((crosses & (x < at)).sum(axis=1) % 2).astype(bool)


def test_an_area_is_positive_counter_clockwise_wherever_the_polygon_lies():
    assert signed_area(SQUARE) == pytest.approx(100.0, rel=1e-15)
    assert signed_area(SQUARE[::-1]) == pytest.approx(-100.0, rel=1e-15)
    assert signed_area(SQUARE + 1e6) == pytest.approx(100.0, rel=1e-9)


@pytest.mark.parametrize(
    ("half", "area"),
    [((5.0, 5.0), 25.0), ((20.0, 20.0), 100.0), ((5.0, 20.0), 50.0), ((2.0, 3.0), 6.0), ((10.0, 10.0), 100.0)],
)
def test_a_square_cut_by_the_blank_keeps_the_area_that_is_within(half, area):
    assert signed_area(clip_to_rectangle(SQUARE, half)) == pytest.approx(area, rel=1e-14)


def test_a_polygon_beyond_the_blank_is_cut_to_nothing():
    assert len(clip_to_rectangle(SQUARE + 30.0, (5.0, 5.0))) == 0


def test_a_triangle_around_the_blank_is_cut_to_the_blank():
    triangle = np.array([[-100.0, -50.0], [100.0, -50.0], [0.0, 150.0]])
    cut = clip_to_rectangle(triangle, (6.0, 4.0))
    assert signed_area(cut) == pytest.approx(96.0, rel=1e-12)
    assert signed_area(clip_to_rectangle(triangle[::-1], (6.0, 4.0))) == pytest.approx(-96.0, rel=1e-12)


@given(
    st.lists(st.tuples(st.floats(-20, 20), st.floats(-20, 20)), min_size=3, max_size=3),
    st.floats(1.0, 15.0),
    st.floats(1.0, 15.0),
)
@settings(max_examples=60, deadline=None)
def test_the_cut_lies_within_the_blank_and_is_no_larger_than_either(corners, a, b):
    triangle = np.array(corners)
    whole = signed_area(triangle)
    cut = clip_to_rectangle(triangle, (a, b))
    area = signed_area(cut) if len(cut) else 0.0
    assert abs(area) <= min(abs(whole), 4 * a * b) + 1e-9
    assert area * whole >= -1e-9
    if len(cut):
        assert (np.abs(cut) <= np.array([a, b]) + 1e-9).all()
    # additive: two halves of the plane make up the whole
    left, right = (clip_to_rectangle(triangle + [shift, 0.0], (50.0, 60.0)) for shift in (-50.0 - a, 50.0 - a))
    halves = sum(signed_area(c) for c in (left, right) if len(c))
    assert halves == pytest.approx(whole, abs=1e-6)


@pytest.mark.parametrize("count", [7, 40, 101])
def test_points_on_straight_lines_are_left_out_and_the_area_is_kept(count):
    share = np.linspace(0.0, 1.0, count)[:-1, None]
    ring = np.concatenate([a + share * (b - a) for a, b in zip(SQUARE, np.roll(SQUARE, -1, 0), strict=True)])
    assert signed_area(simplify(ring, 1e-4)) == pytest.approx(100.0, rel=1e-9)
    fewer = ring
    for _ in range(9):
        fewer = simplify(fewer, 1e-4)
    assert len(fewer) < 0.2 * len(ring) + 6
    for corner in SQUARE:
        assert np.linalg.norm(fewer - corner, axis=1).min() < 1e-9


def test_a_circle_keeps_its_area_and_moves_by_no_more_than_the_tolerance():
    turn = np.linspace(0.0, 2 * np.pi, 2000, endpoint=False)
    circle = 50.0 * np.column_stack([np.cos(turn), np.sin(turn)])
    fewer = simplify(circle, 1e-2)
    assert len(fewer) < len(circle)
    assert signed_area(fewer) == pytest.approx(signed_area(circle), abs=1e-2 * 2 * np.pi * 50.0)


def test_outer_contours_run_counter_clockwise_and_holes_clockwise_within_them():
    part = plate_with_holes(((0.0, 0.0, 30.0), (60.0, 60.0, 20.0)))
    flat = gd.evaluate(gd.drape(part, (-60.0, -50.0, 0.0), 33.0, 4.0)).flat
    (outer,) = flat.outer
    assert signed_area(outer) > 0.0
    assert len(flat.inner) == 2
    for hole in flat.inner:
        assert signed_area(hole) < 0.0
        assert inside(hole, outer).all()


def test_the_flat_pattern_of_a_plate_is_the_plate_turned_by_the_heading():
    part = plate_with_holes(((0.0, 0.0, 30.0),))
    net = gd.drape(part, (-60.0, -50.0, 0.0), 33.0, 4.0)
    flat = gd.evaluate(net).flat
    c, s = np.cos(np.radians(33.0)), np.sin(np.radians(33.0))
    for loop in (*flat.outer, *flat.inner):
        x = loop @ np.array([[c, s], [-s, c]]) + [-60.0, -50.0]
        away = np.abs(np.abs(x).max(axis=1)[:, None] - [30.0, 100.0]).min(axis=1)
        assert away.max() < 1e-3


def test_yarn_lines_lie_inside_the_contours_at_their_level_and_end_on_them():
    part = plate_with_holes(((0.0, 0.0, 30.0),))
    net = gd.drape(part, (-60.0, -50.0, 0.0), 33.0, 10.0)
    flat = gd.evaluate(net).flat
    loops = (*flat.outer, *flat.inner)
    for lines, axis in ((flat.warp_lines, 1), (flat.weft_lines, 0)):
        length = 0.0
        for line in lines:
            assert line[0, axis] == line[1, axis]
            assert line[0, axis] / 10.0 == pytest.approx(round(line[0, axis] / 10.0), abs=1e-9)
            middle = line.mean(axis=0, keepdims=True)
            assert inside(middle, flat.outer[0]).all()
            assert not inside(middle, flat.inner[0]).any()
            length += abs(line[1, 1 - axis] - line[0, 1 - axis])
        # the lines sample the pattern's width: their length times their distance is its area
        assert length * 10.0 == pytest.approx(flat.area, rel=0.02)
    assert len(loops) == 2


def test_yarn_lines_skip_holes():
    hole = np.array([[4.0, 4.0], [4.0, 6.0], [6.0, 6.0], [6.0, 4.0]])
    lines = yarn_lines((SQUARE, hole), np.array([1.0, 5.0]), 1)
    ends = sorted((line[0, 1], line[0, 0], line[1, 0]) for line in lines)
    np.testing.assert_allclose(ends, [(1.0, 0.0, 10.0), (5.0, 0.0, 4.0), (5.0, 6.0, 10.0)])


def test_zones_over_the_limit_have_the_area_of_their_cells():
    part = shapes.hemisphere(100.0, 5.0)
    net = gd.drape(part, (0.0, 0.0, 100.0), 0.0, 5.0)
    for limit in (20.0, 40.0):
        over = np.abs(np.nan_to_num(net.cell_shear)) > limit
        zones = locked_zones(net, limit)
        assert len(zones) >= 4
        assert sum(map(signed_area, zones)) == pytest.approx(over.sum() * 25.0, rel=1e-9)
        for zone in zones:
            on_lines = zone / 5.0
            np.testing.assert_allclose(on_lines, np.round(on_lines), atol=1e-9)
    assert locked_zones(net, 89.0) == ()
    assert len(gd.evaluate(net, 40.0).flat.locked) >= 4
