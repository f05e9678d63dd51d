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

import numpy as np

from geomdrap.fishnet.follow_surface import nearest_from
from geomdrap.geodesic.compiled import kernel

if TYPE_CHECKING:
    from geomdrap.surface import Surface

CREASE_COSINE = math.cos(math.radians(30.0))


@kernel
def smooth_normals(triangles: np.ndarray, normals: np.ndarray, angles: np.ndarray, n: int) -> np.ndarray:
    """Unit normals (m, 3, 3) at the corners of the facets: the mean over those at the vertex that are no edge away.

    ``angles`` (m, 3) radians, the weights.
    """
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


def stand(surface: Surface, corner_normals: np.ndarray, points: np.ndarray, last: Footing | None = None) -> Footing:
    """Nearest places of the surface; beyond its rim it goes on in the plane of the facets there.

    ``corner_normals`` (m, 3, 3) are its ``smooth_normals``. Nodes that have moved a little are looked for from where
    they stood ``last``.
    """
    if last is None:
        near = surface.nearest(points)
        face, point = near.face, near.point.copy()
    else:
        mesh = (surface.points, surface.triangles, surface.neighbours, surface.neighbour_edge)
        point, face = nearest_from(*mesh, points, last.face)
    corners = surface.triangles[face]
    gradient = _hat_gradients(surface, face, corners)
    vertices = surface.points[corners]
    share = np.einsum("nkx,nx->nk", gradient, point - vertices[:, 0])
    share[:, 0] += 1.0
    normals = corner_normals[face]
    depth = 0.5 * share * (normals * (vertices - point[:, None])).sum(axis=2)
    lift = np.einsum("nk,nkx->nx", depth, normals)
    normal = np.einsum("nk,nkx->nx", share, normals)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    beyond = points - point
    flat = surface.normals[face]
    beyond -= (beyond * flat).sum(axis=1, keepdims=True) * flat
    beyond[(surface.neighbours[face] >= 0).all(axis=1)] = 0.0
    turning = np.einsum("nkx,nky->nxy", normals, gradient)
    outside = np.linalg.norm(beyond, axis=1)
    return Footing(point + beyond, point + beyond + lift, face, normal, turning, outside)


def _hat_gradients(surface: Surface, face: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """Gradients (n, 3, 3) of the three barycentric coordinates in facets, per mm."""
    p = surface.points[corners]
    normal, double = surface.normals[face], 2.0 * surface.areas[face]
    opposite = np.stack([p[:, 2] - p[:, 1], p[:, 0] - p[:, 2], p[:, 1] - p[:, 0]], axis=1)
    return np.cross(normal[:, None], opposite) / double[:, None, None]


def tangents(normal: np.ndarray, toward: np.ndarray) -> np.ndarray:
    """Orthonormal tangent vectors (n, 3, 2) at unit normals (n, 3), the first as much along ``toward`` as can be."""
    first = toward - (toward * normal).sum(axis=1, keepdims=True) * normal
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return np.stack([first, np.cross(normal, first)], axis=2)
