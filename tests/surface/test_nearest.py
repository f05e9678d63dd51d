import pickle
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from raw_meshes import bumpy

from geomdrap.surface import Surface
from geomdrap.surface.nearest import Nearest, of_lowest_number


def brute_force(points, triangles, queries):
    """Distances (k,) to the nearest triangle, by the nearest point of each: inside, else on an edge."""
    best = np.full(len(queries), np.inf)
    for a, b, c in points[triangles]:
        normal = np.cross(b - a, c - a)
        foot = queries - np.outer((queries - a) @ normal / (normal @ normal), normal)
        inside = np.ones(len(queries), bool)
        for p, q in ((a, b), (b, c), (c, a)):
            inside &= np.cross(q - p, foot - p) @ normal >= 0
            t = np.clip((queries - p) @ (q - p) / ((q - p) @ (q - p)), 0, 1)
            best = np.minimum(best, np.linalg.norm(queries - p - np.outer(t, q - p), axis=1))
        best = np.where(inside, np.minimum(best, np.linalg.norm(queries - foot, axis=1)), best)
    return best


@pytest.mark.parametrize("scale", [1e-6, 1e-3, 1.0, 1e3, 1e6])
@pytest.mark.parametrize("away", [0.0, 1e3])
def test_nearest_points_agree_with_brute_force_at_any_scale_and_place(scale, away):
    points, triangles = bumpy(8, 100.0 * scale)
    shift = np.array([away, -2 * away, 3 * away]) * 100.0 * scale
    surface = Surface(points + shift, triangles)
    rng = np.random.default_rng(0)
    queries = rng.uniform(-0.5, 1.5, (300, 3)) * [100.0, 100.0, 30.0] * scale
    found = surface.nearest(queries + shift)
    expected = brute_force(points, triangles, queries)
    assert np.allclose(found.distance, expected, rtol=0, atol=(1e-13 + 1e-15 * away) * surface.diagonal)
    plane = np.einsum("ki,ki->k", found.point - surface.origin[found.face], surface.normals[found.face])
    assert np.abs(plane).max() < (1e-13 + 1e-15 * away) * surface.diagonal


def test_points_on_the_surface_are_found_on_their_own_face():
    surface = Surface(*bumpy(8))
    middle = surface.points[surface.triangles].mean(axis=1)
    found = surface.nearest(middle)
    assert (found.face == np.arange(len(middle))).all()
    assert found.distance.max() < 1e-13 * surface.diagonal


def test_a_single_point_may_be_given_flat():
    assert Surface(*bumpy()).nearest([50.0, 50.0, 500.0]).point.shape == (1, 3)


@pytest.mark.parametrize("squeezed", [1.0, 0.02])
def test_points_asked_for_one_at_a_time_agree_with_brute_force(squeezed):
    points, triangles = bumpy(8, 100.0)
    points = points * [1.0, squeezed, 1.0]  # long thin faces, too
    queries = np.random.default_rng(1).uniform(-0.5, 1.5, (40, 3)) * [100.0, 100.0, 30.0]
    surface = Surface(points, triangles)
    found = [surface.nearest(query) for query in queries]  # the first few without a tree of the part, then with it
    distance = np.concatenate([one.distance for one in found])
    assert np.allclose(distance, brute_force(points, triangles, queries), rtol=0, atol=1e-11)
    for one in found:
        own = surface.points[surface.triangles[one.face]]
        assert brute_force(own[0], np.array([[0, 1, 2]]), one.point)[0] < 1e-11


@pytest.mark.parametrize("asked_before", [0, 20])
def test_of_faces_that_hold_a_point_the_first_is_found_whatever_was_asked_before(asked_before):
    """The heading counts in the plane of that face: a drape may not hang on what was asked of the part before it."""
    surface = Surface(*bumpy(8))
    for query in np.random.default_rng(2).uniform(0.0, 100.0, (asked_before, 3)):
        surface.nearest(query)
    inner = np.flatnonzero(surface.neighbours[:, 0] >= 0)
    for face in inner[::7]:
        a, b = surface.points[surface.triangles[face, :2]]
        assert surface.nearest(0.5 * (a + b)).face[0] == min(face, surface.neighbours[face, 0])
        around = np.flatnonzero((surface.triangles == surface.triangles[face, 0]).any(axis=1))
        assert surface.nearest(a).face[0] == around[0]


def test_queries_that_are_no_points_find_nothing():
    found = Surface(*bumpy()).nearest([[np.nan, 0, 0], [1.0, 2.0, 3.0], [np.inf, 0, 0]])
    assert found.face[0] == found.face[2] == -1
    assert found.face[1] >= 0
    assert np.isnan(found.distance[[0, 2]]).all()
    assert np.isnan(found.point[0]).all()
    for bad in (np.nan, np.inf):
        assert Surface(*bumpy()).nearest([bad, 0, 0]).face[0] == -1


def test_a_surface_that_went_through_a_pickle_still_answers():
    surface = Surface(*bumpy())
    surface.nearest(np.zeros((2, 3)))
    again = pickle.loads(pickle.dumps(surface))
    assert np.array_equal(again.nearest([[3.0, 4.0, 50.0]]).point, surface.nearest([[3.0, 4.0, 50.0]]).point)


def test_threads_may_ask_one_part_for_single_points():
    """Of each part the last answers are kept: one thread must not take away what another one is about to read."""
    surface = Surface(*bumpy(8))
    queries = np.random.default_rng(3).uniform(0.0, 100.0, (400, 3))
    with ThreadPoolExecutor(4) as pool:
        found = list(pool.map(surface.nearest, queries))
    together = surface.nearest(queries)
    np.testing.assert_allclose([one.distance[0] for one in found], together.distance, atol=1e-12)


def test_a_point_on_a_face_without_area_stays_where_it_was_found():
    points = np.array([[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [5.0, 5.0, 5.0]])
    triangles = np.array([[0, 1, 2], [3, 3, 3]])
    found = Nearest(np.array([1]), points[[3]], np.zeros(1))
    assert of_lowest_number(found, points, triangles).face[0] == 1
