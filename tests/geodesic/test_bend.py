"""The curvature of the vertices, shared out to their edges."""

import numpy as np
import pytest
from made_parts import bumpy_sheet, cube, pyramid, random_starts

from geomdrap.geodesic.bend import bends
from geomdrap.geodesic.mesh import mesh_of
from geomdrap.geodesic.unfold import ENDED, shoot
from geomdrap.surface import shapes


def topology(surface):
    return surface.triangles, surface.neighbours, surface.neighbour_edge, surface.unfolded


def all_bends(surface, reach=np.inf):
    return bends(*topology(surface), surface.corner_angles, deficits(surface)[0], reach)


def deficits(surface):
    """Angle deficits (n,) in radians from the corners in space; zero on the rim."""
    corners = surface.points[surface.triangles]
    total = np.zeros(len(surface.points))
    rim = np.zeros(len(surface.points), bool)
    for k in range(3):
        a, b, c = (corners[:, (k + n) % 3] for n in range(3))
        cosine = ((b - a) * (c - a)).sum(1) / np.linalg.norm(b - a, axis=1) / np.linalg.norm(c - a, axis=1)
        np.add.at(total, surface.triangles[:, k], np.arccos(cosine))
        open_edge = surface.neighbours[:, k] < 0
        rim[surface.triangles[open_edge, k]] = rim[surface.triangles[open_edge, (k + 1) % 3]] = True
    return np.where(rim, 0.0, 2 * np.pi - total), rim


def sums_of_shares(surface, turns):
    """What the edges of each vertex turn lines in sum, next to the vertex (n,)."""
    total = np.zeros(len(surface.points))
    np.add.at(total, surface.triangles.ravel(), turns[:, :, 0].ravel())
    return total


@pytest.mark.parametrize("surface", [shapes.icosphere(50.0, 3), bumpy_sheet(3)])
def test_deficits_are_two_pi_less_the_angles_of_the_faces(surface):
    np.testing.assert_allclose(surface.deficits, deficits(surface)[0], atol=1e-9)


def test_the_deficits_of_a_sphere_add_up_to_four_pi():
    surface = shapes.icosphere(50.0, 4)
    assert surface.deficits.sum() == pytest.approx(4 * np.pi, abs=1e-9)


@pytest.mark.parametrize("level", [2, 4])
def test_the_shares_of_a_smooth_vertex_sum_to_its_deficit(level):
    surface = shapes.icosphere(50.0, level)
    np.testing.assert_allclose(sums_of_shares(surface, all_bends(surface)), deficits(surface)[0], atol=1e-9)


def test_the_two_sides_of_an_edge_turn_a_line_by_the_same():
    # to cross an edge the other way is to see its vertices on the other sides: the turn changes its sign
    surface = shapes.icosphere(50.0, 3)
    turns = all_bends(surface)
    f, k = np.nonzero(surface.neighbours >= 0)
    back = turns[surface.neighbours[f, k], surface.neighbour_edge[f, k]]
    here = turns[f, k]
    for share in (0.0, 0.3, 1.0):
        there = back[:, 0] - (1.0 - share) * back[:, 1]
        np.testing.assert_allclose(here[:, 0] - share * here[:, 1], -there, atol=1e-12)


def test_the_tip_of_a_cone_is_not_spread():
    # the facets of the round cone are not quite developable about its tip: a little is spread there
    for surface, share in ((pyramid(12, 0.8), 1e-6), (shapes.cone(0.5, 100.0, 5.0), 0.15)):
        tip = int(np.argmin(np.linalg.norm(surface.points, axis=1)))
        deficit = deficits(surface)[0][tip]
        assert deficit > 0.5
        assert abs(sums_of_shares(surface, all_bends(surface))[tip]) < share * deficit


def test_the_corners_of_a_cube_are_not_spread():
    surface = cube(60.0, 6)
    assert abs(all_bends(surface)).max() < 1e-6


def test_developable_parts_have_no_bends():
    for surface in (shapes.plane(), shapes.cylinder(50.0, 100.0, 5.0, 200.0), shapes.hat_stringer()):
        assert abs(all_bends(surface)).max() < 1e-9


def test_edges_longer_than_the_reach_are_left_alone():
    surface = shapes.icosphere(50.0, 3)
    assert not all_bends(surface, 0.5 * surface.mean_edge).any()
    assert not mesh_of(surface, 0.0).row[:, 18:].any()


def test_rim_edges_have_no_bend():
    surface = shapes.sphere_cap(50.0, 60.0, 5.0)
    assert not all_bends(surface)[surface.neighbours < 0].any()


def end_of(surface, mesh, face, start, way, length):
    frame = np.array([surface.e1[face], surface.e2[face]])
    x, y = frame @ (start - surface.origin[face])
    dx, dy = frame @ way / np.linalg.norm(frame @ way)
    status, end, x, y, dx, dy, _, _ = shoot(mesh.row, mesh.link, int(face), x, y, dx, dy, length)
    assert status == ENDED
    return surface.origin[end] + (x + length * dx) * surface.e1[end] + (y + length * dy) * surface.e2[end]


def jumps(surface, spread):
    """Distances between the ends of lines that pass a vertex closely on its two sides."""
    mesh = mesh_of(surface, spread)
    rng = np.random.default_rng(3)
    out = []
    for face, start, _ in zip(*random_starts(surface, rng, 30), strict=True):
        toward = surface.points[surface.triangles[face, 0]] - start
        aside = np.cross(surface.normals[face], toward)
        ends = [
            end_of(surface, mesh, face, start, toward + off * aside, np.linalg.norm(toward) + 20.0)
            for off in (-1e-7, 1e-7)
        ]
        out.append(np.linalg.norm(ends[1] - ends[0]))
    return np.array(out)


def test_lines_on_the_two_sides_of_a_vertex_stay_together():
    surface = shapes.icosphere(50.0, 3)
    # with the sign of the turn wrong, they would part twice as fast as on the bare facets
    apart = 20.0 * deficits(surface)[0].mean()
    assert jumps(surface, 0.0).mean() > 0.5 * apart
    spread = jumps(surface, 100.0)
    assert np.median(spread) < 1e-5
    assert spread.max() < 0.1 * apart  # lines along an edge are not turned by all of its share


def test_spread_curvature_keeps_lines_closer_to_great_circles():
    surface = shapes.icosphere(100.0, 4)
    rng = np.random.default_rng(5)
    errors = {0.0: [], 100.0: []}
    starts = list(zip(*random_starts(surface, rng, 80), strict=True))
    for spread, found in errors.items():
        mesh = mesh_of(surface, spread)
        for face, start, way in starts:
            centre = start / np.linalg.norm(start)
            flat = way - (way @ centre) * centre
            flat /= np.linalg.norm(flat)
            end = end_of(surface, mesh, face, start, way, 120.0)
            found.append(end @ np.cross(centre, flat))  # sideways
    plain, spread = (np.sqrt(np.mean(np.square(e))) for e in errors.values())
    assert spread < 0.5 * plain


def test_lines_keep_their_length_where_they_turn():
    surface = shapes.icosphere(50.0, 3)
    mesh = mesh_of(surface, 100.0)
    for face, start, way in zip(*random_starts(surface, np.random.default_rng(2), 20), strict=True):
        frame = np.array([surface.e1[face], surface.e2[face]])
        x, y = frame @ (start - surface.origin[face])
        dx, dy = frame @ way
        _, _, _, _, ex, ey, _, _ = shoot(mesh.row, mesh.link, int(face), x, y, dx, dy, 300.0)
        assert np.hypot(ex, ey) == pytest.approx(1.0, abs=1e-12)
