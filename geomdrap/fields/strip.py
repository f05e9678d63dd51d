"""The strip between the last cell of the net and the rim of the part.

The net ends up to a cell before the rim. In the strip between, facets take the yarn directions of the facet before
them, turned over the edge between the two, and turn them on as the shear grows (see ``gradient``): exact where the
part can be unrolled, second order in the pitch elsewhere. Coordinates belong to the corners of facets, not to
vertices, so that a net that meets itself may differ on the two sides of the seam.
"""

from __future__ import annotations

import math
from heapq import heappop, heappush

import numpy as np

from geomdrap.fields.gradient import gradient_near, turn_by
from geomdrap.fields.spread import fits, outward_at_nodes, stretch, tangents_at
from geomdrap.geodesic.compiled import inlined, kernel

BARE, BY_NET, BEYOND = 0, 1, 2
IS_BLANK, IS_TOO_NARROW, IS_TOO_SHEARED = 8, 9, 10  # values of Status
# flat area over area in the strip: 1 / cos(shear) up to 75°, and some room
LEAST_STRETCH, MOST_STRETCH = 0.5, 4.0
NEARLY_PARALLEL = 0.9  # sine of the shear, 64°
OFF, OFF_SHARE = 0.2, 0.4  # cells, and shares of an edge, by which its end may be elsewhere than its yarns lead
BEYOND_NET = 2  # cells: corners of the part turned to the yarns stick out by more than one


@inlined
def products(tangent: np.ndarray) -> tuple[float, float, float]:
    """Products of the tangents (2, 3): first with itself, with the second, second with itself."""
    aa = ab = bb = 0.0
    for c in range(3):
        aa += tangent[0, c] * tangent[0, c]
        ab += tangent[0, c] * tangent[1, c]
        bb += tangent[1, c] * tangent[1, c]
    return aa, ab, bb


@kernel
def can_be(ratio: float, tangent: np.ndarray) -> bool:
    """Whether a facet of the strip can be flat area / area = ``ratio`` under yarns along ``tangent`` (2, 3).

    Too large a ratio, or too small a one where the yarns are nearly parallel, makes the spikes in a pattern.
    """
    aa, ab, bb = products(tangent)
    sine = ab / math.sqrt(aa * bb)
    return ratio < MOST_STRETCH and (ratio > LEAST_STRETCH or abs(sine) < NEARLY_PARALLEL)


@kernel
def agrees(points: np.ndarray, triangle: np.ndarray, at: np.ndarray, tangent: np.ndarray, side: float) -> bool:
    """Whether a facet's corners lie where its yarns ``tangent`` (2, 3) lead by its coordinates (3, 2).

    Where two stretches of the net meet at the corner of a box a vertex has coordinates of one of them, which lead
    elsewhere in the facets of the other.
    """
    near = (OFF * side) ** 2
    for k in range(3):
        m = (k + 1) % 3
        a, b = triangle[k], triangle[m]
        dp, dq = at[m, 0] - at[k, 0], at[m, 1] - at[k, 1]
        length = off = 0.0
        for c in range(3):
            way = points[b, c] - points[a, c]
            length += way * way
            off += (dp * tangent[0, c] + dq * tangent[1, c] - way) ** 2
        # most are nearer than the first of both allows by itself: no root is needed to see that
        if off > near and math.sqrt(off) > OFF * side + OFF_SHARE * math.sqrt(length):
            return False
    return True


@kernel
def turn_over_edge(
    tangent: np.ndarray, edge: np.ndarray, normal: np.ndarray, beyond: np.ndarray, out: np.ndarray
) -> None:
    """Turn tangents (2, 3) of a facet about an edge into the plane of the facet beyond it."""
    length = math.sqrt(edge[0] * edge[0] + edge[1] * edge[1] + edge[2] * edge[2])
    x, y, z = edge[0] / length, edge[1] / length, edge[2] / length
    hx, hy, hz = normal[1] * z - normal[2] * y, normal[2] * x - normal[0] * z, normal[0] * y - normal[1] * x
    tx, ty, tz = beyond[1] * z - beyond[2] * y, beyond[2] * x - beyond[0] * z, beyond[0] * y - beyond[1] * x
    for n in range(2):
        along = tangent[n, 0] * x + tangent[n, 1] * y + tangent[n, 2] * z
        across = tangent[n, 0] * hx + tangent[n, 1] * hy + tangent[n, 2] * hz
        out[n, 0], out[n, 1], out[n, 2] = along * x + across * tx, along * y + across * ty, along * z + across * tz


