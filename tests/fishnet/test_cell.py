"""One cell: two lines of given length that must end in one point."""

import numpy as np
import pytest
from made_parts import bumpy_sheet, random_starts

from geomdrap.fishnet.cell import CLOSED, FOLDED, OFF_PART, close_cell
from geomdrap.geodesic.mesh import mesh_of
from geomdrap.geodesic.unfold import ENDED, shoot
from geomdrap.surface import shapes

PLANE = shapes.plane(200.0, 200.0, 10.0)


def in_plane(surface, face, vector):
    return float(vector @ surface.e1[face]), float(vector @ surface.e2[face])


def in_space(surface, face, x, y):
    return surface.origin[face] + x * surface.e1[face] + y * surface.e2[face]


def walk(surface, mesh, face, point, way, length):
    """End point, end face and end direction of a line; None where it leaves the part."""
    start = in_plane(surface, face, point - surface.origin[face])
    flat = np.array(in_plane(surface, face, way))
    status, end, x, y, dx, dy, _, _ = shoot(
        mesh.row, mesh.link, int(face), *start, *(flat / np.linalg.norm(flat)), length
    )
    if status != ENDED:
        return None
    direction = dx * surface.e1[end] + dy * surface.e2[end]
    return in_space(surface, end, x + length * dx, y + length * dy), end, direction


def close(surface, mesh, b, guess_b, lb, d, guess_d, ld, sense=1.0):
    """Status, C (3,) and the directions (3,) in which the sides leave B and D; b and d are (point, face)."""
    arguments = []
    for (point, face), guess, length in ((b, guess_b, lb), (d, guess_d, ld)):
        flat = np.array(in_plane(surface, face, guess))
        flat /= np.linalg.norm(flat)
        arguments += [int(face), *in_plane(surface, face, point - surface.origin[face]), *flat, length]
    out = close_cell(mesh.row, mesh.link, mesh.frames, *arguments, sense)
    status, face, x, y, bx, by, _, _, dx, dy, _, _ = out
    leave_b = bx * surface.e1[b[1]] + by * surface.e2[b[1]]
    leave_d = dx * surface.e1[d[1]] + dy * surface.e2[d[1]]
    return status, in_space(surface, face, x, y) if status == CLOSED else None, leave_b, leave_d


def flat_cell(b, d, lb, ld, sense=1.0, guess_b=(0.1, 1.0), guess_d=(1.0, 0.1)):
    mesh = mesh_of(PLANE)
    corners = [np.array([*p, 0.0]) for p in (b, d)]
    faces = [int(f) for f in PLANE.nearest(np.array(corners)).face]
    guesses = [np.array([*g, 0.0]) for g in (guess_b, guess_d)]
    return close(
        PLANE, mesh, (corners[0], faces[0]), guesses[0], lb, (corners[1], faces[1]), guesses[1], ld, sense
    )


def test_the_end_of_a_line_moves_across_its_end_direction_by_the_length_times_the_turn():
    # dC/dθ = L (n × d): exact on facets until the line passes over a vertex
    surface = bumpy_sheet(2, n=20)
    mesh = mesh_of(surface)
    tried, step, length = 0, 1e-6, 25.0
    for face, start, way in zip(*random_starts(surface, np.random.default_rng(0), 60), strict=True):
        aside = np.cross(surface.normals[face], way)
        middle, low, high = (walk(surface, mesh, face, start, way + t * step * aside, length) for t in (0, -1, 1))
        if middle is None or low is None or high is None or len({middle[1], low[1], high[1]}) > 1:
            continue
        slope = (high[0] - low[0]) / (2 * step)
        exact = length * np.cross(surface.normals[middle[1]], middle[2])
        np.testing.assert_allclose(slope, exact, atol=1e-6 * length)
        tried += 1
    assert tried > 20


@pytest.mark.parametrize("shear", [-80.0, -40.0, 0.0, 25.0, 60.0, 85.0])
def test_a_flat_cell_closes_as_a_rhombus(shear):
    side, turn = 7.0, np.radians(90.0 - shear)
    b, d = side * np.array([1.0, 0.0]), side * np.array([np.cos(turn), np.sin(turn)])
    status, c, _, _ = flat_cell(b, d, side, side, guess_b=d + 0.2, guess_d=b - 0.2)
    assert status == CLOSED
    np.testing.assert_allclose(c[:2], b + d, atol=1e-9)


