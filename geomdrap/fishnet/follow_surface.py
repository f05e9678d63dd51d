"""The nearest place of the part, looked for from the last one: for nodes that move a little, many times.

From the facet where a node stood the distance goes downhill, over edges and round vertices, until no facet beside is
nearer. That is the nearest place of all unless the part folds back within the step, and there the near one is meant.

Source: the nearest point of a triangle after C. Ericson, Real-Time Collision Detection (2005), section 5.1.5.
"""

from __future__ import annotations

import numpy as np

from geomdrap.geodesic.compiled import kernel, tight

VERTEX, INSIDE = 3, 6  # what of a facet is nearest: 0 to 2 an edge, from 3 on a vertex, or its inside

Reached = tuple[float, float, float, float, int]


@kernel
def nearest_from(
    points: np.ndarray,
    triangles: np.ndarray,
    neighbours: np.ndarray,
    slots: np.ndarray,
    goal: np.ndarray,
    face: np.ndarray,
) -> tuple[np.ndarray, np.ndarray]:
    """Nearest places (n, 3) to goals (n, 3) downhill from faces (n,), and the faces (n,) that they lie on."""
    place, found = np.empty_like(goal), np.empty(len(goal), np.int64)
    for n in range(len(goal)):
        gx, gy, gz = goal[n]
        f = np.int64(face[n])
        best = reach(points, triangles, f, gx, gy, gz)
        while best[4] != INSIDE:
            start, feature = f, best[4]
            if feature < VERTEX:
                g = np.int64(neighbours[start, feature])
                if g >= 0:
                    there = reach(points, triangles, g, gx, gy, gz)
                    if there[0] < best[0]:
                        best, f = there, g
            else:
                for turn in range(2):  # counter-clockwise round the vertex; from a rim on, clockwise
                    g, corner = start, feature - VERTEX
                    while True:
                        edge = (corner + 2) % 3 if turn == 0 else corner
                        slot = np.int64(slots[g, edge])
                        g = np.int64(neighbours[g, edge])
                        if g < 0 or g == start:
                            break
                        corner = slot if turn == 0 else (slot + 1) % 3
                        there = reach(points, triangles, g, gx, gy, gz)
                        if there[0] < best[0]:
                            best, f = there, g
                    if g == start:
                        break
            if f == start:
                break
        place[n, 0], place[n, 1], place[n, 2] = best[1], best[2], best[3]
        found[n] = f
    return place, found


@tight
def reach(points: np.ndarray, triangles: np.ndarray, f: int, gx: float, gy: float, gz: float) -> Reached:
    """Squared distance from a goal to a face, the place of the face that is nearest, and what of the face it is."""
    a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
    ax, ay, az = points[a, 0], points[a, 1], points[a, 2]
    ux, uy, uz = points[b, 0] - ax, points[b, 1] - ay, points[b, 2] - az
    vx, vy, vz = points[c, 0] - ax, points[c, 1] - ay, points[c, 2] - az
    px, py, pz = gx - ax, gy - ay, gz - az
    uu, uv, vv = ux * ux + uy * uy + uz * uz, ux * vx + uy * vy + uz * vz, vx * vx + vy * vy + vz * vz
    pu, pv = px * ux + py * uy + pz * uz, px * vx + py * vy + pz * vz
    along_b, across_b = pu - uu, pv - uv
    along_c, across_c = pu - uv, pv - vv
    over_c = pu * across_b - along_b * pv  # of edge a-b, by the vertex that is not on it
    over_b = along_c * pv - pu * across_c
    over_a = along_b * across_c - along_c * across_b
    s, t, feature = 0.0, 0.0, VERTEX
    if pu <= 0.0 and pv <= 0.0:
        pass
    elif along_b >= 0.0 and across_b <= along_b:
        s, feature = 1.0, VERTEX + 1
    elif across_c >= 0.0 and along_c <= across_c:
        t, feature = 1.0, VERTEX + 2
    elif over_c <= 0.0 and pu >= 0.0 and along_b <= 0.0:
        s, feature = pu / (pu - along_b), 0
    elif over_b <= 0.0 and pv >= 0.0 and across_c <= 0.0:
        t, feature = pv / (pv - across_c), 2
    elif over_a <= 0.0 and across_b >= along_b and along_c >= across_c:
        t = (across_b - along_b) / ((across_b - along_b) + (along_c - across_c))
        s, feature = 1.0 - t, 1
    else:
        whole = over_a + over_b + over_c
        s, t, feature = over_b / whole, over_c / whole, INSIDE
    x, y, z = ax + s * ux + t * vx, ay + s * uy + t * vy, az + s * uz + t * vz
    return (gx - x) ** 2 + (gy - y) ** 2 + (gz - z) ** 2, x, y, z, feature
