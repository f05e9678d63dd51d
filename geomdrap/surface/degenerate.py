"""Faces without height: their long edge is turned where that closes the surface, else they are dropped.

A flat face (three corners on a line, common in CAD exports) cannot just be dropped: its long edge would be
left without a neighbour, and a yarn would stop at a crack that no one sees. Turning the long edge into the
other diagonal of the flat face and its neighbour leaves two proper faces.
"""

from __future__ import annotations

import numpy as np
from numba import njit

from geomdrap.surface import topology
from geomdrap.surface.types import Floats, Ints

#: a face is dropped where its height is under this share of its longest edge: no direction is left in it
NO_HEIGHT = 1e-11
ROUNDS = 12


def turn_flat_faces(points: Floats, faces: Ints, kept: Ints, tolerance: float) -> tuple[int, Floats]:
    """Turn the long edges of faces flatter than the tolerance [mm].

    faces (m, 3) and their numbers kept (m,) change in place: both faces at a turned edge carry the number of
    the proper face among the two. Flat faces at a boundary, or whose turn would help nothing, stay. Returns
    the number of turned edges, and each face's height as a share of its longest edge (m,); all zero where no
    face at all is higher than the tolerance: points on a line, but for rounding, span no part.
    """
    turned = 0
    height, edge = heights(points, faces)
    for _ in range(ROUNDS):
        if not (height < tolerance).any():
            break
        order, start = topology.sorted_edges(faces, len(points))
        neighbours, neighbour_edge, _ = topology.match_edges(order, start, len(faces))
        number = turn_long_edges(points, faces, kept, neighbours, neighbour_edge, height, tolerance)
        turned += number
        if number == 0:
            break
        height, edge = heights(points, faces)
    if (height < tolerance).all():
        return turned, np.zeros(len(faces))
    return turned, height / np.maximum(edge, np.finfo(float).tiny)


@njit(cache=True)
def heights(points, faces):  # type: ignore[no-untyped-def]
    """Height (m,) of each face over its longest edge, and the length (m,) of that edge."""
    height, edge = np.empty(len(faces)), np.empty(len(faces))
    for f in range(len(faces)):
        height[f], edge[f] = _height(points, faces[f, 0], faces[f, 1], faces[f, 2])
    return height, edge


@njit(cache=True, inline="always")
def _height(points, a, b, c):  # type: ignore[no-untyped-def]
    ux, uy, uz = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
    vx, vy, vz = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1], points[c, 2] - points[a, 2]
    wx, wy, wz = vx - ux, vy - uy, vz - uz
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    uu, vv, ww = ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz, wx * wx + wy * wy + wz * wz
    edge = np.sqrt(max(uu, vv, ww))
    if edge == 0.0:
        return 0.0, 0.0
    return np.sqrt(nx * nx + ny * ny + nz * nz) / edge, edge


@njit(cache=True)
def turn_long_edges(  # type: ignore[no-untyped-def]
    points, faces, kept, neighbours, neighbour_edge, height, tolerance
):
    """One round of edge turns on faces and kept in place; each face takes part once. Returns their number."""
    busy = np.zeros(len(faces), np.bool_)
    number = 0
    for f in range(len(faces)):
        if height[f] >= tolerance or busy[f]:
            continue
        k = _longest_edge(points, faces, f)
        g = np.int64(neighbours[f, k])
        if g < 0 or busy[g] or g == f:
            continue
        j = np.int64(neighbour_edge[f, k])
        a, b, c = faces[f, k], faces[f, (k + 1) % 3], faces[f, (k + 2) % 3]
        d = faces[g, (j + 2) % 3]
        if c == d or _joined(faces, neighbours, f, g, d) or _joined(faces, neighbours, g, f, c):
            continue
        first, _ = _height(points, a, d, c)
        second, _ = _height(points, d, b, c)
        if min(first, second) <= min(height[f], height[g]):
            continue
        # all faces around are kept out of this round: their neighbours change
        for h in (f, g):
            for i in range(3):
                busy[max(neighbours[h, i], 0)] |= neighbours[h, i] >= 0
        same = faces[g, j] == b  # g runs along the edge against f, so both face the same way
        faces[f, 0], faces[f, 1], faces[f, 2] = a, d, c
        faces[g, 0], faces[g, 1], faces[g, 2] = d, b, c
        if height[g] >= tolerance or height[g] > height[f]:
            kept[f] = kept[g]
            if not same:
                faces[f, 1], faces[f, 2] = c, d
                faces[g, 1], faces[g, 2] = c, b
        else:
            kept[g] = kept[f]
        busy[f] = busy[g] = True
        number += 1
    return number


@njit(cache=True, inline="always")
def _longest_edge(points, faces, f):  # type: ignore[no-untyped-def]
    k, longest = 0, -1.0
    for i in range(3):
        a, b = faces[f, i], faces[f, (i + 1) % 3]
        x, y, z = points[a, 0] - points[b, 0], points[a, 1] - points[b, 1], points[a, 2] - points[b, 2]
        squared = x * x + y * y + z * z
        if squared > longest:
            k, longest = i, squared
    return k


@njit(cache=True, inline="always")
def _joined(faces, neighbours, f, g, vertex):  # type: ignore[no-untyped-def]
    """Whether a neighbour of f other than g already has the vertex: the new edge would be there twice."""
    for i in range(3):
        h = neighbours[f, i]
        if h >= 0 and h != g:
            for c in range(3):
                if faces[h, c] == vertex:
                    return True
    return False
