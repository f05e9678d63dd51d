import numpy as np
import pytest
from raw_meshes import bumpy, grid, soup

from geomdrap.surface import Surface


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e3])
def test_near_twins_become_one_at_any_scale(scale):
    points, triangles = soup(*bumpy(8, 100.0 * scale))
    noise = np.random.default_rng(0).uniform(-1, 1, points.shape) * 2e-8 * 100.0 * scale
    surface = Surface(points + noise, triangles)
    assert len(surface.points) == 81
    assert surface.findings.n_loops == 1


def test_every_input_vertex_lies_within_the_tolerance_of_its_new_vertex():
    points, triangles = soup(*bumpy(8))
    points = points + np.random.default_rng(0).uniform(-1, 1, points.shape) * 2e-6
    surface = Surface(points, triangles)
    away = np.linalg.norm(surface.points[surface.vertex_of_input] - points, axis=1)
    assert 0.0 < away.max() <= surface.findings.weld_tolerance


@pytest.mark.parametrize("apart", [1e-4, -1e-4])
def test_twins_on_both_sides_of_a_cell_wall_of_the_hash_are_found(apart):
    for shift in np.linspace(0.0, 6e-4, 41):  # cells are four tolerances wide: 5.7e-4
        points, triangles = grid(2)
        points = np.vstack([points, points[4] + [apart, 0.0, 0.0]])
        triangles = np.where((triangles == 4) & (np.arange(8) % 2 == 0)[:, None], 9, triangles)
        points[:, 0] += np.where(points[:, 0] > 0, shift, 0.0)
        assert len(Surface(points, triangles).points) == 9


def test_a_chain_of_close_points_does_not_collapse_into_one():
    points, triangles = grid(100, 100.0)
    fine = points * [1.0, 1.0, 1.0]
    surface = Surface(
        np.vstack([fine, [[1e7, 0, 0], [1e7 + 1, 0, 0], [1e7, 1, 0]]]),
        np.vstack([triangles, np.arange(3) + len(fine)]),
    )
    # the far-off facet makes the diagonal 10 km, whose millionth is ten edges of the sheet
    assert len(surface.points) == len(points) + 3


def test_short_edges_well_above_the_tolerance_are_kept():
    x = np.array([0.0, 0.01, 1.0, 100.0])
    points = np.array([[a, b, 0.0] for a in x for b in (0.0, 50.0)])
    triangles = [t for i in (0, 2, 4) for t in ((i, i + 2, i + 3), (i, i + 3, i + 1))]
    assert len(Surface(points, triangles).triangles) == 6


def test_vertices_without_a_face_are_dropped_and_do_not_set_the_scale():
    points, triangles = bumpy(4)
    surface = Surface(np.vstack([[[1e9, 0, 0]], points, [[0, 0, -1e9]]]), triangles + 1)
    assert np.array_equal(surface.points, points)
    assert surface.vertex_of_input[0] == surface.vertex_of_input[-1] == -1
    assert surface.findings.unused_points == 2
    assert surface.findings.weld_tolerance < 1e-3


def test_zero_and_minus_zero_are_the_same_place():
    points, triangles = soup(*grid(2))
    points[::2] = np.where(points[::2] == 0.0, -0.0, points[::2])
    assert len(Surface(points, triangles).points) == 9