@pytest.mark.parametrize(("lb", "ld"), [(7.0, 7.0), (7.0, 8.5), (4.0, 6.5)])
@pytest.mark.parametrize("sense", [1.0, -1.0])
def test_a_cell_with_sides_of_its_own_closes_on_the_side_asked_for(lb, ld, sense):
    b, d = np.array([6.0, -1.0]), np.array([0.5, sense * 7.0])
    status, c, leave_b, leave_d = flat_cell(b, d, lb, ld, sense, (0.0, sense), (1.0, 0.0))
    assert status == CLOSED
    assert np.linalg.norm(c[:2] - b) == pytest.approx(lb, abs=1e-9)
    assert np.linalg.norm(c[:2] - d) == pytest.approx(ld, abs=1e-9)
    turn = np.cross([*(c[:2] - b), 0.0], [*(d - c[:2]), 0.0])[2]
    assert turn * sense > 0
    np.testing.assert_allclose(leave_b[:2], (c[:2] - b) / lb, atol=1e-9)
    np.testing.assert_allclose(leave_d[:2], (c[:2] - d) / ld, atol=1e-9)


def test_lines_too_short_to_meet_are_a_fold():
    status, _, _, _ = flat_cell([10.0, 0.0], [0.0, 10.0], 7.0, 7.0)
    assert status == FOLDED


def test_lines_from_one_point_are_a_fold():
    status, _, _, _ = flat_cell([3.0, 3.0], [3.0, 3.0], 7.0, 7.0)
    assert status == FOLDED


def test_a_cell_over_the_rim_is_off_the_part():
    status, _, _, _ = flat_cell([97.0, 0.0], [90.0, 7.0], 7.0, 14.0, guess_b=(0.5, 1.0), guess_d=(1.0, 0.0))
    assert status == OFF_PART


@pytest.mark.parametrize("spread", [0.0, 1.0])
@pytest.mark.parametrize("name", ["bumps", "sphere", "saddle"])
def test_the_ends_of_the_sides_of_a_closed_cell_coincide(name, spread):
    surface = {
        "bumps": bumpy_sheet(4, n=30, height=25.0),
        "sphere": shapes.icosphere(60.0, 4),
        "saddle": shapes.saddle(80.0, 120.0, 5.0),
    }[name]
    rng = np.random.default_rng(8)
    closed = 0
    worst = 0.0
    for face, start, way in zip(*random_starts(surface, rng, 80), strict=True):
        side = rng.uniform(0.3, 3.0) * surface.mean_edge
        mesh = mesh_of(surface, spread * 20.0)
        turn = np.radians(rng.uniform(20.0, 160.0))
        aside = np.cos(turn) * way + np.sin(turn) * np.cross(surface.normals[face], way)
        b, d = walk(surface, mesh, face, start, way, side), walk(surface, mesh, face, start, aside, side)
        if b is None or d is None:
            continue
        guess_b = np.cos(turn) * b[2] + np.sin(turn) * np.cross(surface.normals[b[1]], b[2])
        guess_d = np.cos(turn) * d[2] - np.sin(turn) * np.cross(surface.normals[d[1]], d[2])
        status, c, leave_b, leave_d = close(
            surface, mesh, (b[0], b[1]), guess_b, side, (d[0], d[1]), guess_d, side
        )
        if status != CLOSED:
            continue
        end_b = walk(surface, mesh, b[1], b[0], leave_b, side)
        end_d = walk(surface, mesh, d[1], d[0], leave_d, side)
        worst = max(worst, np.linalg.norm(end_b[0] - c) / side, np.linalg.norm(end_d[0] - c) / side)
        closed += 1
    assert closed > 30
    # the last correction leaves its square, and its product with the bends, which are large on coarse bumps
    assert worst < (1e-6 if spread and name == "bumps" else 1e-7)