@kernel
def steps_of(tangent: np.ndarray, way: np.ndarray) -> tuple[float, float]:
    """Components (cells) of a way in the plane of the tangents (2, 3), which are mm per cell."""
    aa, ab, bb = products(tangent)
    ar = tangent[0, 0] * way[0] + tangent[0, 1] * way[1] + tangent[0, 2] * way[2]
    br = tangent[1, 0] * way[0] + tangent[1, 1] * way[1] + tangent[1, 2] * way[2]
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
def turn_on(
    tangent: np.ndarray, normal: np.ndarray, gradient: np.ndarray, at: np.ndarray, p: float, q: float, out: np.ndarray
) -> None:
    """Tangents (2, 3) at (p, q) of those at coordinates ``at`` (2,) in the same plane, as the shear grows between."""
    along_u, along_v = gradient_near(gradient, 0.5 * (at[0] + p), 0.5 * (at[1] + q))
    turn_by(tangent[0], normal, along_u * (p - at[0]), out[0])
    turn_by(tangent[1], normal, -along_v * (q - at[1]), out[1])


@kernel
def third_corner(
    corners: np.ndarray, normal: np.ndarray, at: np.ndarray, start: np.ndarray, tangent: np.ndarray,
    gradient: np.ndarray, out: np.ndarray,
) -> tuple[float, float]:
    """Coordinates of the third of the corners (3, 3) of a facet: the mean of the ways from the first two.

    ``at`` (2, 2) are theirs; ``tangent`` (2, 3) that at coordinates ``start`` (2,), turned into the facet's plane;
    ``out`` (2, 3) becomes that in the facet's middle. A way takes the tangents at its own middle.
    """
    p, q = math.nan, math.nan
    out[:] = tangent
    for n in range(3):  # the middle of a way depends on where it leads
        sum_p = sum_q = 0.0
        for k in range(2):
            if n > 0:
                turn_on(tangent, normal, gradient, start, 0.5 * (at[k, 0] + p), 0.5 * (at[k, 1] + q), out)
            dp, dq = steps_of(out, corners[2] - corners[k])
            sum_p, sum_q = sum_p + at[k, 0] + dp, sum_q + at[k, 1] + dq
        p, q = 0.5 * sum_p, 0.5 * sum_q
        if math.isnan(p):
            break
    turn_on(tangent, normal, gradient, start, (at[0, 0] + at[1, 0] + p) / 3.0, (at[0, 1] + at[1, 1] + q) / 3.0, out)
    return p, q


@kernel
def begin_in_net(
    points: np.ndarray, triangles: np.ndarray, normals: np.ndarray, vertex_at: np.ndarray, yarns: np.ndarray,
    side: float, at: np.ndarray, kind: np.ndarray, tangent: np.ndarray, queue: np.ndarray,
) -> int:
    """Set coordinates, kind and tangents of the facets whose corners all lie in the net; returns how many queued."""
    tail = 0
    outward = outward_at_nodes(yarns)
    for f in range(len(triangles)):
        for k in range(3):
            v = triangles[f, k]
            at[f, k, 0], at[f, k, 1] = vertex_at[v, 0], vertex_at[v, 1]
        p, q = (at[f, 0, 0] + at[f, 1, 0] + at[f, 2, 0]) / 3.0, (at[f, 0, 1] + at[f, 1, 1] + at[f, 2, 1]) / 3.0
        if math.isnan(p) or not fits(points, triangles[f], at[f], side):
            at[f] = np.nan
            continue
        tangents_at(p, q, yarns, outward, normals[f], side, tangent[f])
        led = not math.isnan(tangent[f, 0, 0] + tangent[f, 1, 0])
        if not led or not agrees(points, triangles[f], at[f], tangent[f], side):
            at[f] = np.nan
            continue
        kind[f] = BY_NET
        queue[tail] = f
        tail += 1
    return tail


