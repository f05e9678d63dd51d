import numpy as np
import pytest
from raw_meshes import box, bumpy, ribbon

from geomdrap.surface import Surface


def turned(triangles, which):
    result = triangles.copy()
    result[which] = result[which][:, [0, 2, 1]]
    return result


def test_faces_turned_at_random_are_all_turned_back_to_the_majority():
    points, triangles = bumpy()
    few = np.random.default_rng(1).random(len(triangles)) < 0.3
    surface = Surface(points, turned(triangles, few))
    assert (surface.normals[:, 2] > 0).all()
    assert surface.findings.turned_faces == few.sum()


def test_the_majority_counts_by_area_not_by_number():
    points = np.array([[0, 0, 0], [100, 0, 0], [0, 100, 0], [1, -1, 0], [2, -1, 0], [100, -1, 0]], float)
    big, small = [[0, 1, 2]], [[0, 3, 1], [3, 4, 1], [4, 5, 1]]
    upward = Surface(points, big + [t[::-1] for t in small])
    assert (upward.normals[:, 2] > 0).all()
    downward = Surface(points, [t[::-1] for t in big] + [t[::-1] for t in small])
    assert (downward.normals[:, 2] < 0).all()


@pytest.mark.parametrize("inside_out", [False, True])
def test_closed_parts_face_outward(inside_out):
    points, triangles = box()
    surface = Surface(points, triangles[:, ::-1] if inside_out else triangles)
    center = np.array([5.0, 10.0, 15.0])
    assert (np.einsum("mi,mi->m", surface.normals, surface.origin - center) > 0).all()


def test_closed_parts_far_from_the_origin_face_outward():
    points, triangles = box()
    surface = Surface(points + np.array([1e6, -2e6, 3e6]), triangles[:, ::-1])
    assert surface.findings.turned_faces == 12


def test_flipping_turns_every_normal_and_keeps_the_rest():
    surface = Surface(*bumpy())
    flipped = surface.flipped()
    assert np.allclose(flipped.normals, -surface.normals, atol=1e-14)
    assert np.array_equal(np.sort(flipped.neighbours), np.sort(surface.neighbours))
    f, k = np.nonzero(flipped.neighbours >= 0)
    g, j = flipped.neighbours[f, k], flipped.neighbour_edge[f, k].astype(int)
    assert (flipped.triangles[f, k] == flipped.triangles[g, (j + 1) % 3]).all()
    assert np.array_equal(flipped.flipped().triangles, surface.triangles)


def test_a_ring_with_a_full_turn_is_orientable_and_one_with_a_half_turn_is_not():
    assert Surface(*ribbon(twist=2.0)).findings.components[0].orientable
    assert not Surface(*ribbon(twist=1.0)).findings.components[0].orientable
