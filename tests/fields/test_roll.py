"""The flat pattern laid from strips of a roll: exact on planes and on what can be unrolled."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from made_parts import plate_with_holes

import geomdrap as gd
from geomdrap.errors import DrapeError
from geomdrap.fields.band import across, band
from geomdrap.fields.contour import is_simple, signed_area
from geomdrap.fields.roll import lay_on_roll
from geomdrap.fields.seams import place_seams, strips_needed
from geomdrap.surface import Surface, shapes

SQUARE = np.array([[0.0, 0.0], [100.0, 0.0], [100.0, 100.0], [0.0, 100.0]])
HOLE = np.array([[40.0, 40.0], [40.0, 60.0], [60.0, 60.0], [60.0, 40.0]])  # clockwise
L_SHAPE = np.array([[0, 0], [100, 0], [100, 50], [50, 50], [50, 100], [0, 100]], float)
U_SHAPE = np.array([[0, 0], [90, 0], [90, 60], [60, 60], [60, 20], [30, 20], [30, 80], [0, 80]], float)
HILL = shapes.grid_surface(
    lambda x, y: 30.0 * np.exp(-((x / 40.0) ** 2 + ((y + 5.0) / 40.0) ** 2)),
    np.linspace(-150.0, 150.0, 61),
    np.linspace(-100.0, 100.0, 41),
)
CAP = shapes.sphere_cap(100.0, 60.0, 5.0)


def draped(surface, origin=(0, 0, 0), angle=0.0, pitch=10.0, **options):
    return gd.evaluate(gd.drape(surface, origin, angle, pitch, project=True, **options))


def laid(surface, width, overlap=0.0, **options):
    result = draped(surface, **options)
    return result, lay_on_roll(result, width, overlap)


def dense(line):
    """A polyline (k, 3) with 100 points on each of its pieces."""
    share = np.linspace(0.0, 1.0, 100)[:, None, None]
    return (line[:-1] + share * np.diff(line, axis=0)).reshape(-1, 3)


def assert_sums_to_the_pattern(result, roll):
    assert sum(strip.area for strip in roll.strips) == pytest.approx(result.flat.area, rel=1e-9)
    assert all(strip.v[1] - strip.v[0] <= roll.width * (1 + 1e-9) for strip in roll.strips)
    assert all(is_simple(strip.contours) for strip in roll.strips)
    assert roll.length == sum(strip.u[1] - strip.u[0] for strip in roll.strips)
    assert roll.waste == pytest.approx(1.0 - result.flat.area / (roll.width * roll.length), abs=1e-9)


# -- the band between two levels ------------------------------------------------------------------------------


def test_a_band_of_a_square_with_a_hole_is_the_rectangle_less_what_of_the_hole_is_in_it():
    (ring,) = band((SQUARE, HOLE), 20.0, 50.0)  # the hole opens at the upper edge
    assert signed_area(ring) == pytest.approx(100.0 * 30.0 - 20.0 * 10.0, rel=1e-12)
    through = band((SQUARE, HOLE), 45.0, 55.0)  # on both sides of the hole
    assert [signed_area(r) for r in through] == pytest.approx([400.0, 400.0], rel=1e-12)
    outer, hole = sorted(band((SQUARE, HOLE), 30.0, 70.0), key=signed_area, reverse=True)
    assert (signed_area(outer), signed_area(hole)) == pytest.approx((4000.0, -400.0), rel=1e-12)
    assert band((SQUARE, HOLE), 100.0, 120.0) == ()


def test_a_line_through_both_arms_of_a_u_leaves_two_contours_that_do_not_run_along_it():
    rings = band((U_SHAPE,), 30.0, 50.0)
    assert sorted((r[:, 0].min(), r[:, 0].max(), signed_area(r)) for r in rings) == [(0, 30, 600), (60, 90, 600)]
    (below,) = band((U_SHAPE,), 0.0, 20.0)  # the line lies on a side of the contour
    assert signed_area(below) == pytest.approx(90.0 * 20.0)
    above = band((U_SHAPE,), 20.0, 80.0)
    assert sum(signed_area(r) for r in above) == pytest.approx(30.0 * 60.0 + 30.0 * 40.0)


def test_what_is_below_the_teeth_of_a_comb_is_closed_across_each_tooth():
    teeth = [[90, 50], [70, 50], [70, 20], [60, 20], [60, 50], [50, 50], [50, 20], [30, 20], [30, 50], [0, 50]]
    (ring,) = band((np.array([[0, 0], [90, 0], *teeth], float),), 0.0, 35.0)
    sides = np.roll(ring, -1, axis=0) - ring
    on_line = (ring[:, 1] == 35.0) & (sides[:, 1] == 0.0)
    assert sorted(-sides[on_line, 0]) == [10.0, 20.0, 30.0]  # widths of the teeth, all to the left
    assert np.abs(sides).sum() == 2 * 90.0 + 2 * 35.0 + 4 * 15.0


@pytest.mark.parametrize("rounding", [0.0, 1e-13, -1e-13])
def test_a_band_over_a_side_that_lies_on_its_line_has_no_spur_along_it(rounding):
    shape = L_SHAPE + [[0, 0], [0, 0], [0, rounding], [0, -rounding], [0, 0], [0, 0]]
    (upper,), (lower,) = band((shape,), 50.0, 100.0), band((shape,), 0.0, 50.0)
    assert (upper[:, 0].min(), upper[:, 0].max()) == pytest.approx((0.0, 50.0), abs=1e-9)
    assert (signed_area(upper), signed_area(lower)) == pytest.approx((2500.0, 5000.0), rel=1e-12)
    np.testing.assert_allclose(across((shape,), 50.0), [[0.0, 50.0]], atol=1e-9)


def test_a_band_reaches_past_its_line_only_where_the_region_goes_on_across_it():
    (leg,) = band((L_SHAPE,), 52.0, 100.0, (5.0, 0.0))  # the side at 50 is no seam
    assert (leg[:, 0].max(), leg[:, 1].min()) == pytest.approx((50.0, 47.0), abs=1e-9)
    assert signed_area(leg) == pytest.approx(50.0 * 53.0, rel=1e-12)
    (foot,) = band((L_SHAPE,), 0.0, 45.0, (0.0, 20.0))  # as far as there is some
    assert signed_area(foot) == pytest.approx(100.0 * 50.0 + 50.0 * 15.0, rel=1e-12)
    arms = band((U_SHAPE,), 30.0, 80.0, (5.0, 0.0))
    assert sorted(signed_area(r) for r in arms) == pytest.approx([30.0 * 35.0, 30.0 * 55.0], rel=1e-12)


def test_what_a_band_has_past_its_line_goes_round_holes():
    for low, past, area, count in ((0.0, 10.0, 100 * 45 - 20 * 5, 1), (0.0, 40.0, 100 * 75 - 400, 2)):
        rings = band((SQUARE, HOLE), low, 35.0, (0.0, past))
        assert sum(signed_area(r) for r in rings) == pytest.approx(area, rel=1e-12)
        assert len(rings) == count
        assert is_simple(rings)
    left, right = band((SQUARE, HOLE), 48.0, 52.0, (20.0, 20.0))  # past the hole each stays on its side
    assert (signed_area(left), signed_area(right)) == pytest.approx((40.0 * 44.0, 40.0 * 44.0), rel=1e-12)
    (whole,) = band((SQUARE, HOLE), 0.0, 50.0, (0.0, 20.0))
    assert signed_area(whole) == pytest.approx(100.0 * 50.0 - 200.0 + 80.0 * 20.0, rel=1e-12)


@pytest.mark.parametrize("seed", range(5))
def test_bands_of_a_ragged_star_with_holes_sum_to_it(seed):
    rng = np.random.default_rng(seed)
    turn = np.arange(80) * 2 * np.pi / 80
    ring = rng.uniform(30.0, 100.0, 80)[:, None] * np.column_stack([np.cos(turn), np.sin(turn)])
    hole = 20.0 * np.column_stack([np.cos(turn), -np.sin(turn)])
    levels = np.linspace(-101.0, 101.0, 18)
    bands = [band((ring, hole), a, b) for a, b in pairwise(levels)]
    whole = signed_area(ring) + signed_area(hole)
    assert sum(signed_area(r) for rings in bands for r in rings) == pytest.approx(whole, rel=1e-12)
    assert all(is_simple(rings) for rings in bands if rings)


def test_a_contour_that_crosses_itself_is_refused():
    bow = np.array([[0.0, 0.0], [100.0, 100.0], [100.0, 0.0], [0.0, 100.0]])
    with pytest.raises(DrapeError, match="crosses itself at v = 30 mm"):
        band((bow,), 0.0, 30.0)


# -- where the seams are ---------------------------------------------------------------------------------------


def test_as_few_strips_as_cover_the_height_with_their_overlaps():
    assert [strips_needed(h, 100.0, 0.0) for h in (50.0, 100.0, 100.1, 200.0, 250.0)] == [1, 1, 2, 2, 3]
    assert [strips_needed(h, 100.0, 20.0) for h in (100.0, 180.0, 180.1, 260.0)] == [1, 2, 3, 3]


def test_the_seams_are_the_cheapest_of_all_that_were_possible():
    def cost(v):
        return 50.0 * np.sin(v / 7.0) + 0.3 * v

    found = place_seams(0.0, 250.0, 100.0, 10.0, cost)
    n, slack = 3, 3 * 90.0 + 10.0 - 250.0
    grid = slack * np.arange(97) / 96
    first, second = 250.0 - 180.0 - 5.0 + grid, 250.0 - 90.0 - 5.0 + grid
    sums = [
        (cost(a) + cost(b) + 1e-5 * ((a + 5.0) ** 2 + (b - a + 10.0) ** 2 + (250.0 - b + 5.0) ** 2), a, b)
        for a in first for b in second if b - a + 10.0 <= 100.0 + 1e-6
    ]  # fmt: skip
    assert len(found) == n - 1
    assert found == pytest.approx(min(sums)[1:], abs=1e-9)


def test_equal_seams_make_even_strips():
    assert place_seams(-30.0, 220.0, 100.0, 0.0, lambda v: 7.0) == pytest.approx([-30 + 250 / 3, -30 + 500 / 3])
    seams = place_seams(0.0, 250.0, 120.0, 20.0, lambda v: 7.0)  # three of 290 / 3 mm
    assert seams == pytest.approx([290 / 3 - 10.0, 250.0 - 290 / 3 + 10.0])


def test_no_strip_is_narrower_than_a_quarter_of_the_roll_however_cheap_its_seam():
    (seam,) = place_seams(0.0, 110.0, 100.0, 0.0, lambda v: v)  # it could lie at 10
    assert 25.0 - 1e-9 <= seam < 25.0 + 90.0 / 96
    (seam,) = place_seams(0.0, 110.0, 100.0, 0.0, lambda v: -v)
    assert 85.0 - 90.0 / 96 < seam <= 85.0 + 1e-9


# -- on parts ---------------------------------------------------------------------------------------------------


def test_a_rectangle_250_high_takes_three_strips_of_a_roll_100_wide():
    result, roll = laid(shapes.plane(300.0, 250.0, 25.0), 100.0)
    assert_sums_to_the_pattern(result, roll)
    assert [strip.area for strip in roll.strips] == pytest.approx([25000.0] * 3, rel=1e-9)
    assert sum(strip.area for strip in roll.strips) == pytest.approx(result.area.fabric, rel=1e-9)
    assert [seam.v for seam in roll.seams] == pytest.approx([-125.0 + 250 / 3, 125.0 - 250 / 3], abs=1e-6)
    assert [seam.length for seam in roll.seams] == pytest.approx([300.0, 300.0], abs=1e-6)
    assert roll.length == pytest.approx(900.0, abs=1e-6)
    assert roll.waste == pytest.approx(1.0 - 75000.0 / 90000.0, abs=1e-9)
    for seam in roll.seams:
        (line,) = seam.on_part
        np.testing.assert_allclose(line[[0, -1]], [[-150, seam.v, 0], [150, seam.v, 0]], atol=1e-6)
        assert seam.max_shear == pytest.approx(0.0, abs=1e-6)


def test_overlapping_strips_are_wider_by_the_overlap_and_lie_double_there():
    result, roll = laid(shapes.plane(300.0, 250.0, 25.0), 120.0, 20.0)
    assert len(roll.strips) == 3
    assert sum(strip.area for strip in roll.strips) == pytest.approx(result.flat.area + 2 * 20.0 * 300.0, rel=1e-9)
    for below, seam, above in zip(roll.strips[:-1], roll.seams, roll.strips[1:], strict=True):
        assert (below.v[1], above.v[0]) == pytest.approx((seam.v + 10.0, seam.v - 10.0))


def test_overlaps_of_an_l_add_their_width_times_the_length_of_the_seams_wherever_these_lie():
    part = shapes.l_shape(radius=np.inf)
    for width, overlap in ((100.0, 0.0), (100.0, 10.0), (110.0, 20.0), (300.0, 30.0)):
        result, roll = laid(part, width, overlap, origin=(-100.0, -100.0, 0.0))
        seams = sum(seam.length for seam in roll.seams)
        assert sum(strip.area for strip in roll.strips) == pytest.approx(result.flat.area + overlap * seams, rel=1e-9)
        assert all(is_simple(strip.contours) for strip in roll.strips)


def test_a_roll_as_wide_as_the_pattern_needs_no_seam():
    for width in (200.0, 1000.0):
        result, roll = laid(shapes.plane(300.0, 200.0, 20.0), width)
        assert (len(roll.strips), roll.seams) == (1, ())
        assert_sums_to_the_pattern(result, roll)
        assert roll.length == pytest.approx(300.0, abs=1e-6)


def test_a_seam_leaves_out_the_hole_that_it_crosses_and_slides_to_where_it_is_shortest():
    part = plate_with_holes(((0.0, 0.0, 30.0),))  # 200 × 200 mm
    result, roll = laid(part, 130.0, angle=0.0, origin=(-60.0, -50.0, 0.0), pitch=5.0)
    assert_sums_to_the_pattern(result, roll)
    (seam,) = roll.seams
    assert seam.length == pytest.approx(200.0 - 60.0, abs=1e-3)
    assert [piece[1, 0] - piece[0, 0] for piece in seam.pieces] == pytest.approx([70.0, 70.0], abs=1e-3)
    assert len(seam.on_part) == 2
    assert abs(seam.v - 50.0) < 1e-6  # of those through the hole, the one with even strips: y = 0


def test_the_seam_of_an_l_lies_in_its_narrow_leg():
    result, roll = laid(shapes.l_shape(radius=np.inf), 300.0, origin=(-100.0, -100.0, 0.0))
    assert_sums_to_the_pattern(result, roll)
    (seam,) = roll.seams
    v = np.concatenate([ring[:, 1] for ring in result.flat.outer])
    widest = max(result.flat.outer[0][:, 0]) - min(result.flat.outer[0][:, 0])
    assert v.max() - 300.0 <= seam.v <= v.min() + 300.0
    assert seam.length < 0.6 * widest


@pytest.mark.parametrize("angle", [45.0, 20.0])
def test_a_turned_square_is_cut_into_strips_whose_areas_sum_to_it(angle):
    result, roll = laid(shapes.plane(200.0, 200.0, 20.0), 70.0, angle=angle)
    assert_sums_to_the_pattern(result, roll)
    assert len(roll.strips) == int(np.ceil(200.0 * (np.cos(np.radians(angle)) + np.sin(np.radians(angle))) / 70.0))
    if angle == 45.0:
        for seam in roll.seams:  # a square on its corner is as wide as it is far from the corners
            assert seam.length == pytest.approx(2 * (100.0 * np.sqrt(2) - abs(seam.v)), abs=1e-3)


@pytest.mark.parametrize("angle", [0.0, 90.0, 30.0])
def test_a_seam_on_a_cylinder_is_the_helix_that_it_is_flat(angle):
    radius, length = 100.0, 300.0
    result, roll = laid(shapes.cylinder(radius, length, 5.0, 180.0), 120.0, origin=(0, 0, radius), angle=angle, pitch=5.0)
    assert_sums_to_the_pattern(result, roll)
    assert len(roll.seams) >= 2
    net, warp, weft = result.net, result.net.warp0, result.net.weft0
    axis = np.array([1.0, 0.0, 0.0]) if abs(np.ptp(net.surface.points[:, 0]) - length) < 1e-6 else np.array([0.0, 1.0, 0.0])
    around = np.cross(net.normal0, axis)
    for seam in roll.seams:
        (line,) = seam.on_part
        way = radius * np.arctan2(line @ around, line @ net.normal0)
        along = line @ axis
        v = way * (weft @ around) + along * (weft @ axis)
        assert np.abs(v - seam.v).max() < 0.05
        u = way * (warp @ around) + along * (warp @ axis)
        assert u[-1] - u[0] == pytest.approx(seam.length, abs=0.1)
        pieces = np.linalg.norm(np.diff(line, axis=0), axis=1).sum()
        assert pieces == pytest.approx(seam.length, rel=2e-3)
        assert seam.max_shear < 0.1


def test_the_largest_shear_along_a_seam_is_that_of_the_net_beside_it():
    result, roll = laid(CAP, 60.0, origin=(0, 0, 100.0), pitch=5.0)
    assert_sums_to_the_pattern(result, roll)
    for seam in roll.seams:
        u = np.linspace(seam.pieces[0][0, 0], seam.pieces[-1][1, 0], 400)
        points, shear = result.net.interpolate(u, np.full(len(u), seam.v))
        known = np.isfinite(shear)
        assert np.abs(shear[known]).max() <= seam.max_shear + 0.5
        assert seam.max_shear <= np.abs(shear[known]).max() + 5.0  # the rim shears most
        line = dense(np.vstack(seam.on_part))
        apart = np.linalg.norm(points[known][:, None] - line, axis=2).min(axis=1)
        assert apart.max() < 0.15


def test_a_seam_keeps_off_sheared_cloth_the_more_the_lower_the_limit_is():
    result = draped(HILL, origin=(-100.0, 0.0, 0.0), pitch=5.0)
    placed = {}
    for limit in (80.0, 2.0):
        (seam,) = lay_on_roll(replace(result, limit_angle=limit), 150.0).seams
        placed[limit] = seam
    assert placed[2.0].max_shear < placed[80.0].max_shear
    u = np.linspace(-40.0, 240.0, 600)

    def weighed(v):
        shear = result.net.interpolate(u, np.full(len(u), v))[1]
        return np.nanmean(1.0 + np.abs(shear) / 2.0)

    v = np.concatenate([ring[:, 1] for ring in result.flat.outer])
    others = [weighed(level) for level in np.linspace(v.max() - 150.0, v.min() + 150.0, 25)]
    assert weighed(placed[2.0].v) <= min(others) + 0.05 * (max(others) - min(others))


def test_a_seam_over_a_slit_that_stays_shut_is_whole():
    flat = shapes.plane(200.0, 200.0, 10.0)
    result = draped(flat.cut(np.array([[0.0, -100.0, 0.0], [0.0, 20.0, 0.0]])), origin=(0.0, 60.0, 0.0))
    roll = lay_on_roll(result, 110.0)
    assert_sums_to_the_pattern(result, roll)
    (seam,) = roll.seams
    assert -160.0 < seam.v < -40.0  # where the slit is
    assert seam.length == pytest.approx(200.0, abs=0.01)


def test_the_pattern_of_a_closed_part_is_laid_in_strips_that_sum_to_it():
    result, roll = laid(shapes.icosphere(100.0, 4), 120.0, origin=(0, 0, 100.0), pitch=8.0)
    assert_sums_to_the_pattern(result, roll)
    for seam in roll.seams:
        on_part = sum(np.linalg.norm(np.diff(line, axis=0), axis=1).sum() for line in seam.on_part)
        assert on_part == pytest.approx(seam.length, rel=0.02)


def test_a_blank_is_laid_on_the_roll_as_it_is_cut():
    result, roll = laid(shapes.plane(300.0, 250.0, 25.0), 60.0, reach=(80.0, 50.0))
    assert_sums_to_the_pattern(result, roll)
    np.testing.assert_allclose([strip.u for strip in roll.strips], [[-80.0, 80.0]] * 2, atol=1e-6)
    (seam,) = roll.seams
    (line,) = seam.on_part
    np.testing.assert_allclose(line[[0, -1], 0], [-80.0, 80.0], atol=1e-6)


# -- what is refused ---------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("width", "overlap", "words"),
    [
        (0.0, 0.0, "positive number of mm, not 0"),
        (-5.0, 0.0, "positive number of mm, not -5"),
        (np.nan, 0.0, "positive number"),
        (9.0, 0.0, "a roll 9 mm wide is narrower than the pitch of 10 mm"),
        (50.0, -1.0, "0 mm or more, not -1"),
        (50.0, 45.0, "an overlap of 45 mm leaves less of a roll 50 mm wide"),
    ],
)
def test_a_roll_that_cannot_be_is_refused_in_a_sentence(width, overlap, words):
    with pytest.raises(DrapeError, match=words):
        lay_on_roll(draped(shapes.plane(100.0, 100.0, 20.0)), width, overlap)


def test_more_strips_than_can_be_meant_are_refused():
    long = Surface([[0, 0, 0], [40, 0, 0], [40, 2000, 0], [0, 2000, 0]], [[0, 1, 2], [0, 2, 3]])
    with pytest.raises(DrapeError, match="takes 200 strips"):
        lay_on_roll(draped(long, (20, 1000, 0)), 10.0)
