"""The views of the part: rasteriser, cameras and scene, by exact checks on simple bodies."""

import numpy as np
import pytest
from made_up import grid, made_up_drape, made_up_surface

from geomdrap.export import palette
from geomdrap.export.camera import Camera, Viewport, two_views
from geomdrap.export.raster import draw_segments, fill_triangles, visible_points
from geomdrap.export.scene import Scale, corner_values, prepare_skin, render, sharp_edges
from geomdrap.export.yarns import Yarns

UP = np.array([0.0, 0.0, 1.0])


def rasterised(pixels, triangles, values, size=(100, 100)):
    """Depth and value of facets whose corners are given in pixels and mm."""
    depth = np.full(size, -np.inf, dtype=np.float32)
    value, shade = np.zeros(size, dtype=np.float32), np.zeros(size, dtype=np.float32)
    values = np.asarray(values, dtype=np.float32)
    triangles = np.asarray(triangles, dtype=np.int32)
    fill_triangles(
        np.asarray(pixels, dtype=float), triangles, values, np.ones_like(values), depth, value, shade
    )
    return depth, value


def square(lower, upper, z):
    return [[lower, lower, z], [upper, lower, z], [upper, upper, z], [lower, upper, z]]


def two_squares():
    """A far square over all of the image, value 1, and a near one in its middle, value 2."""
    pixels = np.array(square(0, 100, 0.0) + square(30, 70, 5.0))
    triangles = np.array([[0, 1, 2], [0, 2, 3], [4, 5, 6], [4, 6, 7]])
    return pixels, triangles, np.repeat([[1.0], [1.0], [2.0], [2.0]], 3, axis=1)


@pytest.mark.parametrize("order", [[0, 1, 2, 3], [2, 3, 0, 1], [3, 0, 2, 1]])
def test_the_nearer_facet_hides_the_farther_whatever_the_order(order):
    pixels, triangles, values = two_squares()
    _, value = rasterised(pixels, triangles[order], values[order])
    expected = np.ones((100, 100))
    expected[30:70, 30:70] = 2.0
    np.testing.assert_array_equal(value, expected)


def test_values_are_interpolated_linearly_and_facets_leave_no_gaps():
    n = 12
    grid_points = np.stack(
        np.meshgrid(np.linspace(0, 100, n), np.linspace(0, 100, n), indexing="ij"), axis=-1
    )
    pixels = np.column_stack([grid_points.reshape(-1, 2), np.zeros(n * n)])
    triangles = grid(n, n)
    depth, value = rasterised(pixels, triangles, (pixels[:, 0] - 2 * pixels[:, 1])[triangles])
    assert np.all(depth == 0.0)
    j, i = np.meshgrid(np.arange(100) + 0.5, np.arange(100) + 0.5)
    np.testing.assert_allclose(value, j - 2 * i, atol=1e-4)


def test_a_facet_out_of_the_image_or_without_area_is_left_out():
    pixels = [[-50, -50, 0], [-10, -50, 0], [-10, -10, 0], [10, 10, 0], [20, 20, 0], [30, 30, 0]]
    depth, _ = rasterised(pixels, [[0, 1, 2], [3, 4, 5]], np.ones((2, 3)))
    assert np.all(depth == -np.inf)


def test_a_line_is_hidden_behind_the_part_and_seen_before_it():
    depth, _ = rasterised(*two_squares())
    for z, expected in ((1.0, 60), (6.0, 100)):
        mask = np.zeros((100, 100), dtype=np.uint8)
        draw_segments(np.array([[0.0, 50.5, z]]), np.array([[99.9, 50.5, z]]), 1, 0.1, depth, mask)
        assert np.count_nonzero(mask) == pytest.approx(
            expected, abs=4
        )  # the rim of the near square leaks a pixel
        assert mask[50, 50] == (z > 5)


def test_a_line_with_a_gap_is_drawn_up_to_the_gap():
    depth = np.full((20, 20), -np.inf, dtype=np.float32)
    line = np.array([[2.0, 10, 0], [6.0, 10, 0], [np.nan] * 3, [15.0, 10, 0]])
    mask = np.zeros((20, 20), dtype=np.uint8)
    draw_segments(line[:-1], line[1:], 1, 0.1, depth, mask)
    assert mask[:, :8].any()
    assert not mask[:, 8:].any()


def test_points_behind_a_facet_are_not_visible():
    depth, _ = rasterised(*two_squares())
    points = np.array([[50.0, 50, 6], [50.0, 50, 1], [10.0, 10, 1], [10.0, 10, -1], [500.0, 10, 1]])
    assert visible_points(points, depth, 0.1).tolist() == [True, False, True, False, False]


def test_a_camera_from_above_sees_x_to_the_right_and_y_up():
    seen = Camera.looking_from((0, 0, 1)).project(np.eye(3))
    np.testing.assert_allclose(seen, np.eye(3), atol=1e-15)
    pixels = Viewport.around(
        Camera.looking_from((0, 0, 1)), np.array([[0, 0, 0], [10, 20, 0.0]]), 200, 100, 0.0
    )
    np.testing.assert_allclose(pixels.pixels(np.array([[0, 20, 0.0]])), [[75, 0, 0]], atol=1e-9)


@pytest.mark.parametrize("direction", [(1, 0, 0), (-1, 2, 0.5), (0, 0, -1), (0.3, -0.2, -0.9)])
def test_cameras_are_right_handed_and_upright(direction):
    camera = Camera.looking_from(direction)
    np.testing.assert_allclose(np.cross(camera.right, camera.up), camera.toward, atol=1e-12)
    assert camera.up[2] >= -1e-12
    assert camera.toward @ np.array(direction) > 0


