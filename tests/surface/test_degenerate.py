import numpy as np
import pytest
from raw_meshes import bumpy, soup

from geomdrap.errors import SurfaceError
from geomdrap.surface import Surface

SQUARE = np.array([[0, 0, 0], [100, 0, 0], [100, 100, 0], [0, 100, 0], [50, 50, 0]], dtype=float)


def test_faces_with_a_repeated_corner_are_dropped_and_numbers_follow_the_input():
    points, triangles = bumpy(4)
    mixed = np.insert(triangles, [0, 7, 32], [[3, 3, 5], [1, 2, 1], [4, 4, 4]], axis=0)
    surface = Surface(points, mixed)
    assert np.array_equal(points[mixed[surface.source_face]], surface.points[surface.triangles])
    assert surface.findings.degenerate_faces == 3


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e4])
def test_a_flat_face_is_mended_so_that_no_crack_is_left(scale):
    """The cap 0-4-2 lies along the diagonal of a square; the lower half knows nothing of vertex 4."""
    surface = Surface(SQUARE * scale, [[0, 1, 2], [0, 2, 4], [0, 4, 3], [4, 2, 3]])
    assert (surface.neighbours < 0).sum() == 4
    assert surface.area == pytest.approx((100 * scale) ** 2, rel=1e-12)
    assert sorted(surface.source_face) == [0, 0, 2, 3]
    assert (surface.normals[:, 2] > 0.99).all()
    assert surface.findings.flipped_edges == 1
    assert surface.findings.degenerate_faces == 0


def test_a_flat_face_turned_the_other_way_is_mended_as_well():
    surface = Surface(SQUARE, [[0, 1, 2], [0, 4, 2], [0, 4, 3], [4, 2, 3]])
    assert (surface.neighbours < 0).sum() == 4
    assert (surface.normals[:, 2] > 0.99).all()


def test_several_flat_faces_in_a_row_are_mended():
    n = 7
    x = np.linspace(0.0, 100.0, n + 1)
    top = np.stack([x, 0 * x, 0 * x], axis=1)
    points = np.vstack([top, [[50.0, -80.0, 0.0], [50.0, 80.0, 0.0]]])
    fan = [[i, i + 1, n + 2] for i in range(n)]
    caps = [[0, i + 1, i] for i in range(1, n)]
    surface = Surface(points, [*fan, *caps, [n + 1, n, 0]])
    assert (surface.neighbours < 0).sum() == 4
    assert surface.n_components == 1
    assert surface.area == pytest.approx(8000.0)


def test_a_flat_face_at_the_rim_is_dropped():
    surface = Surface(SQUARE, [[0, 2, 4], [0, 4, 3], [4, 2, 3]])
    assert len(surface.triangles) == 2
    assert surface.findings.degenerate_faces == 1
    assert surface.area == pytest.approx(5000.0)


def test_a_part_without_area_is_refused():
    line = np.outer(np.arange(9.0), [1.0, 2.0, 3.0])
    with pytest.raises(SurfaceError, match="no face has an area"):
        Surface(line, np.arange(9).reshape(3, 3))
    with pytest.raises(SurfaceError, match="no face has an area"):
        Surface(np.zeros((3, 3)), [[0, 1, 2]])
    rounded = np.outer(np.random.default_rng(0).random(300), [0.1, 0.7, 0.3]).astype(np.float32)
    with pytest.raises(SurfaceError, match="no face has an area"):
        Surface(rounded, np.arange(300).reshape(-1, 3))


def test_faces_there_more_than_once_are_kept_once_in_any_order_of_corners():
    points, triangles = bumpy(6)
    surface = Surface(points, np.vstack([triangles, triangles[3, [1, 2, 0]], triangles[9, [1, 0, 2]]]))
    assert np.array_equal(surface.source_face, np.arange(len(triangles)))
    assert surface.findings.duplicate_faces == 2
    surface.require_drapable()


def test_repairs_are_the_same_for_a_soup():
    points, triangles = soup(SQUARE, np.array([[0, 1, 2], [0, 2, 4], [0, 4, 3], [4, 2, 3]]))
    assert (Surface(points, triangles).neighbours < 0).sum() == 4