@kernel
def add_ways(
    points: np.ndarray, triangles: np.ndarray, neighbours: np.ndarray, kind: np.ndarray, f: int, away: float,
    ways: list[tuple[float, int]],
) -> None:
    """Add the edges of facet f, ``away`` mm from the net, over which bare facets lie, with how far those are."""
    for k in range(3):
        g = neighbours[f, k]
        if g >= 0 and kind[g] == BARE:
            square = 0.0
            for c in range(3):
                between = 0.0
                for n in range(3):
                    between += points[triangles[g, n], c] - points[triangles[f, n], c]
                square += (between / 3.0) ** 2
            heappush(ways, (away + math.sqrt(square), 3 * f + k))


@kernel
def continue_beyond(
    points: np.ndarray, triangles: np.ndarray, neighbours: np.ndarray, neighbour_edge: np.ndarray,
    normals: np.ndarray, vertex_at: np.ndarray, yarns: np.ndarray, gradient: np.ndarray, valid: np.ndarray,
    status: np.ndarray, refused: np.ndarray, side: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Coordinates at the corners of all facets, in the net and in the strip beyond it.

    ``yarns`` (2, nu, nv, 3) with their ends completed, ``gradient`` (nu, nv, 2) of the shear, rad per cell.
    Returns ``at`` (m, 3, 2) cells, ``kind`` (m,) BARE, BY_NET or BEYOND, ``tangent`` (m, 2, 3) mm per cell along warp
    and weft in the facet's plane, ``stopped`` (m,), the status that keeps a facet bare, and the draped facets in the
    order in which they were reached.
    """
    m = len(triangles)
    at, tangent = np.full((m, 3, 2), np.nan), np.full((m, 2, 3), np.nan)
    kind, stopped = np.zeros(m, np.uint8), np.zeros(m, np.uint8)
    queue = np.empty(m, np.int64)
    tail = begin_in_net(points, triangles, normals, vertex_at, yarns, side, at, kind, tangent, queue)
    corners, ends, turned = np.empty((3, 3)), np.empty((2, 2)), np.empty((2, 3))
    edge, start = np.empty(3), np.empty(2)
    ways = [(0.0, 0)]  # edges 3·facet + edge over which to go on, by how far from the net: the nearest lead best
    ways.pop()
    for n in range(tail):
        f = queue[n]
        inside = True  # as most are: not worth a call
        for k in range(3):
            g = neighbours[f, k]
            inside &= g < 0 or kind[g] != BARE
        if not inside:
            add_ways(points, triangles, neighbours, kind, f, 0.0, ways)
    while len(ways) > 0:
        away, code = heappop(ways)
        f, k = code // 3, code % 3
        g, e = neighbours[f, k], neighbour_edge[f, k]
        if kind[g] != BARE:
            continue
        a, b, o = (k + 1) % 3, k, (e + 2) % 3  # corners of f where corners e and e + 1 of g are; g's third
        ends[0], ends[1] = at[f, a], at[f, b]
        for n in range(3):
            v = triangles[g, (e + n) % 3]
            for c in range(3):
                corners[n, c] = points[v, c]
        for c in range(3):
            edge[c] = corners[0, c] - corners[1, c]
        turn_over_edge(tangent[f], edge, normals[f], normals[g], turned)
        start[0] = (at[f, 0, 0] + at[f, 1, 0] + at[f, 2, 0]) / 3.0
        start[1] = (at[f, 0, 1] + at[f, 1, 1] + at[f, 2, 1]) / 3.0
        p, q = third_corner(corners, normals[g], ends, start, turned, gradient, tangent[g])
        known = vertex_at[triangles[g, o]]
        at[g, e], at[g, (e + 1) % 3], at[g, o] = ends[0], ends[1], known
        stop = 0
        if math.isnan(known[0]) or not agrees(points, triangles[g], at[g], tangent[g], side):
            at[g, o, 0], at[g, o, 1] = p, q
            stop = why_not(valid, status, refused, p, q)
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
        add_ways(points, triangles, neighbours, kind, g, away, ways)
    return at, kind, tangent, stopped, queue[:tail]