def test_a_sphere_covers_the_disc_of_its_radius():
    t, p = np.meshgrid(np.linspace(0, np.pi, 61), np.linspace(0, 2 * np.pi, 121), indexing="ij")
    points = 30 * np.stack([np.sin(t) * np.cos(p), np.sin(t) * np.sin(p), np.cos(t)], axis=-1).reshape(-1, 3)
    view = Viewport.around(Camera.looking_from((1, 2, 3)), points, 200, 200)
    triangles = grid(61, 121)
    depth, _ = rasterised(view.pixels(points), triangles, np.ones((len(triangles), 3)), (200, 200))
    disc = np.count_nonzero(np.isfinite(depth)) / view.scale**2
    assert disc == pytest.approx(np.pi * 30**2, rel=5e-3)


def channel(back):
    """A U of two high walls and a floor, open at both ends along y."""
    profile = np.array([[-20, 30], [-20, 0], [20, 0], [20, 30.0]])
    y = np.array([-40.0, 40.0])
    points = np.array([[x, t, z] for x, z in profile for t in y])
    triangles = grid(4, 2)
    return made_up_surface(points, triangles[:, ::-1] if back else triangles)


@pytest.mark.parametrize("back", [False, True])
def test_the_second_view_shows_what_the_first_does_not(back):
    surface = channel(back)
    importance = np.ones(len(surface.triangles))
    first, second = two_views(surface, importance, np.zeros(3), UP)
    assert first.toward @ second.toward < 0.9
    walls = {int(np.sign(camera.toward[0])) for camera in (first, second)}
    assert walls != {0}


def test_views_follow_the_part_to_its_other_side():
    drape = made_up_drape(n=30)
    surface = drape.net.surface
    turned = made_up_surface(surface.points * [1, -1, -1], surface.triangles)
    importance = np.ones(len(surface.triangles))
    upper, _ = two_views(surface, importance, drape.net.origin, UP)
    lower, _ = two_views(turned, importance, drape.net.origin * [1, -1, -1], -UP)
    assert upper.toward[2] > 0
    assert lower.toward[2] < 0


def test_corner_values_average_draped_faces_and_keep_bare_ones_apart():
    surface = made_up_surface([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    np.testing.assert_array_equal(corner_values(surface, np.array([2.0, 4.0])), [[3, 2, 3], [3, 3, 4]])
    bare = corner_values(surface, np.array([2.0, np.nan]))
    np.testing.assert_array_equal(bare, [[2, 2, 2], [np.nan, np.nan, np.nan]])


def test_edges_are_those_of_the_boundary_and_of_sharp_bends():
    ends = sharp_edges(channel(back=False))
    assert len(ends) == 3 * 2 + 2 + 2  # both ends of three strips, two rims, two bends
    flat = made_up_surface([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 2, 3]])
    assert len(sharp_edges(flat)) == 4


def rendered(drape, direction=(0, 0, 1), top=40.0, limit=90.0):
    skin = prepare_skin(drape.net.surface, drape.face_shear)
    nothing = Yarns((), (), 1)
    camera = Camera.looking_from(direction)
    return render(skin, camera, drape.net, yarns=nothing, scale=Scale(top, limit), size=(300, 240))


def test_the_image_is_not_mirrored_and_colours_follow_the_size_of_the_shear():
    drape = made_up_drape(n=40)
    middle = drape.net.surface.points[drape.net.surface.triangles].mean(axis=1)
    drape.face_shear = np.where((middle[:, 0] > 0) & (middle[:, 1] > 0), -40.0, 0.0)
    image = rendered(drape).image
    assert image[70, 220, 0] < 0.3  # upper right: dark
    for row, column in ((70, 80), (170, 80), (170, 220)):
        assert image[row, column, 0] > 0.7  # light


def test_bare_faces_are_grey():
    drape = made_up_drape(n=40, coverage=0.5)
    image = rendered(drape).image
    right, left = image[60:180, 200:270], image[60:180, 40:110]
    assert np.ptp(right.reshape(-1, 3), axis=1).max() < 0.08
    assert np.ptp(left.reshape(-1, 3), axis=1).min() > 0.08


def test_the_limit_is_drawn_as_a_line():
    def drawn(limit):
        image = rendered(made_up_drape(n=60), limit=limit).image
        return np.count_nonzero(np.abs(image - palette.rgb(palette.LIMIT_LINE)).max(axis=2) < 0.15)

    assert drawn(20.0) > 100
    assert drawn(89.0) == 0


def test_the_origin_is_visible_from_above_and_hidden_from_below_a_closed_side():
    drape = made_up_drape(n=40)
    lid = np.array([[-200, -200, -5], [200, -200, -5], [200, 200, -5], [-200, 200, -5.0]])
    points = np.vstack([drape.net.surface.points, lid])
    n = len(drape.net.surface.points)
    triangles = np.vstack([drape.net.surface.triangles, [[n, n + 1, n + 2], [n, n + 2, n + 3]]])
    drape.net.surface = made_up_surface(points, triangles)
    drape.face_shear = np.append(drape.face_shear, [0.0, 0.0])
    assert rendered(drape, (0, 0, 1)).origin_visible
    assert not rendered(drape, (0.2, 0, -1)).origin_visible
