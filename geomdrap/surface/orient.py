"""Consistent orientation: neighbours agree, the majority by area wins, closed parts face outward."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True)
def find_flips(points, triangles, neighbours, neighbour_edge):  # type: ignore[no-untyped-def]
    """Which faces to turn over, patch by patch; a patch hangs together by edges with two faces.

    Returns flip (m,) bool, patch (m,) int32 and, per patch, whether it cannot be oriented (Möbius).
    """
    m = len(triangles)
    flip = np.zeros(m, np.bool_)
    patch = np.full(m, -1, np.int32)
    twisted = np.zeros(m, np.bool_)
    queue = np.empty(m, np.int32)
    n_patches = 0
    for seed in range(m):
        if patch[seed] >= 0:
            continue
        patch[seed] = n_patches
        queue[0] = seed
        size, closed = 1, True
        i = 0
        while i < size:
            f = queue[i]
            i += 1
            for k in range(3):
                g = neighbours[f, k]
                if g < 0:
                    closed = False
                    continue
                same = triangles[f, k] == triangles[g, neighbour_edge[f, k]]
                if patch[g] < 0:
                    patch[g] = n_patches
                    flip[g] = flip[f] != same
                    queue[size] = g
                    size += 1
                elif (flip[g] != flip[f]) != same:
                    twisted[n_patches] = True
        if _turn_over(points, triangles, queue[:size], flip, closed and not twisted[n_patches]):
            for i in range(size):
                flip[queue[i]] = not flip[queue[i]]
        n_patches += 1
    return flip, patch, twisted[:n_patches].copy()


@njit(cache=True)
def _turn_over(points, triangles, faces, flip, closed):  # type: ignore[no-untyped-def]
    """Whether a patch as oriented by flip must be turned: inside out, or against most of its area."""
    ox, oy, oz = points[triangles[faces[0], 0]]
    kept, turned, volume = 0.0, 0.0, 0.0
    for f in faces:
        a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
        ax, ay, az = points[a, 0] - ox, points[a, 1] - oy, points[a, 2] - oz
        bx, by, bz = points[b, 0] - ox, points[b, 1] - oy, points[b, 2] - oz
        cx, cy, cz = points[c, 0] - ox, points[c, 1] - oy, points[c, 2] - oz
        ux, uy, uz = bx - ax, by - ay, bz - az
        vx, vy, vz = cx - ax, cy - ay, cz - az
        nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
        area = np.sqrt(nx * nx + ny * ny + nz * nz)
        if flip[f]:
            turned += area
            volume -= ax * nx + ay * ny + az * nz
        else:
            kept += area
            volume += ax * nx + ay * ny + az * nz
    if closed and abs(volume) > 1e-9 * (kept + turned) ** 1.5:
        return volume < 0.0
    # the margin keeps a tie (as a flat sheet folded on itself) at the first face's own side
    return turned > kept * (1.0 + 1e-9)


@njit(cache=True)
def turn_faces(triangles, neighbours, neighbour_edge, flip):  # type: ignore[no-untyped-def]
    """Turn the flagged faces over in place; corner 0 stays, edges 0 and 2 change places."""
    for f in range(len(triangles)):
        for k in range(3):
            g = neighbours[f, k]
            if g >= 0 and flip[g]:
                neighbour_edge[f, k] = 2 - neighbour_edge[f, k]
    for f in range(len(triangles)):
        if flip[f]:
            triangles[f, 1], triangles[f, 2] = triangles[f, 2], triangles[f, 1]
            neighbours[f, 0], neighbours[f, 2] = neighbours[f, 2], neighbours[f, 0]
            neighbour_edge[f, 0], neighbour_edge[f, 2] = neighbour_edge[f, 2], neighbour_edge[f, 0]


@njit(cache=True)
def cut_twists(triangles, neighbours, neighbour_edge):  # type: ignore[no-untyped-def]
    """Part the neighbours that still run along their edge in the same direction (in place)."""
    for f in range(len(triangles)):
        for k in range(3):
            g = neighbours[f, k]
            if g >= 0 and triangles[f, k] == triangles[g, neighbour_edge[f, k]]:
                neighbours[g, neighbour_edge[f, k]] = -1
                neighbour_edge[g, neighbour_edge[f, k]] = -1
                neighbours[f, k] = -1
                neighbour_edge[f, k] = -1
