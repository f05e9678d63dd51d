"""Overlap of flat facets, found exactly and taken away; what makes a flat pattern fit to cut."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_parts import bumpy_sheet

import geomdrap as gd
from geomdrap.fields.contour import is_simple, signed_area, winding
from geomdrap.fields.joints import groups
from geomdrap.fields.overlap import LEAST, common_area, doubled, overlapping_pairs
from geomdrap.fields.slit import bridges, chains_with, loose

EVERYWHERE = np.array([-1e3, -1e3]), np.array([1e3, 1e3])


def shared(a, b, low=EVERYWHERE[0], high=EVERYWHERE[1]):
    return common_area(np.array(a, float), np.array(b, float), np.array(low, float), np.array(high, float), np.empty((2, 16, 2)))


def test_triangles_share_the_area_that_geometry_says():
    a = [[0, 0], [2, 0], [0, 2]]
    assert shared(a, a) == pytest.approx(2.0)
    assert shared(a, [[1, 0], [3, 0], [1, 2]]) == pytest.approx(0.5)
    assert shared(a, [[1, 2], [3, 0], [1, 0]]) == pytest.approx(0.5)  # turned over
    assert shared(a, [[2, 0], [2, 2], [0, 2]]) == 0.0  # an edge in common
    assert shared(a, [[5, 5], [6, 5], [5, 6]]) == 0.0
    assert shared(a, a, (-1, -1), (1, 1)) == pytest.approx(1.0)  # a square of side 1 lies whole under the slope


@given(st.integers(0, 10**6))
@settings(max_examples=40, deadline=None)
def test_the_grid_finds_the_pairs_that_all_against_all_finds(seed):
    rng = np.random.default_rng(seed)
    flat = rng.uniform(-5, 5, (40, 1, 2)) + rng.normal(size=(40, 3, 2)) * rng.uniform(0.1, 2.0)
    first = int(rng.integers(1, 41))
    found = {tuple(p) for p in overlapping_pairs(flat, first)}
    expected = {(f, g) for f in range(first) for g in range(f + 1, 40) if shared(flat[f], flat[g]) > LEAST}
    assert found == expected


def test_of_two_facets_the_later_goes_and_what_lay_upon_it_may_stay():
    row = np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    at = np.stack([row, row + [0.6, 0.0], row + [1.2, 0.0], row + [9.0, 0.0]])
    assert doubled(at, np.array([0, 1, 2]), np.array([3])).tolist() == [1]
    assert doubled(at, np.array([1, 2]), np.array([0, 3])).tolist() == [1]
    assert doubled(at, np.array([3]), np.array([0, 1, 2])).tolist() == []


SQUARE = np.array([[0.0, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]])


def test_winding_counts_turns_and_their_sense():
    assert winding(SQUARE, np.array([1.0, 1.0])) == 1
    assert winding(SQUARE[::-1], np.array([1.0, 1.0])) == -1
    assert winding(SQUARE, np.array([5.0, 1.0])) == 0
    assert winding(np.concatenate([SQUARE, SQUARE]), np.array([1.0, 1.0])) == 2


def test_polygons_are_simple_where_they_bound_the_plane_once():
    hole = (0.5 * SQUARE + 1.0)[::-1]
    assert is_simple([SQUARE])
    assert is_simple([SQUARE, hole])
    assert is_simple([SQUARE, hole, 0.25 * SQUARE + 1.5])  # an island in the hole
    assert not is_simple([SQUARE, 0.5 * SQUARE + 1.0])  # a second layer within the first
    assert not is_simple([SQUARE, SQUARE + 2.0])
    assert not is_simple([SQUARE[[0, 2, 1, 3]]])
    assert is_simple([SQUARE, SQUARE + [4.0, 0.0]])  # side by side


def test_loose_ends_of_a_seam_are_taken_away_up_to_where_it_is_held():
    a, b = np.array([0, 1, 2, 2, 5]), np.array([1, 2, 3, 4, 6])
    held = np.zeros(7, bool)
    held[[0, 3, 5]] = True  # 0-1-2-3 runs from rim to rim, 4 hangs on it, 5-6 on the rim
    assert loose(a, b, held).tolist() == [False, False, False, True, True]
    assert chains_with(np.array([0, 0, 1, 0, 0], bool), a, b, 7).tolist() == [True] * 4 + [False]


def test_a_loop_at_the_inner_end_of_a_seam_stays_without_the_way_to_it():
    a, b = np.array([0, 1, 2, 3, 4]), np.array([1, 2, 3, 4, 2])  # 0-1-2 leads from the rim to the loop 2-3-4
    held = np.array([True, False, False, False, False])
    assert loose(a, b, held).tolist() == [True, True, False, False, False]


@pytest.mark.parametrize("seed", range(30))
def test_bridges_are_the_edges_without_which_a_graph_falls_apart(seed):
    rng = np.random.default_rng(seed)
    nodes = int(rng.integers(2, 15))
    a, b = rng.integers(0, nodes, (2, int(rng.integers(1, 20))))  # loops and doubles too
    pieces = [len(np.unique(groups(np.delete(a, [n]), np.delete(b, [n]), nodes))) for n in range(len(a))]
    whole = len(np.unique(groups(a, b, nodes)))
    assert bridges(a, b, nodes).tolist() == [count > whole for count in pieces]


@pytest.mark.parametrize("seed", range(24))
def test_the_pattern_of_any_bumpy_part_is_one_layer_and_as_large_as_the_fabric_said(seed):
    rng = np.random.default_rng(seed)
    part = bumpy_sheet(seed, n=rng.integers(4, 16), height=rng.uniform(0.0, 45.0))
    try:
        result = gd.evaluate(gd.drape(part, "centroid", rng.uniform(0.0, 90.0), rng.uniform(2.0, 18.0)))
    except gd.DrapeError:
        return
    contours = (*result.flat.outer, *result.flat.inner)
    assert is_simple(contours)
    assert sum(signed_area(c) for c in contours) == pytest.approx(result.area.fabric, rel=2e-3)
    assert result.area.draped == pytest.approx((result.face_coverage * part.areas).sum(), rel=1e-9)
    assert not any("crosses itself" in warning for warning in result.warnings)
