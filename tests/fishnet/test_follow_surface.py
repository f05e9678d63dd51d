"""Nearest places looked for from where a node stood."""

import numpy as np
import pytest
from made_parts import bumpy_sheet

from geomdrap.fishnet.follow_surface import nearest_from
from geomdrap.surface.shapes import icosphere


def searched(part, goals, face):
    return nearest_from(part.points, part.triangles, part.neighbours, part.neighbour_edge, goals, face)


def on_faces(part, rng, count):
    face = rng.integers(0, len(part.triangles), count)
    return face, np.einsum("nk,nkx->nx", rng.dirichlet([1, 1, 1], count), part.points[part.triangles[face]])


def test_on_a_sphere_the_way_downhill_ends_at_the_nearest_place_of_all():
    part, rng = icosphere(100.0, 4), np.random.default_rng(1)
    face, places = on_faces(part, rng, 4000)
    goals = places + 40.0 * rng.normal(size=places.shape)
    goals *= (1.2 * 100.0 / np.linalg.norm(goals, axis=1))[:, None]  # outside, where the part is convex
    exact = part.nearest(goals)
    place, found = searched(part, goals, face)
    np.testing.assert_allclose(place, exact.point, atol=1e-9)
    np.testing.assert_allclose(((place - part.origin[found]) * part.normals[found]).sum(axis=1), 0.0, atol=1e-9)


@pytest.mark.parametrize("seed", range(3))
def test_a_little_way_off_any_part_it_agrees_with_the_search_of_the_whole(seed):
    part, rng = bumpy_sheet(seed), np.random.default_rng(seed)
    face, places = on_faces(part, rng, 4000)
    goals = places + 0.1 * part.mean_edge * rng.normal(size=places.shape)  # beyond the rim as well
    exact = part.nearest(goals)
    place, found = searched(part, goals, face)
    apart = np.linalg.norm(place - goals, axis=1) - exact.distance
    assert (apart > -1e-12).all()
    assert (apart < 1e-9).mean() > 0.99  # in hollows a place of another facet may be nearer
    on = ((place - part.origin[found]) * part.normals[found]).sum(axis=1)
    np.testing.assert_allclose(on, 0.0, atol=1e-9)
