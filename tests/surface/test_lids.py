"""Lids over holes: closed where a ply would lie over them, open where the part ends."""

import numpy as np
import pytest
from made_parts import bumpy_sheet, plate_with_holes, square_tube

from geomdrap.surface import Surface, shapes
from geomdrap.surface.lids import clip_ears, lid_over


def area_of(flat, triangles):
    a, b, c = flat[triangles].swapaxes(0, 1)
    return 0.5 * ((b - a)[:, 0] * (c - a)[:, 1] - (b - a)[:, 1] * (c - a)[:, 0])


def ring(count, radius=10.0, ripple=0.0):
    turn = 2 * np.pi * np.arange(count) / count
    r = radius * (1 + ripple * np.cos(5 * turn))
    return np.column_stack([r * np.cos(turn), r * np.sin(turn)])


def polygon_area(flat):
    x, y = flat.T
    return 0.5 * (x @ np.roll(y, -1) - y @ np.roll(x, -1))


@pytest.mark.parametrize(
    "flat",
    [
        ring(3),
        ring(40),
        ring(60, ripple=0.5),
        np.array([[0, 0], [10, 0], [10, 10], [6, 10], [6, 3], [4, 3], [4, 10], [0, 10]], float),  # a U
        np.array([[0, 0], [5, 0], [10, 0], [10, 10], [0, 10]], float),  # a straight corner
    ],
    ids=["triangle", "circle", "star", "U", "straight corner"],
)
def test_ears_fill_a_polygon_without_overlap(flat):
    ears = clip_ears(np.ascontiguousarray(flat))
    assert ears.shape == (len(flat) - 2, 3)
    pieces = area_of(flat, ears)
    assert (pieces >= 0.0).all()
    assert pieces.sum() == pytest.approx(polygon_area(flat), rel=1e-12)
    edges = np.sort(np.stack([ears, np.roll(ears, -1, axis=1)], axis=2).reshape(-1, 2), axis=1)
    count = np.unique(edges, axis=0, return_counts=True)[1]
    assert (count == 1).sum() == len(flat)
    assert count.max() <= 2


def test_a_polygon_that_crosses_itself_gets_no_lid():
    bow = np.array([[0, 0, 0], [10, 10, 0], [10, 0, 0], [0, 12, 0]], float)
    assert lid_over(bow, np.arange(4), np.tile([0.0, 0.0, 1.0], (4, 1))) is None


def test_a_hole_is_covered_in_its_plane_facing_as_the_part_does():
    part = plate_with_holes(((0.0, 0.0, 30.0), (60.0, 60.0, 20.0)))
    covered = part.lidded
    m = len(part.triangles)
    np.testing.assert_array_equal(covered.triangles[:m], part.triangles)
    np.testing.assert_array_equal(covered.points, part.points)
    assert covered.area == pytest.approx(200.0**2, rel=1e-12)
    np.testing.assert_allclose(covered.normals[m:], np.tile([0.0, 0.0, 1.0], (len(covered.triangles) - m, 1)))
    assert (covered.source_face[m:] == -1).all()
    assert (covered.neighbours[m:] >= 0).all()
    assert (part.neighbours < 0).sum() - (covered.neighbours < 0).sum() == 4 * 12 + 4 * 8


def test_the_part_itself_is_not_changed_by_its_lids():
    part = plate_with_holes()
    before = part.area, len(part.triangles), part.neighbours.copy()
    assert part.lidded is part.lidded
    assert (part.area, len(part.triangles)) == before[:2]
    np.testing.assert_array_equal(part.neighbours, before[2])


@pytest.mark.parametrize(
    "part",
    [
        shapes.plane(100.0, 60.0, 10.0),
        shapes.cylinder(30.0, 100.0, 5.0),
        square_tube(),
        shapes.icosphere(50.0, 2),
        shapes.hemisphere(50.0, 5.0),
        bumpy_sheet(2),
        shapes.l_shape(),
    ],
    ids=["plate", "tube", "square tube", "sphere", "hemisphere", "bumps", "L"],
)
def test_a_part_without_a_hole_gets_no_lid(part):
    assert part.lidded is part


def test_a_hole_on_a_dome_is_covered_by_a_flat_lid():
    dome = shapes.sphere_cap(100.0, 60.0, 4.0)
    top = dome.points[dome.triangles].mean(axis=1)[:, 2] > 98.0
    part = Surface(dome.points, dome.triangles[~top])
    covered = part.lidded
    lid = covered.normals[len(part.triangles) :]
    assert len(lid) > 3
    assert lid[:, 2].min() > 0.9
    assert part.area < covered.area < dome.area
    assert covered.neighbours[len(part.triangles) :].min() >= 0


def test_a_rim_that_winds_far_out_of_its_plane_is_left_open():
    wave = ring(60)
    rim = np.column_stack([wave, 6.0 * np.cos(3 * np.linspace(0, 2 * np.pi, 60, endpoint=False))])
    up = np.tile([0.0, 0.0, 1.0], (60, 1))
    assert lid_over(rim, np.arange(60), up) is None
    assert lid_over(rim * [1.0, 1.0, 0.1], np.arange(60), up) is not None
    assert lid_over(rim * [1.0, 1.0, 0.1], np.arange(60), np.roll(up, 1, axis=1)) is None  # a tube's end


def test_only_the_longest_rim_is_the_outline():
    part = plate_with_holes(((0.0, 0.0, 30.0), (70.0, 70.0, 20.0), (-70.0, 70.0, 10.0)))
    covered = part.lidded
    open_edges = covered.neighbours < 0
    corners = covered.triangles[open_edges.any(axis=1)]
    assert np.abs(covered.points[corners]).max(axis=(1, 2)).min() == pytest.approx(100.0)
    assert open_edges.sum() == 4 * 40
