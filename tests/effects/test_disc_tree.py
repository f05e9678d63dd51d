"""The tree of discs, against a library's nearest points."""

import numpy as np
import pytest

from geomdrap.effects.disc_tree import disc_tree, nearest_within
from geomdrap.surface import shapes
from geomdrap.surface.nearest import NearestTree

PARTS = {
    "bumps": shapes.grid_surface(
        lambda x, y: 8.0 * np.sin(0.2 * x) * np.cos(0.13 * y), np.linspace(-60, 60, 41), np.linspace(-40, 40, 29)
    ),
    "sphere": shapes.sphere_cap(40.0, 120.0, 3.0),
    "one facet": shapes.grid_surface(lambda x, y: 0.0 * x, np.array([0.0, 30.0]), np.array([0.0, 20.0])),
}


def places(part, many=400):
    """Random places about a part, among them its own vertices and the middles of facets."""
    rng = np.random.default_rng(5)
    low, high = part.bounds
    around = rng.uniform(low - 30.0, high + 30.0, (many, 3))
    return np.vstack([around, part.points[:50], part.points[part.triangles[:50]].mean(axis=1)])


@pytest.mark.parametrize("name", PARTS)
def test_nearest_points_are_those_of_the_library(name):
    part, at = PARTS[name], places(PARTS[name])
    face, near, distance = nearest_within(disc_tree(part.points, part.triangles), at, np.full(len(at), 1e3))
    known = NearestTree(part.points, part.triangles).query(at)
    np.testing.assert_allclose(distance, known.distance, atol=1e-9)
    np.testing.assert_allclose(np.linalg.norm(near - at, axis=1), distance, atol=1e-12)
    assert (face >= 0).all()


@pytest.mark.parametrize("name", PARTS)
def test_a_bound_leaves_out_what_is_further_and_nothing_else(name):
    part, at = PARTS[name], places(PARTS[name])
    tree, known = disc_tree(part.points, part.triangles), NearestTree(part.points, part.triangles).query(at)
    bound = np.random.default_rng(1).uniform(1.0, 50.0, len(at))
    clear = abs(known.distance - bound) > 1e-9
    face, near, distance = nearest_within(tree, at, bound)
    np.testing.assert_array_equal((face >= 0)[clear], (known.distance < bound)[clear])
    np.testing.assert_allclose(distance[face >= 0], known.distance[face >= 0], atol=1e-9)
    assert np.isnan(near[face < 0]).all() and np.isinf(distance[face < 0]).all()
    any_face, _, any_distance = nearest_within(tree, at, bound, first_will_do=True)
    np.testing.assert_array_equal(any_face >= 0, face >= 0)
    assert (any_distance[any_face >= 0] < bound[any_face >= 0]).all()
