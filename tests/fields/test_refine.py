"""Splitting facets: nothing opens, nothing moves, nothing is lost."""

import numpy as np
import pytest
from made_parts import bumpy_sheet, cube, plate_with_holes

from geomdrap.fields.refine import refine
from geomdrap.surface import Surface, shapes

PARTS = {
    "sliver": lambda: Surface([[0, 0, 0], [100, 0, 0], [50, 0.5, 0], [50, -30, 8]], [[0, 1, 2], [1, 0, 3]]),
    "bumpy": lambda: bumpy_sheet(1, n=6),
    "cube": lambda: cube(60.0, 1),
    "holes": lambda: plate_with_holes(edge=10.0),
    "tube": lambda: shapes.cylinder(30.0, 200.0, 40.0),
}


def split(part, longest):
    return refine(part.points, part.triangles, part.neighbours, part.neighbour_edge, longest)


def edges_of(triangles):
    return np.sort(np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)


def areas(points, triangles):
    a, b, c = points[triangles].swapaxes(0, 1)
    return 0.5 * np.linalg.norm(np.cross(b - a, c - a), axis=1)


@pytest.mark.parametrize("name", PARTS)
@pytest.mark.parametrize("longest", [3.0, 7.0, 50.0])
def test_no_edge_is_longer_than_asked_for_and_no_crack_opens(name, longest):
    part = PARTS[name]()
    fine = split(part, longest)
    edges, count = np.unique(edges_of(fine.triangles), axis=0, return_counts=True)
    assert np.linalg.norm(np.diff(fine.points[edges], axis=1), axis=-1).max() <= longest
    assert count.max() == 2
    whole, whole_count = np.unique(edges_of(part.triangles), axis=0, return_counts=True)
    before = len(part.points) - len(whole) + len(part.triangles)
    assert len(fine.points) - len(edges) + len(fine.triangles) == before

    def rim(points, edges):
        return np.linalg.norm(np.diff(points[edges], axis=1), axis=-1).sum()

    assert rim(fine.points, edges[count == 1]) == pytest.approx(rim(part.points, whole[whole_count == 1]), abs=1e-9)


@pytest.mark.parametrize("name", PARTS)
def test_pieces_lie_in_their_facet_with_its_area_and_its_normal(name):
    part = PARTS[name]()
    fine = split(part, 7.0)
    total = np.bincount(fine.parent, areas(fine.points, fine.triangles), len(part.triangles))
    np.testing.assert_allclose(total, part.areas, rtol=1e-12)
    a, b, c = fine.points[fine.triangles].swapaxes(0, 1)
    across = np.cross(b - a, c - a)
    along = (across * part.normals[fine.parent]).sum(axis=1)
    np.testing.assert_allclose(along, np.linalg.norm(across, axis=1), rtol=1e-9)
    off = ((a - part.origin[fine.parent]) * part.normals[fine.parent]).sum(axis=1)
    assert np.abs(off).max() < 1e-9


def test_neighbours_of_the_pieces_share_the_edge_that_they_are_said_to():
    fine = split(PARTS["bumpy"](), 5.0)
    f, k = np.nonzero(fine.neighbours >= 0)
    g, e = fine.neighbours[f, k], fine.neighbour_edge[f, k]
    np.testing.assert_array_equal(fine.triangles[f, k], fine.triangles[g, (e + 1) % 3])
    np.testing.assert_array_equal(fine.triangles[f, (k + 1) % 3], fine.triangles[g, e])
    np.testing.assert_array_equal(fine.neighbours[g, e], f)


def test_small_facets_are_left_as_they_are():
    part = PARTS["bumpy"]()
    fine = split(part, 1000.0)
    assert fine.triangles is part.triangles
    assert fine.points is part.points
    np.testing.assert_array_equal(fine.parent, np.arange(len(part.triangles)))


def test_the_vertices_of_the_part_keep_their_numbers():
    part = PARTS["tube"]()
    fine = split(part, 7.0)
    np.testing.assert_array_equal(fine.points[: len(part.points)], part.points)
