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

    Seams are followed from their ends within the part: what is left after taking away loose ends runs from rim to
    rim and is no slit. Bare stretches and holes count as one place each.
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
    """Which edges (n,) of a graph, from nodes a to b, hang on a chain of them that is not ``held`` at both ends."""
    gone = np.zeros(len(a), bool)
    while True:
        degree = np.bincount(np.concatenate([a[~gone], b[~gone]]), minlength=len(held))
        ends = (degree == 1) & ~held
        more = ~gone & (ends[a] | ends[b])
        if not more.any():
            return gone
        gone |= more


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
