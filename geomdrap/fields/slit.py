"""Slits: seams of the fabric that an open part does not ask for, left bare because they need a dart.

Where the net meets itself, facets on both sides of a seam are draped with fabric from different places. A tube or a
closed part cannot be covered otherwise. A seam that ends within the part can: it begins where yarns met in a fold,
and a ply could only be laid there with a dart. The strip beyond the net would fill it and hide that.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geomdrap.fields.contour import is_open, surely_joined
from geomdrap.fields.joints import groups
from geomdrap.fields.strip import BEYOND, BEYOND_NET
from geomdrap.fishnet import Status
from geomdrap.geodesic.compiled import kernel

if TYPE_CHECKING:
    from geomdrap.fields.refine import Refined
    from geomdrap.surface import Surface

APART = 1.0  # cells: a seam whose sides lie nowhere further apart is a tear within the strip, not a slit
STOPPED = [Status.FOLDED, Status.BEHIND_FOLD, Status.MEETS_ITSELF, Status.NOT_CLOSED]


@kernel
def seams(at: np.ndarray, kind: np.ndarray, neighbours: np.ndarray, neighbour_edge: np.ndarray) -> np.ndarray:
    """Edges ``3·facet + edge`` (n,) between two draped facets that do not join in the fabric, each once."""
    found = np.empty(3 * len(kind), np.int64)
    count = 0
    for f in range(len(kind)):
        for k in range(3):
            g = neighbours[f, k]
            if surely_joined(kind, neighbours, f, k):
                continue
            if g > f and kind[f] > 0 and kind[g] > 0 and is_open(at, kind, neighbours, neighbour_edge, f, k):
                found[count] = 3 * f + k
                count += 1
    return found[:count]


def slits(
    at: np.ndarray, kind: np.ndarray, mesh: Refined, part: Surface, status: np.ndarray, pitch: float
) -> np.ndarray:
    """Facets (m,) of the strip within a slit; ``at`` (m, 3, 2) cells, ``status`` (nu + 2, nv + 2) of the nodes.

    Seams that run from rim to rim, or round a patch, are no slits; those that end within the part are. Bare stretches
    and holes count as one place each.
    """
    edges = seams(at, kind, mesh.neighbours, mesh.neighbour_edge)
    if not len(edges) or not part.lidded.boundary_loops:
        return np.zeros(len(kind), bool)
    rim = np.concatenate(part.lidded.boundary_loops)
    place, at_rim = _places(kind, mesh, part.lidded.triangles[rim // 3, rim % 3])
    a, b = (place[mesh.triangles[edges // 3, (edges % 3 + n) % 3]] for n in (0, 1))
    in_slit = loose(a, b, at_rim) & chains_with(_apart(edges, at, mesh, status), a, b, len(at_rim))
    return _within_reach(edges[in_slit], kind, mesh, pitch)


def _apart(edges: np.ndarray, at: np.ndarray, mesh: Refined, status: np.ndarray) -> np.ndarray:
    """Whether the two sides of seam edges (n,) lie a cell apart in the fabric, where the net had to stop."""
    f, k = edges // 3, edges % 3
    g, e = mesh.neighbours[f, k], mesh.neighbour_edge[f, k]
    mine = np.stack([at[f, (k + n) % 3] for n in (0, 1)])
    its = np.stack([at[g, (e + 1 - n) % 3] for n in (0, 1)])
    i, j = np.floor(np.stack([mine.mean(axis=0), its.mean(axis=0)])).astype(int).transpose(2, 0, 1)
    around = [
        np.isin(status[np.clip(i + k, 0, status.shape[0] - 1), np.clip(j + m, 0, status.shape[1] - 1)], STOPPED)
        for k in (1, 2)
        for m in (1, 2)
    ]
    return (np.linalg.norm(mine - its, axis=2).max(axis=0) > APART) & np.any(around, axis=(0, 1))


def chains_with(chosen: np.ndarray, a: np.ndarray, b: np.ndarray, nodes: int) -> np.ndarray:
    """Which edges (n,) of a graph, from nodes a to b, hang together with a ``chosen`` one."""
    chain = groups(a, b, nodes)
    return np.isin(chain[a], chain[a[chosen]])


def loose(a: np.ndarray, b: np.ndarray, held: np.ndarray) -> np.ndarray:
    """Which edges (n,) of a graph, from nodes a to b, lie on no way between two ``held`` nodes and on no loop.

    With all held nodes made one those are its bridges.
    """
    node = np.where(held, 0, np.arange(1, len(held) + 1))
    return bridges(node[a], node[b], len(held) + 1)


@kernel
def bridges(a: np.ndarray, b: np.ndarray, nodes: int) -> np.ndarray:
    """Edges (n,) without which the ends a and b (n,) would not hang together (R. E. Tarjan, 1974)."""
    first = np.zeros(nodes + 1, np.int64)  # of each node's edges in ``way``
    for n in range(len(a)):
        first[a[n] + 1] += 1
        first[b[n] + 1] += 1
    first = np.cumsum(first)
    way, free = np.empty(2 * len(a), np.int64), first[:-1].copy()
    for n in range(len(a)):
        for x in (a[n], b[n]):
            way[free[x]] = n
            free[x] += 1
    out = np.zeros(len(a), np.bool_)
    rank, low, came = np.zeros(nodes, np.int64), np.zeros(nodes, np.int64), np.full(nodes, -1)
    at, stack, count = first[:-1].copy(), np.empty(nodes, np.int64), 0
    for root in a:
        if rank[root] > 0:
            continue
        depth, stack[0] = 1, root
        count += 1
        rank[root] = low[root] = count
        while depth > 0:
            x = stack[depth - 1]
            if at[x] < first[x + 1]:
                n = way[at[x]]
                at[x] += 1
                y = a[n] + b[n] - x
                if n == came[x]:
                    continue
                if rank[y] > 0:
                    low[x] = min(low[x], rank[y])
                    continue
                count += 1
                rank[y] = low[y] = count
                came[y] = n
                stack[depth] = y
                depth += 1
                continue
            depth -= 1
            if came[x] >= 0:
                y = a[came[x]] + b[came[x]] - x
                low[y] = min(low[y], low[x])
                out[came[x]] = low[x] == rank[x]
    return out


def _places(kind: np.ndarray, mesh: Refined, rim: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Number of the place of each vertex (n,), and which places (n,) belong to the rim of the part.

    The vertices of a bare stretch are one place, and so are those of a boundary loop.
    """
    bare = mesh.triangles[kind == 0]
    f, k = np.nonzero(mesh.neighbours < 0)
    a = np.concatenate([bare[:, 0], bare[:, 1], mesh.triangles[f, k]])
    b = np.concatenate([bare[:, 1], bare[:, 2], mesh.triangles[f, (k + 1) % 3]])
    n = len(mesh.points)
    place = groups(a, b, n)
    at_rim = np.zeros(n, bool)
    at_rim[place[rim]] = True
    return place, at_rim


def _within_reach(edges: np.ndarray, kind: np.ndarray, mesh: Refined, pitch: float) -> np.ndarray:
    """Facets (m,) of the strip that hang together with those at the edges and lie within its width of them."""
    from scipy.spatial import cKDTree

    inside = np.zeros(len(kind), bool)
    if not len(edges):
        return inside
    f, k = edges // 3, edges % 3
    tree = cKDTree(0.5 * (mesh.points[mesh.triangles[f, k]] + mesh.points[mesh.triangles[f, (k + 1) % 3]]))
    strip = np.flatnonzero(kind == BEYOND)
    away = tree.query(mesh.points[mesh.triangles[strip]].mean(axis=1), distance_upper_bound=BEYOND_NET * pitch)[0]
    near = np.zeros(len(kind), bool)
    near[strip[np.isfinite(away)]] = True
    front = np.unique(np.concatenate([f, mesh.neighbours[f, k]]))
    front = front[near[front]]
    while len(front):
        inside[front] = True
        beside = np.unique(mesh.neighbours[front])
        beside = beside[beside >= 0]
        front = beside[near[beside] & ~inside[beside]]
    return inside
