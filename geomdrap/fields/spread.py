"""Fabric coordinates and yarn directions on the part where the net is; ``strip`` carries them on beyond it."""

from __future__ import annotations

import math

import numpy as np

from geomdrap.fields.locate import locate
from geomdrap.geodesic.compiled import inlined, kernel

JUMP = 0.4  # cells: neighbouring values that differ by this much more than they can belong to two sheets
MOST_SHEARED = 12.0  # a cell sheared to 85° is that much shorter across than its sides


@inlined
def fits(points: np.ndarray, triangle: np.ndarray, at: np.ndarray, side: float) -> bool:
    """Whether the coordinates (3, 2) of a facet's corners can belong to one sheet of the net."""
    for k in range(3):
        m = (k + 1) % 3
        length = 0.0
        for c in range(3):
            length += (points[triangle[k], c] - points[triangle[m], c]) ** 2
        most = MOST_SHEARED * math.sqrt(length) / side + JUMP
        if abs(at[k, 0] - at[m, 0]) > most or abs(at[k, 1] - at[m, 1]) > most:
            return False
    return True


@kernel
def stretch(points: np.ndarray, triangle: np.ndarray, at: np.ndarray, side: float) -> float:
    """Flat area over area of a facet with coordinates (3, 2) in cells; negative where it is turned over.

    Between cells of the net it is 1 / cos(shear).
    """
    a, b, c = points[triangle[0]], points[triangle[1]], points[triangle[2]]
    ux, uy, uz = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    vx, vy, vz = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    nx, ny, nz = uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx
    flat = (at[1, 0] - at[0, 0]) * (at[2, 1] - at[0, 1]) - (at[1, 1] - at[0, 1]) * (at[2, 0] - at[0, 0])
    return flat * side * side / math.sqrt(nx * nx + ny * ny + nz * nz)


@kernel
def by_net(
    points: np.ndarray,
    triangles: np.ndarray,
    neighbours: np.ndarray,
    lattice: np.ndarray,
    valid: np.ndarray,
    starts: np.ndarray,
    start_pq: np.ndarray,
    side: float,
) -> np.ndarray:
    """Fabric coordinates (n, 2) in cells of all vertices that lie in valid cells, NaN elsewhere.

    ``starts`` (k,) are facets with a known coordinate ``start_pq`` (k, 2) on or near them (nodes of the net).
    """
    at = np.full((len(points), 2), np.nan)
    seen = np.zeros(len(triangles), np.bool_)
    queue = np.empty(len(triangles), np.int64)
    for n in range(len(starts)):
        if seen[starts[n]]:
            continue
        head, tail = 0, 1
        queue[0] = starts[n]
        seen[starts[n]] = True
        first = True
        while head < tail:
            f = queue[head]
            head += 1
            p, q = start_pq[n, 0], start_pq[n, 1]
            reached = first
            for k in range(3):
                if not math.isnan(at[triangles[f, k], 0]):
                    p, q = at[triangles[f, k], 0], at[triangles[f, k], 1]
                    reached = True
            first = False
            for k in range(3):
                v = triangles[f, k]
                if reached and math.isnan(at[v, 0]):
                    found, a, b = locate(lattice, valid, p, q, points[v, 0], points[v, 1], points[v, 2], side)
                    if found:
                        at[v, 0], at[v, 1] = a, b
                        p, q = a, b
            for k in range(3):
                g = neighbours[f, k]
                known = not math.isnan(at[triangles[f, k], 0]) or not math.isnan(at[triangles[f, (k + 1) % 3], 0])
                if g >= 0 and not seen[g] and known:
                    seen[g] = True
                    queue[tail] = g
                    tail += 1
    return at


@kernel
def outward_at_nodes(yarns: np.ndarray) -> np.ndarray:
    """Unit normals (nu, nv, 3) of the planes of warp and weft ``yarns`` (2, nu, nv, 3); NaN where one is missing."""
    nu, nv = yarns.shape[1], yarns.shape[2]
    out = np.empty((nu, nv, 3))
    for i in range(nu):
        for j in range(nv):
            warp, weft = yarns[0, i, j], yarns[1, i, j]
            x, y = warp[1] * weft[2] - warp[2] * weft[1], warp[2] * weft[0] - warp[0] * weft[2]
            z = warp[0] * weft[1] - warp[1] * weft[0]
            size = math.sqrt(x * x + y * y + z * z)
            out[i, j, 0], out[i, j, 1], out[i, j, 2] = x / size, y / size, z / size
    return out


@inlined
def tangents_at(
    p: float, q: float, yarns: np.ndarray, outward: np.ndarray, normal: np.ndarray, side: float, out: np.ndarray
) -> None:
    """Yarn tangents (2, 3), mm per cell, at (p, q) in the plane across ``normal``.

    The directions ``yarns`` (2, nu, nv, 3) of the four nodes around are turned into that plane one by one, out of
    those across ``outward`` (nu, nv, 3), so that a bend between them does not look like shear.
    """
    nu, nv = yarns.shape[1:3]
    nx, ny, nz = normal[0], normal[1], normal[2]
    i = min(max(int(math.floor(p)), 0), nu - 2)
    j = min(max(int(math.floor(q)), 0), nv - 2)
    s, t = min(max(p - i, 0.0), 1.0), min(max(q - j, 0.0), 1.0)
    out[:] = 0.0
    for k in range(i, i + 2):
        for m in range(j, j + 2):
            ox, oy, oz = outward[k, m, 0], outward[k, m, 1], outward[k, m, 2]
            if math.isnan(ox):
                continue
            # Rodrigues' rotation, with (1 - cos) / sin² = 1 / (1 + cos); back to back there is no shortest way
            ax, ay, az = oy * nz - oz * ny, oz * nx - ox * nz, ox * ny - oy * nx
            cosine = ox * nx + oy * ny + oz * nz
            turn = 1.0 / (1.0 + cosine) if cosine > -0.99 else math.nan
            weight = (s if k > i else 1 - s) * (t if m > j else 1 - t)
            for n in range(2):
                x, y, z = yarns[n, k, m, 0], yarns[n, k, m, 1], yarns[n, k, m, 2]
                along = (ax * x + ay * y + az * z) * turn
                out[n, 0] += weight * (cosine * x + ay * z - az * y + ax * along)
                out[n, 1] += weight * (cosine * y + az * x - ax * z + ay * along)
                out[n, 2] += weight * (cosine * z + ax * y - ay * x + az * along)
    for n in range(2):
        length = math.sqrt(out[n, 0] ** 2 + out[n, 1] ** 2 + out[n, 2] ** 2)
        for c in range(3):
            out[n, c] = out[n, c] * side / length if length > 0.0 else math.nan
