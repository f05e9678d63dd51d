"""Which face lies across which edge; components; vertices where several fans of faces touch."""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True)
def order_by(keys, order, n_keys):  # type: ignore[no-untyped-def]
    """Stable counting sort: the given order (n,) rearranged so that keys[order] (n,) rises; linear time."""
    start = np.zeros(n_keys + 1, np.int64)
    for i in range(len(keys)):
        start[keys[i] + 1] += 1
    for v in range(n_keys):
        start[v + 1] += start[v]
    result = np.empty_like(order)
    for i in order:
        result[start[keys[i]]] = i
        start[keys[i]] += 1
    return result


@njit(cache=True)
def sorted_edges(triangles, n_points):  # type: ignore[no-untyped-def]
    """Half-edges 3 f + k in the order of their two vertices, and where each edge's group starts.

    Returns order (3 m,) int32 and start (number of edges + 1,) int64. Half-edge k of face f runs from
    corner k to corner (k + 1) % 3. Two counting sorts: linear however many faces meet at a vertex.
    """
    m = len(triangles)
    low = np.empty(3 * m, np.int32)
    high = np.empty(3 * m, np.int32)
    for f in range(m):
        for k in range(3):
            i, j = triangles[f, k], triangles[f, (k + 1) % 3]
            low[3 * f + k] = min(i, j)
            high[3 * f + k] = max(i, j)
    order = order_by(high, np.arange(3 * m).astype(np.int32), n_points)
    order = order_by(low, order, n_points)
    start = np.empty(3 * m + 1, np.int64)
    n = 0
    for i in range(3 * m):
        if i == 0 or low[order[i]] != low[order[i - 1]] or high[order[i]] != high[order[i - 1]]:
            start[n] = i
            n += 1
    start[n] = 3 * m
    return order, start[: n + 1].copy()


@njit(cache=True)
def match_edges(order, start, m):  # type: ignore[no-untyped-def]
    """Neighbours across the edges that have exactly two faces.

    Returns neighbours (m, 3) int32 and neighbour_edge (m, 3) int8, both -1 at boundaries and at
    non-manifold edges; and the half-edges (h,) int64 at non-manifold edges, edge by edge.
    """
    neighbours = np.full((m, 3), -1, np.int32)
    neighbour_edge = np.full((m, 3), -1, np.int8)
    bad = np.empty(len(order), np.int64)
    n_bad = 0
    for e in range(len(start) - 1):
        size = start[e + 1] - start[e]
        if size == 2:
            a, b = order[start[e]], order[start[e] + 1]
            neighbours[a // 3, a % 3] = b // 3
            neighbours[b // 3, b % 3] = a // 3
            neighbour_edge[a // 3, a % 3] = b % 3
            neighbour_edge[b // 3, b % 3] = a % 3
        elif size > 2:
            for i in range(start[e], start[e + 1]):
                bad[n_bad] = order[i]
                n_bad += 1
    return neighbours, neighbour_edge, bad[:n_bad].copy()


@njit(cache=True)
def label_components(order, start, m):  # type: ignore[no-untyped-def]
    """Labels (m,) int32 of the pieces that hang together by edges (even non-manifold), and their number."""
    parent = np.arange(m)
    for e in range(len(start) - 1):
        a = _root(parent, order[start[e]] // 3)
        for i in range(start[e] + 1, start[e + 1]):
            b = _root(parent, order[i] // 3)
            # the smaller number becomes the root, so that labels follow the order of the faces
            if a < b:
                parent[b] = a
            elif b < a:
                parent[a] = b
                a = b
    label = np.full(m, -1, np.int32)
    n = 0
    for f in range(m):
        root = _root(parent, f)
        if label[root] < 0:
            label[root] = n
            n += 1
        label[f] = label[root]
    return label, n


@njit(cache=True)
def _root(parent, i):  # type: ignore[no-untyped-def]
    while parent[i] != i:
        parent[i] = parent[parent[i]]
        i = parent[i]
    return i


@njit(cache=True)
def split_fans(triangles, neighbours, neighbour_edge, n_points):  # type: ignore[no-untyped-def]
    """Give each fan of faces round a vertex a vertex of its own.

    Changes triangles (m, 3) in place. Returns (n_new,) int64: for each new vertex n_points, n_points + 1, …
    the vertex that it copies. Faces must be oriented consistently.
    """
    m = len(triangles)
    seen = np.zeros((m, 3), np.bool_)
    taken = np.zeros(n_points, np.bool_)
    copied = np.empty(3 * m, np.int64)
    n_new = 0
    for f in range(m):
        for k in range(3):
            if seen[f, k]:
                continue
            old = triangles[f, k]
            name = old
            if taken[old]:
                name = n_points + n_new
                copied[n_new] = old
                n_new += 1
            taken[old] = True
            for turn in range(2):  # counter-clockwise round the vertex, then clockwise from a boundary
                g, c = f, k
                while True:
                    seen[g, c] = True
                    triangles[g, c] = name
                    edge = (c + 2) % 3 if turn == 0 else c
                    across = neighbours[g, edge]
                    if across < 0:
                        break
                    slot = np.int64(neighbour_edge[g, edge])
                    g, c = across, (slot if turn == 0 else (slot + 1) % 3)
                    if seen[g, c]:
                        break
    return copied[:n_new].copy()


@njit(cache=True)
def repeated_faces(triangles, n_points):  # type: ignore[no-untyped-def]
    """For each face the first face with the same three vertices in any order: (m,) int64."""
    m = len(triangles)
    corners = np.empty((3, m), np.int32)
    for f in range(m):
        a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
        corners[0, f] = min(a, b, c)
        corners[2, f] = max(a, b, c)
        corners[1, f] = a + b + c - corners[0, f] - corners[2, f]
    order = np.arange(m).astype(np.int32)
    for i in range(2, -1, -1):
        order = order_by(corners[i], order, n_points)
    first = np.arange(m)
    for i in range(1, m):
        f, g = order[i], order[i - 1]
        same = corners[0, f] == corners[0, g] and corners[1, f] == corners[1, g]
        if same and corners[2, f] == corners[2, g]:
            first[f] = first[g]
    return first


@njit(cache=True)
def boundary_walk(triangles, neighbours, n_points):  # type: ignore[no-untyped-def]
    """Closed loops of boundary edges, one after the other, in the direction of their faces' edges.

    Returns half-edges (b,) int64 as 3 f + k and where each loop starts (loops + 1,) int64. Each vertex
    must carry one fan of faces at most (split_fans).
    """
    out = np.full(n_points, -1, np.int64)
    for f in range(len(triangles)):
        for k in range(3):
            if neighbours[f, k] < 0:
                out[triangles[f, k]] = 3 * f + k
    walk = np.empty(n_points, np.int64)
    start = np.empty(n_points + 1, np.int64)
    n = 0
    loops = 0
    for v in range(n_points):
        if out[v] < 0:
            continue
        start[loops] = n
        loops += 1
        w = v
        while out[w] >= 0:
            edge = out[w]
            walk[n] = edge
            n += 1
            out[w] = -1
            w = triangles[edge // 3, (edge % 3 + 1) % 3]
    start[loops] = n
    return walk[:n].copy(), start[: loops + 1].copy()
