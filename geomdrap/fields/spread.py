"""Fabric coordinates over the whole part: by the net where it is, by its yarn directions in the strip beyond.

The net ends up to a cell before the rim of the part. In the strip between, facets continue the yarn directions and
the shear of the facet before them, turned over the edge between the two: exact where the part can be unrolled, second
order in the pitch elsewhere. Coordinates belong to the corners of facets, not to vertices, so that a net that meets
itself may differ on the two sides of the seam.
"""

from __future__ import annotations

import math

import numpy as np

from geomdrap.fields.locate import locate
from geomdrap.geodesic.compiled import inlined, kernel

BARE, BY_NET, BEYOND = 0, 1, 2
JUMP = 0.4  # cells: neighbouring values that differ by this much more than they can belong to two sheets
IS_BLANK, IS_TOO_NARROW, IS_TOO_SHEARED = 8, 9, 10  # values of Status
# flat area over area in the strip: 1 / cos(shear) up to 75°, and some room
LEAST_STRETCH, MOST_STRETCH = 0.5, 4.0
NEARLY_PARALLEL = 0.9  # sine of the shear, 64°
BEYOND_NET = 2  # cells: corners of the part turned to the yarns stick out by more than one
MOST_SHEARED = 12.0  # a cell sheared to 85° is that much shorter across than its sides


@kernel
def unit(v: np.ndarray) -> np.ndarray:
    """A vector made a unit vector."""
    return v / math.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])


@kernel
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
def can_be(ratio: float, tangent: np.ndarray) -> bool:
    """Whether a facet of the strip can be flat area / area = ``ratio`` under yarns along ``tangent`` (2, 3).

    Too large a ratio, or too small a one where the yarns are nearly parallel, makes the spikes in a pattern.
    """
    sine = (tangent[0] * tangent[1]).sum() / math.sqrt((tangent[0] ** 2).sum() * (tangent[1] ** 2).sum())
    return ratio < MOST_STRETCH and (ratio > LEAST_STRETCH or abs(sine) < NEARLY_PARALLEL)


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


@inlined
def add_turned(
    weight: float, v: np.ndarray, ox: float, oy: float, oz: float, normal: np.ndarray, out: np.ndarray
) -> None:
    """Turn a vector of the plane across o into that across ``normal`` the shortest way and add it to ``out``."""
    ax, ay, az = oy * normal[2] - oz * normal[1], oz * normal[0] - ox * normal[2], ox * normal[1] - oy * normal[0]
    cosine = ox * normal[0] + oy * normal[1] + oz * normal[2]
    # Rodrigues' rotation, with (1 - cos) / sin² = 1 / (1 + cos); back to back there is no shortest way
    along = (ax * v[0] + ay * v[1] + az * v[2]) / (1.0 + cosine) if cosine > -0.99 else math.nan
    out[0] += weight * (cosine * v[0] + ay * v[2] - az * v[1] + ax * along)
    out[1] += weight * (cosine * v[1] + az * v[0] - ax * v[2] + ay * along)
    out[2] += weight * (cosine * v[2] + ax * v[1] - ay * v[0] + az * along)


@kernel
def tangents_at(p: float, q: float, yarns: np.ndarray, normal: np.ndarray, side: float, out: np.ndarray) -> None:
    """Yarn tangents (2, 3), mm per cell, at (p, q) in the plane across ``normal``.

    The directions ``yarns`` (2, nu, nv, 3) of the four nodes around are turned into that plane one by one, so that
    a bend between them does not look like shear.
    """
    nu, nv = yarns.shape[1:3]
    i = min(max(int(math.floor(p)), 0), nu - 2)
    j = min(max(int(math.floor(q)), 0), nv - 2)
    s, t = min(max(p - i, 0.0), 1.0), min(max(q - j, 0.0), 1.0)
    out[:] = 0.0
    for k in range(i, i + 2):
        for m in range(j, j + 2):
            warp, weft = yarns[0, k, m], yarns[1, k, m]
            if math.isnan(warp[0]) or math.isnan(weft[0]):
                continue
            ox, oy = warp[1] * weft[2] - warp[2] * weft[1], warp[2] * weft[0] - warp[0] * weft[2]
            oz = warp[0] * weft[1] - warp[1] * weft[0]
            size = math.sqrt(ox * ox + oy * oy + oz * oz)
            weight = (s if k > i else 1 - s) * (t if m > j else 1 - t)
            add_turned(weight, warp, ox / size, oy / size, oz / size, normal, out[0])
            add_turned(weight, weft, ox / size, oy / size, oz / size, normal, out[1])
    for n in range(2):
        length = math.sqrt(out[n, 0] ** 2 + out[n, 1] ** 2 + out[n, 2] ** 2)
        for c in range(3):
            out[n, c] = out[n, c] * side / length if length > 0.0 else math.nan


@kernel
def turn_over_edge(
    tangent: np.ndarray, edge: np.ndarray, normal: np.ndarray, beyond: np.ndarray, out: np.ndarray
) -> None:
    """Turn tangents (2, 3) of a facet about an edge into the plane of the facet beyond it."""
    e = unit(edge)
    here, there = np.cross(normal, e), np.cross(beyond, e)
    for n in range(2):
        out[n] = (tangent[n] * e).sum() * e + (tangent[n] * here).sum() * there


