"""Each face in its own plane, and the exact unfolding of its neighbours about the shared edges."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True)
def face_frames(points, triangles):  # type: ignore[no-untyped-def]
    """Orthonormal right-handed frames: e1 (m, 3) along corner 0 → 1, e2, normals, and areas (m,)."""
    m = len(triangles)
    e1, e2, normals, areas = np.empty((m, 3)), np.empty((m, 3)), np.empty((m, 3)), np.empty(m)
    for f in range(m):
        a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
        ux, uy, uz = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
        vx, vy, vz = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1], points[c, 2] - points[a, 2]
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        length = np.sqrt(ux * ux + uy * uy + uz * uz)
        double = np.sqrt(nx * nx + ny * ny + nz * nz)
        areas[f] = 0.5 * double
        ux, uy, uz = ux / length, uy / length, uz / length
        nx, ny, nz = nx / double, ny / double, nz / double
        e1[f, 0], e1[f, 1], e1[f, 2] = ux, uy, uz
        normals[f, 0], normals[f, 1], normals[f, 2] = nx, ny, nz
        e2[f, 0], e2[f, 1], e2[f, 2] = ny * uz - nz * uy, nz * ux - nx * uz, nx * uy - ny * ux
    return e1, e2, normals, areas


@njit(cache=True)
def unfold(points, triangles, neighbours, neighbour_edge):  # type: ignore[no-untyped-def]
    """Plane corners and edge crossings of each face: (m, 16) float64.

    A row is [x1, x2, y2, (c, s, tx, ty) of edge 0, of edge 1, of edge 2, 0]: corner 0 at (0, 0), corner 1
    at (x1, 0), corner 2 at (x2, y2), y2 > 0. Crossing edge k: p_g = [[c, -s], [s, c]] p_f + (tx, ty), the
    rigid motion that lays the shared edge of f on that of its neighbour g. Zeros at a boundary.
    """
    m = len(triangles)
    rows = np.zeros((m, 16))
    for f in range(m):
        a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
        ux, uy, uz = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
        vx, vy, vz = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1], points[c, 2] - points[a, 2]
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        length = np.sqrt(ux * ux + uy * uy + uz * uz)
        rows[f, 0] = length
        rows[f, 1] = (ux * vx + uy * vy + uz * vz) / length
        rows[f, 2] = np.sqrt(nx * nx + ny * ny + nz * nz) / length
    for f in range(m):
        for k in range(3):
            g = neighbours[f, k]
            if g < 0:
                continue
            j = neighbour_edge[f, k]
            x0, y0 = _corner(rows, f, k)
            x1, y1 = _corner(rows, f, (k + 1) % 3)
            p0, q0 = _corner(rows, g, (j + 1) % 3)
            p1, q1 = _corner(rows, g, j)
            dx, dy, dp, dq = x1 - x0, y1 - y0, p1 - p0, q1 - q0
            # unit vectors rather than a division by the squared length: the rotation stays a rotation
            c, s = dx * dp + dy * dq, dx * dq - dy * dp
            norm = np.sqrt(c * c + s * s)
            c, s = c / norm, s / norm
            mx, my = 0.5 * (x0 + x1), 0.5 * (y0 + y1)
            at = 3 + 4 * k
            rows[f, at], rows[f, at + 1] = c, s
            rows[f, at + 2] = 0.5 * (p0 + p1) - (c * mx - s * my)
            rows[f, at + 3] = 0.5 * (q0 + q1) - (s * mx + c * my)
    return rows


@njit(cache=True, inline="always")
def _corner(rows, f, k):  # type: ignore[no-untyped-def]
    if k == 0:
        return 0.0, 0.0
    if k == 1:
        return rows[f, 0], 0.0
    return rows[f, 1], rows[f, 2]


@njit(cache=True)
def corner_angles(points, triangles):  # type: ignore[no-untyped-def]
    """Interior angles (m, 3) radians of the faces at their corners."""
    out = np.empty((len(triangles), 3))
    for f in range(len(triangles)):
        for k in range(2):
            a, b, c = triangles[f, k], triangles[f, k + 1], triangles[f, (k + 2) % 3]
            ux, uy, uz = points[b, 0] - points[a, 0], points[b, 1] - points[a, 1], points[b, 2] - points[a, 2]
            vx, vy, vz = points[c, 0] - points[a, 0], points[c, 1] - points[a, 1], points[c, 2] - points[a, 2]
            nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
            out[f, k] = np.arctan2(np.sqrt(nx * nx + ny * ny + nz * nz), ux * vx + uy * vy + uz * vz)
        out[f, 2] = np.pi - out[f, 0] - out[f, 1]
    return out


@njit(cache=True)
def vertex_normals(triangles, normals, angles, n):  # type: ignore[no-untyped-def]
    """Unit normals (n, 3) at the vertices: the faces' normals weighted by their ``angles`` (m, 3) there.

    Source: G. Thürmer, C. Wüthrich, Computing vertex normals from polygonal facets, JGT 3(1), 1998.
    """
    result = np.zeros((n, 3))
    for f in range(len(triangles)):
        for k in range(3):
            for i in range(3):
                result[triangles[f, k], i] += angles[f, k] * normals[f, i]
    for j in range(n):
        length = np.sqrt(result[j, 0] ** 2 + result[j, 1] ** 2 + result[j, 2] ** 2)
        for i in range(3):
            result[j, i] /= max(length, 1e-300)  # zero where opposite normals cancel
    return result


@njit(cache=True)
def angle_deficits(triangles, neighbours, angles, n):  # type: ignore[no-untyped-def]
    """Angle deficits (n,) radians at the vertices: 2π less the sum of the ``angles`` (m, 3); 0 on the rim."""
    out = np.full(n, 2.0 * np.pi)
    rim = np.zeros(n, np.bool_)
    for f in range(len(triangles)):
        for k in range(3):
            a = triangles[f, k]
            out[a] -= angles[f, k]
            if neighbours[f, k] < 0:
                rim[a] = True
                rim[triangles[f, (k + 1) % 3]] = True
    out[rim] = 0.0
    return out
