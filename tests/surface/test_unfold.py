import numpy as np
import pytest
from raw_meshes import box, bumpy, ribbon

from geomdrap.surface import Surface


def plane_corners(surface):
    """Corners (m, 3, 2) of the faces in their own frames, from the rows of unfolded."""
    u = surface.unfolded
    zero = np.zeros(len(u))
    return np.stack([zero, zero, u[:, 0], zero, u[:, 1], u[:, 2]], axis=1).reshape(-1, 3, 2)


@pytest.fixture(params=[bumpy, box, ribbon], ids=["sheet", "box", "ring"])
def surface(request):
    return Surface(*request.param())


def test_plane_corners_are_the_corners_in_the_frame(surface):
    rays = surface.points[surface.triangles] - surface.origin[:, None]
    x = np.einsum("mci,mi->mc", rays, surface.e1)
    y = np.einsum("mci,mi->mc", rays, surface.e2)
    assert np.allclose(plane_corners(surface), np.stack([x, y], axis=2), atol=1e-12)
    assert (surface.unfolded[:, 2] > 0).all()


def test_frames_are_orthonormal_and_right_handed(surface):
    frames = np.stack([surface.e1, surface.e2, surface.normals], axis=1)
    assert np.allclose(frames @ frames.transpose(0, 2, 1), np.eye(3), atol=1e-14)
    assert np.allclose(np.linalg.det(frames), 1.0)
    along = surface.points[surface.triangles[:, 1]] - surface.points[surface.triangles[:, 0]]
    assert (np.einsum("mi,mi->m", along, surface.e1) > 0).all()


def test_normals_follow_the_right_hand_round_the_corners(surface):
    a, b, c = (surface.points[surface.triangles[:, i]] for i in range(3))
    assert (np.einsum("mi,mi->m", np.cross(b - a, c - a), surface.normals) > 0).all()


def test_crossing_an_edge_lays_its_two_corners_on_those_of_the_neighbour(surface):
    corners = plane_corners(surface)
    worst = 0.0
    for k in range(3):
        f = np.flatnonzero(surface.neighbours[:, k] >= 0)
        g, j = surface.neighbours[f, k], surface.neighbour_edge[f, k].astype(int)
        c, s, tx, ty = surface.unfolded[f, 3 + 4 * k : 7 + 4 * k].T
        for mine, its in ((k, (j + 1) % 3), ((k + 1) % 3, j)):
            x, y = corners[f, mine].T
            moved = np.stack([c * x - s * y + tx, s * x + c * y + ty], axis=1)
            worst = max(worst, np.abs(moved - corners[g, its]).max())
    assert worst < 1e-14 * surface.diagonal


def test_crossings_are_rotations_and_the_way_back_is_the_inverse(surface):
    for k in range(3):
        f = np.flatnonzero(surface.neighbours[:, k] >= 0)
        g, j = surface.neighbours[f, k], surface.neighbour_edge[f, k].astype(int)
        c, s, tx, ty = surface.unfolded[f, 3 + 4 * k : 7 + 4 * k].T
        back = surface.unfolded[g[:, None], 3 + 4 * j[:, None] + np.arange(4)]
        assert np.allclose(c * c + s * s, 1.0, atol=1e-15)
        assert np.allclose(back[:, 0], c, atol=1e-14)
        assert np.allclose(back[:, 1], -s, atol=1e-14)
        home = np.stack([c * tx + s * ty, c * ty - s * tx], axis=1)  # minus the inverse's shift
        assert np.allclose(back[:, 2:], -home, atol=1e-13 * surface.diagonal)


def test_a_neighbour_is_laid_on_the_other_side_of_the_edge(surface):
    """A reflection, or the neighbour folded onto the face, would map the two corners as well."""
    corners = plane_corners(surface)
    for k in range(3):
        f = np.flatnonzero(surface.neighbours[:, k] >= 0)
        g, j = surface.neighbours[f, k], surface.neighbour_edge[f, k].astype(int)
        c, s, tx, ty = surface.unfolded[f, 3 + 4 * k : 7 + 4 * k].T
        x, y = corners[f, (k + 2) % 3].T
        moved = np.stack([c * x - s * y + tx, s * x + c * y + ty], axis=1)
        start, end = corners[g, j], corners[g, (j + 1) % 3]
        side = (end - start)[:, 0] * (moved - start)[:, 1] - (end - start)[:, 1] * (moved - start)[:, 0]
        assert (side < 0).all()  # g itself lies on the left of its edges


def test_rows_are_zero_at_a_boundary():
    surface = Surface(*bumpy(3))
    for k in range(3):
        bare = surface.neighbours[:, k] < 0
        assert bare.any()
        assert (surface.unfolded[bare, 3 + 4 * k : 7 + 4 * k] == 0).all()


def test_vertex_normals_of_a_box_point_along_its_space_diagonals():
    """Weights by angle: how the squares are split does not matter."""
    surface = Surface(*box((10.0, 10.0, 10.0)))
    expected = (surface.points - 5.0) / np.linalg.norm(surface.points - 5.0, axis=1)[:, None]
    assert np.allclose(surface.vertex_normals, expected, atol=1e-14)
