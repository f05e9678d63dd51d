"""Curvature spread from the vertices along the edges, so that lines follow the curved part and not its facets.

A mesh keeps all of its Gaussian curvature in the vertices. A straightest line that passes many of them closely on
one side has all of their angle deficit on that side, where the curved surface has half: on a sphere of 80,000
facets nets are then off by up to 0.1° of shear, depending on how the seed lies to the mesh. Here the deficit of a
vertex is shared out to its edges in proportion to the face angles beside them; a line that crosses an edge turns
by the share of the vertex on its right, less that of the vertex on its left, each falling off linearly along the
edge. A line through a vertex turns by half its deficit from either side, which is the straightest line there; the
end point becomes a continuous function of the heading; and beyond the first ring of faces nothing changes.

What is sharp on purpose stays sharp: the tip of a cone, the corner of a box (a deficit that its neighbours do not
share), and edges much longer than the mesh is fine there. And curvature is moved no further than ``reach``, which
the net sets to a few cells: where facets are larger than that, the net follows them as they are.
"""

from __future__ import annotations

import math

import numpy as np

from geomdrap.geodesic.compiled import kernel

SMOOTH = 4.0  # a deficit up to this multiple of what the neighbours' curvature gives is spread
LONG = 2.0  # edges longer than this multiple of the shortest one at the vertex take no share
ROUNDING = 1.0 + 1e-6  # edges of just these lengths are common, and must be taken or left in the same way everywhere


@kernel
def vertex_sizes(triangles: np.ndarray, unfolded: np.ndarray, n: int) -> tuple[np.ndarray, np.ndarray]:
    """Area (n,) mm² and shortest edge (n,) mm of each vertex."""
    area = np.zeros(n)
    shortest = np.full(n, np.inf)
    for f in range(len(triangles)):
        r = unfolded[f]
        third = r[0] * r[2] / 6.0
        lengths = (r[0], math.hypot(r[1] - r[0], r[2]), math.hypot(r[1], r[2]))
        for k in range(3):
            a, b = triangles[f, k], triangles[f, (k + 1) % 3]
            area[a] += third
            shortest[a] = min(shortest[a], lengths[k])
            shortest[b] = min(shortest[b], lengths[k])
    return area, shortest


@kernel
def smooth_part(triangles: np.ndarray, deficit: np.ndarray, area: np.ndarray) -> np.ndarray:
    """The part (n,) of each deficit that the curvature of the neighbouring vertices accounts for."""
    n = len(deficit)
    total = np.zeros(n)
    count = np.zeros(n)
    for f in range(len(triangles)):
        for k in range(3):
            a = triangles[f, k]
            for step in (1, 2):
                b = triangles[f, (k + step) % 3]
                total[a] += abs(deficit[b]) / area[b]
                count[a] += 1.0
    out = np.empty(n)
    for a in range(n):
        most = SMOOTH * area[a] * total[a] / max(count[a], 1.0)
        out[a] = min(max(deficit[a], -most), most)
    return out


@kernel
def bends(
    triangles: np.ndarray,
    neighbours: np.ndarray,
    neighbour_edge: np.ndarray,
    unfolded: np.ndarray,
    angles: np.ndarray,
    deficit: np.ndarray,
    reach: float,
) -> np.ndarray:
    """Turns (m, 3, 2) in radians for lines that leave face f over edge k: at its start, and the fall to its end.

    ``angles`` (m, 3) radians of the faces at their corners, ``deficit`` (n,) the angle deficits of the vertices;
    ``reach`` is the longest edge in mm along which they are spread.

    A crossing at share t of the edge, from corner k, turns the line to the left by ``bend[0] - t * bend[1]``.
    """
    area, shortest = vertex_sizes(triangles, unfolded, len(deficit))
    smooth = smooth_part(triangles, deficit, area)
    out = np.zeros((len(triangles), 3, 2))
    for f in range(len(triangles)):
        r = unfolded[f]
        lengths = (r[0], math.hypot(r[1] - r[0], r[2]), math.hypot(r[1], r[2]))
        for k in range(3):
            g = neighbours[f, k]
            if g < 0 or lengths[k] > ROUNDING * reach:
                continue
            a, b = triangles[f, k], triangles[f, (k + 1) % 3]
            e = neighbour_edge[f, k]
            share_a = share_b = 0.0
            if lengths[k] <= LONG * ROUNDING * shortest[a] and smooth[a] != 0.0:
                beside = angles[f, k] + angles[g, (e + 1) % 3]
                share_a = smooth[a] * 0.5 * beside / (2.0 * math.pi - deficit[a])
            if lengths[k] <= LONG * ROUNDING * shortest[b] and smooth[b] != 0.0:
                beside = angles[f, (k + 1) % 3] + angles[g, e]
                share_b = smooth[b] * 0.5 * beside / (2.0 * math.pi - deficit[b])
            out[f, k, 0] = share_a
            out[f, k, 1] = share_a + share_b
    return out
