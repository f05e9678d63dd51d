"""Cuts: the part stays what it is, but for a slit that nothing crosses."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from made_parts import bumpy_sheet, plane_sheet, pyramid

import geomdrap as gd
from geomdrap.errors import SurfaceError

SLOPE = 1.0  # of a cone that no fabric covers in one piece: 105° would be missing at its tip


def require_sound(part):
    """Neighbours know each other, and share the two vertices of their edge."""
    face, edge = np.nonzero(part.neighbours >= 0)
    other, slot = part.neighbours[face, edge], part.neighbour_edge[face, edge]
    assert (part.neighbours[other, slot] == face).all()
    assert (part.neighbour_edge[other, slot] == edge).all()
    assert (part.triangles[face, edge] == part.triangles[other, (slot + 1) % 3]).all()
    assert (part.triangles[face, (edge + 1) % 3] == part.triangles[other, slot]).all()


def rim_length(part):
    edges = np.concatenate([part.triangles[loop // 3, loop % 3] for loop in part.boundary_loops])
    ends = np.concatenate([part.triangles[loop // 3, (loop % 3 + 1) % 3] for loop in part.boundary_loops])
    return np.linalg.norm(part.points[edges] - part.points[ends], axis=1).sum()


@pytest.mark.parametrize(
    ("line", "loops", "pieces"),
    [
        ([[20, 30, 0], [60, 40, 0], [70, 80, 0]], 2, 1),  # a slit within
        ([[33, 0, 0], [45, 55, 0]], 1, 1),  # from the rim
        ([[0, 33, 0], [100, 71, 0]], 2, 2),  # across
        ([[20, 20, 0], [50, 20, 0]], 2, 1),  # along edges of the mesh
        ([[13, 13, 0], [87, 87, 0]], 2, 1),  # along its diagonals
        ([[20, 20, 0], [80, 20, 0], [80, 80, 0], [20, 80, 0], [20, 20, 0]], 3, 2),  # round a piece
    ],
    ids=["slit", "from the rim", "across", "along edges", "along diagonals", "closed"],
)
def test_a_cut_lengthens_the_rim_by_its_two_sides_and_changes_nothing_else(line, loops, pieces):
    part = plane_sheet()
    cut = part.cut(line)
    length = np.linalg.norm(np.diff(np.array(line, float), axis=0), axis=1).sum()
    require_sound(cut)
    assert cut.area == pytest.approx(part.area, rel=1e-13)
    assert rim_length(cut) - rim_length(part) == pytest.approx(
        2.0 * length, rel=1e-3
    )  # it may bend to vertices nearby
    assert cut.cut_length == pytest.approx(length, rel=1e-3)
    assert (len(cut.boundary_loops), cut.n_components) == (loops, pieces)
    assert part.neighbours.min() == -1  # the part itself never changes
    assert not part.cuts


def test_faces_keep_the_numbers_of_those_that_they_are_pieces_of():
    part = plane_sheet()
    cut = part.cut([[20, 30, 0], [60, 41, 0]])
    areas = np.bincount(cut.source_face, cut.areas, len(part.triangles))
    np.testing.assert_allclose(areas, part.areas, rtol=1e-12)
    middle = cut.points[cut.triangles].mean(axis=1)
    assert (part.nearest(middle).face == cut.source_face).all()


@settings(max_examples=40, deadline=None)
@given(st.integers(0, 10_000), st.integers(2, 6))
def test_any_line_on_any_part_is_cut_cleanly_or_refused(seed, count):
    rng = np.random.default_rng(seed)
    part = bumpy_sheet(seed % 50)
    low, high = part.bounds
    line = part.nearest(low + rng.random((count, 3)) * (high - low)).point
    try:
        cut = part.cut(line)
    except SurfaceError as error:
        assert "give points in between" in str(error) or "single point" in str(error)
        return
    require_sound(cut)
    assert cut.area == pytest.approx(part.area, rel=1e-12)
    assert cut.cut_length >= 0.98 * np.linalg.norm(line[-1] - line[0])  # ends may move to vertices nearby


@pytest.mark.parametrize("seed", [(-50.0, 3.0, -50.0), (30.0, 40.0, -50.0)])
def test_a_cone_cut_open_is_flat(seed):
    part = pyramid(sides=90, slope=SLOPE, rings=30)
    apex, rim = part.points[part.points[:, 2].argmax()], part.nearest([[100.0, 3.0, -100.0]]).point[0]
    cut = part.cut([apex, rim])
    whole, open_ = (gd.evaluate(gd.drape(p, seed, 10.0, 4.0, project=True)) for p in (part, cut))
    assert whole.area.coverage < 0.98
    assert open_.area.coverage > 0.9999
    assert open_.statistics.max < 1e-4
    assert open_.area.fabric == pytest.approx(part.area, rel=3e-4)
    assert len(open_.flat.outer) == 1


@pytest.mark.parametrize(
    ("line", "words"),
    [
        ([[20, 30, 0]], "two different points"),
        ([[20, 30, 0], [20, 30, 0]], "two different points"),
        ([[20, 30], [40, 50]], "must be points"),
        ([[20, 30, 0], [np.nan, 50, 0]], "must be points"),
        ([["a", 30, 0], [4, 50, 0]], "must be points"),
        ([[20, 30, 0], [20, 30, 40]], r"dart.csv leaves surface: \(20, 30, 40\) lies 40 mm off"),
    ],
)
def test_lines_that_are_none_are_refused(line, words):
    with pytest.raises(SurfaceError, match=words):
        plane_sheet().cut(line, names=["dart.csv"])


def test_a_line_that_runs_past_a_notch_is_refused():
    part = plane_sheet()
    middle = part.points[part.triangles].mean(axis=1)
    notched = gd.Surface(part.points, part.triangles[~((abs(middle[:, 0] - 50) < 10) & (middle[:, 1] < 60))])
    with pytest.raises(SurfaceError, match="it meets the rim"):
        notched.cut([[20, 30, 0], [80, 30, 0]])
    assert notched.cut([[20, 30, 0], [50, 80, 0], [80, 30, 0]]).cuts


def test_lines_may_cross_and_touch_and_cross_themselves():
    cross = [[20, 50, 0], [80, 50, 0]], [[50, 20, 0], [50, 80, 0]]
    tee = [[20, 50, 0], [80, 50, 0]], [[47, 20, 0], [47, 50, 0]]
    star = [[50, 50, 0], [20, 30, 0]], [[50, 50, 0], [70, 20, 0]], [[50, 50, 0], [60, 85, 0]]
    knot = ([[20, 50, 0], [80, 50, 0], [60, 80, 0], [43, 20, 0]],)
    for lines, pieces in ((cross, 1), (tee, 1), (star, 1), (knot, 2)):
        cut = plane_sheet().cut(*lines)
        require_sound(cut)
        length = sum(np.linalg.norm(np.diff(np.array(line, float), axis=0), axis=1).sum() for line in lines)
        assert cut.cut_length == pytest.approx(length, rel=2e-3)
        assert rim_length(cut) == pytest.approx(400.0 + 2.0 * length, rel=2e-3)
        assert cut.n_components == pieces


def test_what_is_cut_twice_counts_once_and_a_cut_along_the_rim_is_refused():
    line = [[20, 50, 0], [80, 50, 0]]
    once, twice = plane_sheet().cut(line), plane_sheet().cut(line, [*line, [50, 50, 0]])
    assert twice.cut_length == pytest.approx(once.cut_length, rel=1e-12)
    assert len(twice.boundary_loops) == len(once.boundary_loops)
    with pytest.raises(SurfaceError, match="runs along the rim and cuts nothing"):
        plane_sheet().cut([[0, 20, 0], [0, 80, 0]])


def test_no_line_at_all_is_refused():
    with pytest.raises(SurfaceError, match="no line to cut along"):
        plane_sheet().cut()


def test_a_piece_that_cuts_part_off_is_warned_of_with_its_area():
    cut = plane_sheet().cut([[0, 33, 0], [100, 33, 0]])
    net = gd.drape(cut, (50.0, 70.0, 0.0), 0.0, 5.0)
    (said,) = (w for w in net.warnings if "pieces with its cuts" in w)
    assert "6700 mm², and 3300 mm² are left out" in said
