import numpy as np
import pytest
from raw_meshes import box, bumpy, fin, grid, ribbon, soup

from geomdrap.surface import Surface


def mutual(surface):
    """Each neighbour names the face back, across the same two vertices."""
    f, k = np.nonzero(surface.neighbours >= 0)
    g, j = surface.neighbours[f, k], surface.neighbour_edge[f, k].astype(int)
    back = (surface.neighbours[g, j] == f).all() and (surface.neighbour_edge[g, j] == k).all()
    t = surface.triangles
    runs_against = (t[f, k] == t[g, (j + 1) % 3]).all() and (t[f, (k + 1) % 3] == t[g, j]).all()
    return back and runs_against


@pytest.mark.parametrize("mesh", [bumpy, box, ribbon, fin, lambda: soup(*bumpy())])
def test_neighbours_are_mutual_and_run_against_each_other(mesh):
    assert mutual(Surface(*mesh()))


def test_a_sheet_has_neighbours_everywhere_but_on_its_rim():
    surface = Surface(*grid(5))
    assert (surface.neighbours < 0).sum() == 20
    assert ((surface.neighbours < 0) == (surface.neighbour_edge < 0)).all()
    assert not surface.closed


def test_a_box_is_closed():
    assert Surface(*box()).closed


def test_triangles_with_points_of_their_own_connect_as_if_they_shared_them():
    shared, loose = Surface(*bumpy()), Surface(*soup(*bumpy()))
    assert (loose.neighbours == shared.neighbours).all()
    assert len(loose.points) == len(shared.points)


def test_edges_with_three_faces_have_no_neighbours():
    surface = Surface(*fin())
    wall = len(surface.triangles) - 1
    assert (surface.neighbours[wall] == -1).all()
    assert surface.findings.n_non_manifold == 1
    assert surface.findings.non_manifold == ((50.0, 25.0, 0.0),)
    assert surface.n_components == 1


def test_components_are_told_apart_and_cut_out():
    points, triangles = bumpy(4)
    far = points + np.array([1000.0, 0.0, 0.0])
    both = Surface(np.vstack([points, far]), np.vstack([triangles, triangles + len(points)]))
    assert both.n_components == 2
    piece = both.only_component(len(triangles) + 3)
    assert mutual(piece)
    assert piece.n_components == 1
    assert (piece.source_face == np.arange(len(triangles), 2 * len(triangles))).all()
    assert np.array_equal(piece.points, far)
    assert (piece.vertex_of_input[: len(points)] == -1).all()
    assert (piece.vertex_of_input[len(points) :] == np.arange(len(points))).all()


def test_faces_that_touch_in_a_point_are_parted():
    points = np.array([[0, 0, 0], [10, 0, 0], [0, 10, 0], [-10, 0, 0], [0, -10, 0]], dtype=float)
    surface = Surface(points, [[0, 1, 2], [0, 3, 4]])
    assert len(surface.points) == 6
    assert surface.n_components == 2
    assert surface.findings.bow_ties == ((0.0, 0.0, 0.0),)
    assert np.array_equal(surface.points[surface.vertex_of_input], points)


def test_boundary_loops_close_and_follow_the_faces():
    points, triangles = grid(6)
    middle = points[triangles].mean(axis=1)
    hole = (np.abs(middle[:, :2] - 50.0) < 17.0).all(axis=1)
    surface = Surface(points, triangles[~hole])
    loops = surface.boundary_loops
    assert sorted(len(loop) for loop in loops) == [8, 24]
    for loop in loops:
        f, k = loop // 3, loop % 3
        end = surface.triangles[f, (k + 1) % 3]
        assert (end == np.roll(surface.triangles[f, k], -1)).all()
    found = surface.findings
    assert found.n_holes == 1
    assert [(loop.outer, round(loop.length)) for loop in found.loops] == [(True, 400), (False, 133)]


def test_a_vertex_with_very_many_faces_takes_linear_time():
    n = 200_000
    turn = np.linspace(0.0, 2.0 * np.pi, n, endpoint=False)
    points = np.vstack([[0.0, 0.0, 1e6], np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1) * 1e6])
    ring = np.arange(1, n + 1)
    surface = Surface(points, np.stack([0 * ring, ring, np.roll(ring, -1)], axis=1))
    assert (surface.neighbours < 0).sum() == n