@kernel
def steps_of(tangent: np.ndarray, way: np.ndarray) -> tuple[float, float]:
    """Components (cells) of a way in the plane of the tangents (2, 3), which are mm per cell."""
    aa = (tangent[0] * tangent[0]).sum()
    ab = (tangent[0] * tangent[1]).sum()
    bb = (tangent[1] * tangent[1]).sum()
    ar, br = (tangent[0] * way).sum(), (tangent[1] * way).sum()
    det = aa * bb - ab * ab
    if det <= 1e-9 * aa * bb:
        return math.nan, math.nan
    return (bb * ar - ab * br) / det, (aa * br - ab * ar) / det


@kernel
def why_not(valid: np.ndarray, status: np.ndarray, refused: np.ndarray, p: float, q: float) -> int:
    """0 where the strip beyond the net may reach (p, q), else the status that stops it.

    It may reach BEYOND_NET cells further than the net, but not past a fold. ``status`` (nu + 2, nv + 2) has a
    frame of one node; ``refused`` (16,) says which statuses stop the strip.
    """
    if math.isnan(p) or math.isnan(q):
        return IS_TOO_SHEARED
    i, j = int(math.floor(p)), int(math.floor(q))
    stop = IS_TOO_NARROW
    for k in range(i, i + 2):
        for m in range(j, j + 2):
            s = status[min(max(k + 1, 0), status.shape[0] - 1), min(max(m + 1, 0), status.shape[1] - 1)]
            if refused[s] and -1 <= k < status.shape[0] - 1 and -1 <= m < status.shape[1] - 1:
                return s
            if s == IS_BLANK:
                stop = IS_BLANK
    for k in range(max(i - BEYOND_NET, 0), min(i + BEYOND_NET + 1, valid.shape[0])):
        for m in range(max(j - BEYOND_NET, 0), min(j + BEYOND_NET + 1, valid.shape[1])):
            if valid[k, m]:
                stop = 0
    return stop


@kernel
def continue_beyond(
    points: np.ndarray,
    triangles: np.ndarray,
    neighbours: np.ndarray,
    neighbour_edge: np.ndarray,
    normals: np.ndarray,
    vertex_at: np.ndarray,
    yarns: np.ndarray,
    valid: np.ndarray,
    status: np.ndarray,
    refused: np.ndarray,
    side: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Coordinates at the corners of all facets, in the net and in the strip beyond it.

    Returns ``at`` (m, 3, 2) cells, ``kind`` (m,) BARE, BY_NET or BEYOND, ``tangent`` (m, 2, 3) mm per cell along warp
    and weft in the facet's plane, and ``stopped`` (m,), the status that keeps a facet bare.
    """
    m = len(triangles)
    at = np.full((m, 3, 2), np.nan)
    kind = np.zeros(m, np.uint8)
    stopped = np.zeros(m, np.uint8)
    tangent = np.full((m, 2, 3), np.nan)
    queue = np.empty(m, np.int64)
    tail = 0
    for f in range(m):
        for k in range(3):
            at[f, k] = vertex_at[triangles[f, k]]
        p, q = (at[f, 0, 0] + at[f, 1, 0] + at[f, 2, 0]) / 3.0, (at[f, 0, 1] + at[f, 1, 1] + at[f, 2, 1]) / 3.0
        if math.isnan(p) or not fits(points, triangles[f], at[f], side):
            at[f] = np.nan
            continue
        tangents_at(p, q, yarns, normals[f], side, tangent[f])
        if math.isnan(tangent[f, 0, 0] + tangent[f, 1, 0]):
            at[f] = np.nan
            continue
        kind[f] = BY_NET
        queue[tail] = f
        tail += 1
    head = 0
    while head < tail:
        f = queue[head]
        head += 1
        for k in range(3):
            g = neighbours[f, k]
            if g < 0 or kind[g] != BARE:
                continue
            e = neighbour_edge[f, k]
            a, b = (k + 1) % 3, k  # corners of f where corners e and e + 1 of g are
            at[g, e], at[g, (e + 1) % 3] = at[f, a], at[f, b]
            edge = points[triangles[f, a]] - points[triangles[f, b]]
            turn_over_edge(tangent[f], edge, normals[f], normals[g], tangent[g])
            o = (e + 2) % 3
            third = points[triangles[g, o]]
            p1, q1 = steps_of(tangent[g], third - points[triangles[g, e]])
            p2, q2 = steps_of(tangent[g], third - points[triangles[g, (e + 1) % 3]])
            p = 0.5 * (p1 + at[g, e, 0] + p2 + at[g, (e + 1) % 3, 0])
            q = 0.5 * (q1 + at[g, e, 1] + q2 + at[g, (e + 1) % 3, 1])
            known = vertex_at[triangles[g, o]]
            if not math.isnan(known[0]) and abs(known[0] - p) < JUMP and abs(known[1] - q) < JUMP:
                p, q = known[0], known[1]
                stop = 0
            else:
                stop = why_not(valid, status, refused, p, q)
            at[g, o, 0], at[g, o, 1] = p, q
            if stop == 0 and not can_be(stretch(points, triangles[g], at[g], side), tangent[g]):
                stop = IS_TOO_SHEARED
            if stop != 0:
                at[g] = np.nan
                tangent[g] = np.nan
                stopped[g] = stop
                continue
            if math.isnan(known[0]):
                vertex_at[triangles[g, o], 0], vertex_at[triangles[g, o], 1] = p, q
            kind[g] = BEYOND
            queue[tail] = g
            tail += 1
    return at, kind, tangent, stopped
