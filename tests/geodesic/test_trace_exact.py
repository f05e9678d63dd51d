"""Straightest geodesics against surfaces that unroll onto a plane, and against great circles."""

import numpy as np
import pytest
from made_parts import bumpy_sheet, pyramid, random_starts, square_tube

from geomdrap.geodesic import Stop, trace
from geomdrap.surface import shapes

RNG = np.random.default_rng(11)


@pytest.mark.parametrize("degrees", [0.0, 13.0, 45.0, 90.0, 200.0, 359.0])
def test_a_line_on_a_plane_is_straight(degrees):
    surface = shapes.plane(300.0, 200.0, 10.0)
    way = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees)), 0.0])
    line = trace(surface, np.array([1.3, -2.1, 0.0]), way, 90.0)
    assert line.stopped is Stop.LENGTH
    np.testing.assert_allclose(line.point, [1.3, -2.1, 0.0] + 90.0 * way, atol=1e-11)
    np.testing.assert_allclose(line.direction, way, atol=1e-13)
    away = np.cross(line.path - line.path[0], way)
    assert abs(away).max() < 1e-11


def unroll_prism(point, radius, angle, chords):
    """x and the length along the chords of a cylinder of facets: exact for points on the facets."""
    turn = np.arctan2(point[1], point[2]) + np.radians(angle / 2)
    step = np.radians(angle) / chords
    k = min(int(turn // step), chords - 1)
    a, b = k * step - np.radians(angle / 2), (k + 1) * step - np.radians(angle / 2)
    start, end = radius * np.array([np.sin(a), np.cos(a)]), radius * np.array([np.sin(b), np.cos(b)])
    along = (point[1:] - start) @ (end - start) / np.linalg.norm(end - start)
    return np.array([point[0], k * 2 * radius * np.sin(step / 2) + along])


@pytest.mark.parametrize("degrees", [0.0, 17.0, 45.0, 63.0, 90.0, 131.0, 200.0])
def test_a_line_on_a_cylinder_unrolls_to_a_straight_one(degrees):
    radius, angle = 50.0, 300.0
    surface = shapes.cylinder(radius, 400.0, 7.0, angle)
    chords = round(np.radians(angle) * radius / 7.0)
    near = surface.nearest(np.array([[0.5, 0.7, radius]]))
    face, start = int(near.face[0]), near.point[0]
    flat_way = np.array([np.cos(np.radians(degrees)), np.sin(np.radians(degrees))])
    along = np.array([1.0, 0.0, 0.0])
    way = flat_way[0] * along + flat_way[1] * np.cross(surface.normals[face], along)
    line = trace(surface, start, way, 110.0, face=face)
    unrolled = np.array([unroll_prism(p, radius, angle, chords) for p in line.path])
    away = unrolled - unrolled[0]
    np.testing.assert_allclose(away[-1], 110.0 * flat_way, atol=1e-9)
    assert abs(away[:, 0] * flat_way[1] - away[:, 1] * flat_way[0]).max() < 1e-9


def unroll_pyramid(point, sides, slope):
    """Distance from the tip and angle about it, in the unrolled sides."""
    turn = np.arctan2(point[1], point[0]) % (2 * np.pi)
    k = int(turn // (2 * np.pi / sides))
    rays = [
        np.array([np.cos(a), np.sin(a), -slope]) / np.hypot(1, slope)
        for a in 2 * np.pi * np.array([k, k + 1]) / sides
    ]
    whole = np.arccos(rays[0] @ rays[1])
    return np.linalg.norm(point), k * whole + np.arccos(point @ rays[0] / np.linalg.norm(point))


@pytest.mark.parametrize("side", [1.0, -1.0])
@pytest.mark.parametrize("offset", [3.0, 20.0])
def test_a_line_that_passes_the_tip_of_a_cone_unrolls_to_a_straight_one(side, offset):
    sides, slope = 12, 0.8
    surface = pyramid(sides, slope)
    start = 70.0 * np.array([np.cos(0.2), np.sin(0.2), 0.0])
    near = surface.nearest(np.array([[start[0], start[1], -slope * 70.0]]))
    start, face = near.point[0], int(near.face[0])
    toward = -start / np.linalg.norm(start)
    aside = np.cross(surface.normals[face], toward)
    reach = np.linalg.norm(start)
    way = toward * np.sqrt(1 - (offset / reach) ** 2) + side * aside * offset / reach
    line = trace(surface, start, way, 130.0, face=face)
    r0, a0 = unroll_pyramid(start, sides, slope)
    r1, a1 = unroll_pyramid(line.point, sides, slope)
    whole = sides * unroll_pyramid(np.array([np.cos(1e-12), np.sin(-1e-12), -slope]), sides, slope)[1] / sides
    # the chord of an unrolled cone: it passes the tip at the distance ``offset``
    inside = np.sqrt(reach**2 - offset**2)
    assert line.stopped is Stop.LENGTH
    assert r0 == pytest.approx(reach, abs=1e-10)
    assert r1 == pytest.approx(np.hypot(130.0 - inside, offset), abs=1e-8)
    swept = np.arctan2(inside, offset) + np.arctan2(130.0 - inside, offset)
    # keeping the tip on the left (side < 0) turns counter-clockwise about it
    assert (a1 - a0 + side * swept + whole / 2) % whole - whole / 2 == pytest.approx(0.0, abs=1e-9)


def test_a_line_round_a_square_tube_comes_back_to_its_start():
    surface = square_tube(40.0, 200.0)
    start = np.array([3.0, 7.0, 20.0])
    for turns in (1, 3):
        line = trace(surface, start, np.array([0.0, 1.0, 0.0]), turns * 160.0)
        np.testing.assert_allclose(line.point, start, atol=1e-10)
        np.testing.assert_allclose(line.direction, [0.0, 1.0, 0.0], atol=1e-12)


def great_circle_errors(level, count=60):
    surface = shapes.icosphere(100.0, level)
    rng = np.random.default_rng(5)
    errors = []
    for face, start, way in zip(*random_starts(surface, rng, count), strict=True):
        line = trace(surface, start, way, 120.0, face=face)
        centre = start / np.linalg.norm(start)
        flat = way - (way @ centre) * centre
        flat /= np.linalg.norm(flat)
        errors.append(np.linalg.norm(line.point - 100.0 * (np.cos(1.2) * centre + np.sin(1.2) * flat)))
    return np.sqrt(np.mean(np.square(errors)))


def test_lines_on_a_sphere_converge_to_great_circles():
    errors = [great_circle_errors(level) for level in (3, 4, 5)]
    order = np.log2(errors[0] / errors[2]) / 2
    assert errors[2] < 0.15
    assert order > 0.8


def test_a_line_does_not_depend_on_the_place_or_the_size_of_the_part():
    surface = bumpy_sheet(3)
    turn, _ = np.linalg.qr(np.random.default_rng(0).normal(size=(3, 3)))
    turn *= np.sign(np.linalg.det(turn))
    moved = type(surface)(1e-3 * surface.points @ turn.T + [1.0, 2.0, 3.0], surface.triangles)
    for _, start, way in zip(*random_starts(surface, RNG, 20), strict=True):
        a = trace(surface, start, way, 30.0)
        b = trace(moved, 1e-3 * turn @ start + [1.0, 2.0, 3.0], turn @ way, 0.03)
        assert a.stopped is b.stopped
        np.testing.assert_allclose(1e-3 * turn @ a.point + [1.0, 2.0, 3.0], b.point, atol=1e-12)
        assert 1e-3 * a.length == pytest.approx(b.length, abs=1e-12)
