import numpy as np
import pytest
from raw_meshes import box, bumpy, grid, rotation, soup

from geomdrap.errors import SurfaceError
from geomdrap.surface import Surface, shapes


def test_arrays_have_the_promised_types_and_cannot_be_written():
    surface = Surface(*bumpy())
    expected = {
        "points": np.float64, "triangles": np.int32, "source_face": np.int64, "vertex_of_input": np.int64,
        "neighbours": np.int32, "neighbour_edge": np.int8, "component": np.int32, "origin": np.float64,
        "e1": np.float64, "e2": np.float64, "normals": np.float64, "unfolded": np.float64,
        "areas": np.float64, "vertex_normals": np.float64, "bounds": np.float64, "centroid": np.float64,
    }  # fmt: skip
    for name, kind in expected.items():
        array = getattr(surface, name)
        assert array.dtype == kind, name
        assert array.flags.c_contiguous, name
        with pytest.raises(ValueError, match="read-only"):
            array[:1] = 0
    with pytest.raises(AttributeError, match="never changes"):
        surface.points = surface.points


def test_the_callers_arrays_are_left_alone():
    points, triangles = soup(*bumpy())
    before = points.copy(), triangles.copy()
    Surface(points, triangles)
    assert np.array_equal(points, before[0])
    assert np.array_equal(triangles, before[1])
    assert points.flags.writeable


def test_sizes_of_a_box():
    surface = Surface(*box())
    assert surface.area == pytest.approx(2200.0)
    assert np.array_equal(surface.bounds, [[0, 0, 0], [10, 20, 30]])
    assert surface.diagonal == pytest.approx(np.sqrt(1400.0))
    assert np.allclose(surface.centroid, [5, 10, 15])


def test_the_centroid_is_that_of_the_area_not_of_the_vertices():
    points = np.array([[0, 0, 0], [100, 0, 0], [100, 100, 0], [0, 100, 0], [1, 0, 0], [2, 0, 0]], float)
    surface = Surface(points, [[0, 4, 3], [4, 5, 3], [5, 1, 2], [5, 2, 3]])
    assert np.allclose(surface.centroid, [50, 50, 0])


def test_the_centroid_of_two_components_lies_nearer_to_the_larger():
    points, triangles = grid(2)
    small = 0.5 * points + [400.0, 0.0, 0.0]
    both = Surface(np.vstack([points, small]), np.vstack([triangles, triangles + len(points)]))
    assert np.allclose(both.centroid, [(4 * 50 + 425) / 5, (4 * 50 + 25) / 5, 0.0])


def test_scaling_scales_lengths_and_changes_nothing_else():
    points, triangles = soup(*bumpy())
    small, big = Surface(points * 1e-3, triangles), Surface(points, triangles)
    assert np.array_equal(small.triangles, big.triangles)
    assert np.array_equal(small.neighbours, big.neighbours)
    assert np.allclose(small.points * 1e3, big.points, rtol=1e-15, atol=1e-13)
    scale = np.array([1e3] * 3 + [1, 1, 1e3, 1e3] * 3 + [1])
    assert np.allclose(small.unfolded * scale, big.unfolded, rtol=1e-12, atol=1e-11)


def test_rigid_motion_changes_no_length_and_turns_the_frames_along():
    points, triangles = bumpy()
    turn, shift = rotation(), np.array([1000.0, -300.0, 50.0])
    here, there = Surface(points, triangles), Surface(points @ turn.T + shift, triangles)
    assert np.array_equal(there.neighbours, here.neighbours)
    assert np.allclose(there.unfolded, here.unfolded, atol=1e-10)
    assert np.allclose(there.e1, here.e1 @ turn.T, atol=1e-10)
    assert np.allclose(there.normals, here.normals @ turn.T, atol=1e-10)
    assert np.allclose(there.centroid, turn @ here.centroid + shift, atol=1e-9)


def test_renumbering_faces_and_vertices_gives_the_same_surface():
    points, triangles = bumpy()
    rng = np.random.default_rng(0)
    faces, vertices = rng.permutation(len(triangles)), rng.permutation(len(points))
    new_number = np.argsort(vertices)
    mixed = Surface(points[vertices], new_number[triangles[faces]])
    plain = Surface(points, triangles)
    assert np.array_equal(mixed.points[mixed.triangles], plain.points[plain.triangles][faces])
    assert np.array_equal(mixed.unfolded, plain.unfolded[faces])
    assert np.array_equal(mixed.source_face, np.arange(len(faces)))


def test_numbers_of_faces_in_the_file_are_passed_on():
    points, triangles = grid(2)
    surface = Surface(points, np.vstack([[[0, 0, 1]], triangles]), face_numbers=np.arange(9) * 10)
    assert np.array_equal(surface.source_face, np.arange(1, 9) * 10)


@pytest.mark.parametrize(
    ("points", "triangles", "words"),
    [
        ([[0, 0, 0], [1, 0, 0], [0, 1, np.nan]], [[0, 1, 2]], "vertex 2 is not a point"),
        ([[0, 0, 0], [1, 0, 0], [0, np.inf, 0]], [[0, 1, 2]], "vertex 2 is not a point"),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 3]], "vertices 0 to 3, but there are 3"),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, -1]], "vertices -1 to 1"),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [], "no triangles"),
        ([[0, 0], [1, 0], [0, 1]], [[0, 1, 2]], "an array"),
        ([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0.0, 1.0, 2.0]], "integers"),
        ([["a", 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]], "arrays of numbers"),
        ([[0, 0, 0], [1e200, 0, 0], [0, 1e200, 0]], [[0, 1, 2]], "check its unit"),
        ([[0, 0, 0], [1e-200, 0, 0], [0, 1e-200, 0]], [[0, 1, 2]], "check its unit"),
    ],
)
def test_input_that_is_no_surface_is_refused(points, triangles, words):
    with pytest.raises(SurfaceError, match=words) as caught:
        Surface(points, triangles, source="part.stl")
    assert str(caught.value).startswith("part.stl: ")


def test_a_piece_is_made_once_so_that_what_is_prepared_for_it_is_kept():
    one = shapes.plane(20.0, 20.0, edge=10.0)
    points, triangles = one.points, one.triangles
    both = Surface(np.vstack([points, points + [50.0, 0, 0]]), np.vstack([triangles, triangles + len(points)]))
    first, last = both.only_component(0), both.only_component(len(both.triangles) - 1)
    assert both.only_component(1) is first
    assert last is not first
    assert both.only_component(len(both.triangles) - 1) is last
