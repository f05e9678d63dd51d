"""The part as a smooth surface that nodes move on.

On facets an energy has a kink at each edge, and the softest motions of a net would be decided by them. So a place is
named by a point of a facet, but the node stands on a curved patch over it: half of Phong tessellation, which on a
sphere or cylinder fills the gap between chord and arc. Its tangent plane is that of the vertex normals, interpolated,
and its curvature how fast these turn; all of it differs from the surface that the facets stand for to second order.
Facets that meet in an edge of more than 30° share no normal there.

Source: T. Boubekeur and M. Alexa, Phong tessellation, ACM Trans. Graphics 27 (2008).
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from geomdrap.fishnet.follow_surface import nearest_from
from geomdrap.geodesic.compiled import kernel

if TYPE_CHECKING:
    from geomdrap.surface import Surface

CREASE_COSINE = math.cos(math.radians(30.0))
ON_EDGE = 1e-9  # share of the third corner: a place where it has less is on the edge
_MADE: WeakKeyDictionary[Surface, np.ndarray] = WeakKeyDictionary()


def smooth_normals(surface: Surface) -> np.ndarray:
    """Unit normals (m, 3, 3) at the corners of the facets: the mean of those there that are no edge away."""
    if surface not in _MADE:
        mesh = surface.triangles, surface.normals, surface.corner_angles
        _MADE[surface] = _smoothed(*mesh, len(surface.points))
    return _MADE[surface]


@kernel
def _smoothed(triangles: np.ndarray, normals: np.ndarray, angles: np.ndarray, n: int) -> np.ndarray:
    """Unit normals (m, 3, 3), weighted by the ``angles`` (m, 3) radians of the facets at the vertex."""
    start = np.zeros(n + 1, np.int64)
    for f in range(len(triangles)):
        for k in range(3):
            start[triangles[f, k] + 1] += 1
    start = np.cumsum(start)
    fill = start[:-1].copy()
    around = np.empty(3 * len(triangles), np.int64)
    for f in range(len(triangles)):
        for k in range(3):
            around[fill[triangles[f, k]]] = 3 * f + k
            fill[triangles[f, k]] += 1
    out = np.zeros((len(triangles), 3, 3))
    for f in range(len(triangles)):
        nx, ny, nz = normals[f, 0], normals[f, 1], normals[f, 2]
        for k in range(3):
            v = triangles[f, k]
            x = y = z = 0.0
            for at in around[start[v] : start[v + 1]]:
                g = at // 3
                if nx * normals[g, 0] + ny * normals[g, 1] + nz * normals[g, 2] >= CREASE_COSINE:
                    weight = angles[g, at % 3]
                    x += weight * normals[g, 0]
                    y += weight * normals[g, 1]
                    z += weight * normals[g, 2]
            size = math.sqrt(x * x + y * y + z * z)
            out[f, k, 0], out[f, k, 1], out[f, k, 2] = x / size, y / size, z / size
    return out


class Footing(NamedTuple):
    """Where nodes stand.

    ``point`` (n, 3) mm of ``face`` (n,), and ``lifted`` (n, 3) mm over it on the curved patch; unit ``normal`` (n, 3)
    and ``turning`` (n, 3, 3) per mm, how it turns; ``outside`` (n,) mm, the distance beyond the rim.
    """

    point: np.ndarray
    lifted: np.ndarray
    face: np.ndarray
    normal: np.ndarray
    turning: np.ndarray
    outside: np.ndarray


def stand(surface: Surface, points: np.ndarray, face: np.ndarray | None = None) -> Footing:
    """Nearest places of the surface; beyond its rim it goes on in its tangent planes there, without a step.

    Nodes that have moved a little are looked for from each ``face`` (n,) on which they stood.
    """
    if face is None:
        near = surface.nearest(points)
        face, point = near.face, near.point.copy()
    else:
        mesh = (surface.points, surface.triangles, surface.neighbours, surface.neighbour_edge)
        point, face = nearest_from(*mesh, points, face)
    part = (surface.points, surface.triangles, surface.neighbours, surface.normals, surface.areas, surface.on_rim)
    return Footing(point, *footing(*part, smooth_normals(surface), points, point, face))


@kernel
def footing(
    vertices: np.ndarray,
    triangles: np.ndarray,
    neighbours: np.ndarray,
    normals: np.ndarray,
    areas: np.ndarray,
    rim: np.ndarray,
    corner_normals: np.ndarray,
    goal: np.ndarray,
    point: np.ndarray,
    face: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """The rest of a ``Footing`` over the places ``point`` (n, 3) of faces (n,) next to goals (n, 3).

    Where a goal lies beyond the rim ``point`` is moved there, in the tangent plane at the rim.
    """
    lifted, normal, outside = np.empty_like(point), np.zeros_like(point), np.zeros(len(point))
    turning = np.zeros((len(point), 3, 3))
    for n in range(len(point)):
        f = face[n]
        nx, ny, nz = normals[f, 0], normals[f, 1], normals[f, 2]
        px, py, pz = point[n, 0], point[n, 1], point[n, 2]
        lx = ly = lz = 0.0
        on_rim = False
        for k in range(3):
            o, e, t = triangles[f, k], triangles[f, (k + 1) % 3], triangles[f, (k + 2) % 3]
            ex = (vertices[t, 0] - vertices[e, 0]) / (2.0 * areas[f])
            ey = (vertices[t, 1] - vertices[e, 1]) / (2.0 * areas[f])
            ez = (vertices[t, 2] - vertices[e, 2]) / (2.0 * areas[f])
            hx, hy, hz = ny * ez - nz * ey, nz * ex - nx * ez, nx * ey - ny * ex  # gradient of the corner's share
            ax, ay, az = px - vertices[o, 0], py - vertices[o, 1], pz - vertices[o, 2]
            share = 1.0 + hx * ax + hy * ay + hz * az
            on_rim |= neighbours[f, (k + 1) % 3] < 0 and share < ON_EDGE
            on_rim |= rim[o] and share > 1.0 - ON_EDGE
            cx, cy, cz = corner_normals[f, k, 0], corner_normals[f, k, 1], corner_normals[f, k, 2]
            depth = -0.5 * share * (cx * ax + cy * ay + cz * az)
            lx += depth * cx
            ly += depth * cy
            lz += depth * cz
            for r in range(3):
                c = corner_normals[f, k, r]
                normal[n, r] += share * c
                turning[n, r, 0] += c * hx
                turning[n, r, 1] += c * hy
                turning[n, r, 2] += c * hz
        size = math.sqrt(normal[n, 0] ** 2 + normal[n, 1] ** 2 + normal[n, 2] ** 2)
        normal[n] /= size
        if on_rim:  # from where it goes straight on, along the tangent planes there
            mx, my, mz = normal[n, 0], normal[n, 1], normal[n, 2]
            bx, by, bz = goal[n, 0] - px, goal[n, 1] - py, goal[n, 2] - pz
            up = bx * mx + by * my + bz * mz
            bx, by, bz = bx - up * mx, by - up * my, bz - up * mz
            away = math.sqrt(bx * bx + by * by + bz * bz)
            outside[n] = away
            if away > 0.0:
                px, py, pz = px + bx, py + by, pz + bz
                for r in range(3):
                    out = (turning[n, r, 0] * bx + turning[n, r, 1] * by + turning[n, r, 2] * bz) / (away * away)
                    turning[n, r, 0] -= out * bx
                    turning[n, r, 1] -= out * by
                    turning[n, r, 2] -= out * bz
            point[n, 0], point[n, 1], point[n, 2] = px, py, pz
        lifted[n, 0], lifted[n, 1], lifted[n, 2] = px + lx, py + ly, pz + lz
    return lifted, face, normal, turning, outside


@kernel
def tangents(normal: np.ndarray, toward: np.ndarray) -> np.ndarray:
    """Orthonormal tangent vectors (n, 3, 2) at unit normals (n, 3), the first as much along ``toward`` as can be.

    Where ``toward`` (n, 3) is 0 it is along the axis that is most tangential.
    """
    out = np.empty((len(normal), 3, 2))
    for n in range(len(normal)):
        x, y, z = normal[n, 0], normal[n, 1], normal[n, 2]
        tx, ty, tz = toward[n, 0], toward[n, 1], toward[n, 2]
        if tx == 0.0 and ty == 0.0 and tz == 0.0:
            if abs(x) <= abs(y) and abs(x) <= abs(z):
                tx = 1.0
            elif abs(y) <= abs(z):
                ty = 1.0
            else:
                tz = 1.0
        up = tx * x + ty * y + tz * z
        tx, ty, tz = tx - up * x, ty - up * y, tz - up * z
        size = math.sqrt(tx * tx + ty * ty + tz * tz)
        tx, ty, tz = tx / size, ty / size, tz / size
        out[n, 0, 0], out[n, 1, 0], out[n, 2, 0] = tx, ty, tz
        out[n, 0, 1], out[n, 1, 1], out[n, 2, 1] = y * tz - z * ty, z * tx - x * tz, x * ty - y * tx
    return out
