"""Lines that run through vertices and along edges, where the way on is not given by an unfolded face."""

import numpy as np
import pytest
from made_parts import bumpy_sheet, cube, face_point, pyramid, random_starts

from geomdrap.geodesic import Stop, trace
from geomdrap.surface import shapes


def fan(surface, vertex):
    """Faces round an interior vertex, counter-clockwise, each with its corner number there."""
    face = int(np.flatnonzero((surface.triangles == vertex).any(axis=1))[0])
    corner = int(np.flatnonzero(surface.triangles[face] == vertex)[0])
    faces = []
    while (face, corner) not in faces:
        faces.append((face, corner))
        over = (corner + 2) % 3
        face, corner = int(surface.neighbours[face, over]), int(surface.neighbour_edge[face, over])
        assert face >= 0
    return faces


def angle_in_fan(surface, faces, face, direction):
    """Angle (radians) in the faces, from the fan's first edge to a direction in one of them."""
    total = 0.0
    for number, corner in faces:
        corners = surface.points[surface.triangles[number]]
        first = corners[(corner + 1) % 3] - corners[corner]
        second = corners[(corner + 2) % 3] - corners[corner]
        if number == face:
            return total + np.arctan2(
                np.cross(first, direction) @ surface.normals[number], first @ direction
            )
        total += np.arccos(first @ second / np.linalg.norm(first) / np.linalg.norm(second))
    raise AssertionError("the direction leaves into a face that does not hold the vertex")


def whole_angle(surface, faces):
    angles = []
    for number, corner in faces:
        corners = surface.points[surface.triangles[number]]
        first = corners[(corner + 1) % 3] - corners[corner]
        second = corners[(corner + 2) % 3] - corners[corner]
        angles.append(np.arccos(first @ second / np.linalg.norm(first) / np.linalg.norm(second)))
    return sum(angles)


def interior_vertices(surface):
    rim = np.zeros(len(surface.points), bool)
    f, k = np.nonzero(surface.neighbours < 0)
    rim[surface.triangles[f, k]] = rim[surface.triangles[f, (k + 1) % 3]] = True
    return np.flatnonzero(~rim)


@pytest.mark.parametrize("surface", [bumpy_sheet(8, height=30.0), cube(60.0, 1), shapes.icosphere(50.0, 1)])
def test_a_line_through_a_vertex_has_equal_angles_on_both_sides(surface):
    rng = np.random.default_rng(0)
    for vertex in rng.choice(interior_vertices(surface), 8):
        faces = fan(surface, vertex)
        face, _ = faces[rng.integers(len(faces))]
        start = face_point(surface, face, rng.dirichlet(np.ones(3)))
        toward = surface.points[vertex] - start
        reach = np.linalg.norm(toward)
        line = trace(surface, start, toward, reach * (1 + 1e-3), face=int(face))
        assert line.stopped is Stop.LENGTH
        np.testing.assert_allclose(line.path[1], surface.points[vertex], atol=1e-12)
        back = angle_in_fan(surface, faces, face, -toward)
        onward = angle_in_fan(surface, faces, int(line.path_faces[-1]), line.path[2] - line.path[1])
        assert abs(onward - back) == pytest.approx(whole_angle(surface, faces) / 2, abs=1e-6)


def test_a_line_into_the_tip_of_a_pyramid_goes_on_at_half_of_its_angle():
    surface = pyramid(8, 1.0)
    start = face_point(surface, 0, [0.1, 0.4, 0.5])
    line = trace(surface, start, -start, 2 * np.linalg.norm(start), face=0)
    opposite = start * [-1.0, -1.0, 1.0]
    np.testing.assert_allclose(line.point, opposite, atol=1e-9)


@pytest.mark.parametrize("surface", [bumpy_sheet(9, height=30.0), cube(), shapes.bracket(edge=9.0)])
def test_every_line_can_be_walked_back(surface):
    rng = np.random.default_rng(1)
    back = 0
    for face, start, way in zip(*random_starts(surface, rng, 40), strict=True):
        line = trace(surface, start, way, 40.0, face=int(face))
        if line.stopped is not Stop.LENGTH:
            continue
        again = trace(surface, line.point, -line.direction, 40.0, face=line.face)
        np.testing.assert_allclose(again.point, start, atol=1e-8)
        np.testing.assert_allclose(again.direction, -way, atol=1e-8)
        back += 1
    assert back > 5


def test_a_line_through_a_vertex_can_be_walked_back():
    surface = bumpy_sheet(8, height=30.0)
    for vertex in interior_vertices(surface)[50:60]:
        face, _ = fan(surface, vertex)[1]
        start = face_point(surface, face, [0.3, 0.3, 0.4])
        toward = surface.points[vertex] - start
        line = trace(surface, start, toward, 1.5 * np.linalg.norm(toward), face=int(face))
        again = trace(surface, line.point, -line.direction, line.length, face=line.face)
        np.testing.assert_allclose(again.point, start, atol=1e-7)


def test_a_line_along_edges_of_a_plane_is_straight():
    surface = shapes.plane(200.0, 100.0, 10.0)
    line = trace(surface, np.array([-90.0, 0.0, 0.0]), np.array([1.0, 0.0, 0.0]), 150.0)
    assert line.stopped is Stop.LENGTH
    np.testing.assert_allclose(line.point, [60.0, 0.0, 0.0], atol=1e-10)
    diagonal = np.array([1.0, 1.0, 0.0]) / np.sqrt(2.0)
    line = trace(surface, np.array([-50.0, -50.0, 0.0]), diagonal, np.sqrt(2.0) * 77.0)
    np.testing.assert_allclose(line.point, [27.0, 27.0, 0.0], atol=1e-10)


def test_a_line_along_an_edge_keeps_to_it_up_to_the_vertex():
    surface = bumpy_sheet(12, height=30.0)
    for face in (300, 401, 733):
        a, b = surface.points[surface.triangles[face, :2]]
        line = trace(surface, 0.7 * a + 0.3 * b, b - a, 0.69 * np.linalg.norm(b - a), face=face)
        np.testing.assert_allclose(line.point, 0.01 * a + 0.99 * b, atol=1e-9)
        assert len(line.path) <= 3


@pytest.mark.parametrize("off", [1e-6, -1e-6, 1e-12, -1e-12])
def test_a_line_that_grazes_an_edge_of_a_plane_stays_straight(off):
    surface = shapes.plane(200.0, 100.0, 10.0)
    way = np.array([1.0, off, 0.0])
    line = trace(surface, np.array([-90.0, off, 0.0]), way, 150.0)
    np.testing.assert_allclose(line.point, [60.0, off * 151.0, 0.0], atol=1e-9)


def test_a_line_that_starts_at_a_vertex_goes_where_its_direction_points():
    surface = shapes.plane(100.0, 100.0, 10.0)
    for degrees in range(0, 360, 15):
        way = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0.0])
        line = trace(surface, np.zeros(3), way, 37.0)
        np.testing.assert_allclose(line.point, 37.0 * way, atol=1e-10)
