"""Which facets hang together in the flat fabric, and the corners that they have in common."""

from __future__ import annotations

import numpy as np

from geomdrap.fields.contour import is_open, surely_joined, walk_outlines
from geomdrap.fields.strip import BEYOND, BY_NET
from geomdrap.geodesic.compiled import kernel


@kernel
def find_joints(at: np.ndarray, kind: np.ndarray, neighbours: np.ndarray, neighbour_edge: np.ndarray) -> np.ndarray:
    """Edges ``3·facet + edge`` (n,) across which the fabric is whole, each once."""
    out = np.empty(3 * len(kind), np.int64)
    count = 0
    for f in range(len(kind)):
        for k in range(3):
            if kind[f] == 0 or f >= neighbours[f, k]:
                continue
            whole = surely_joined(kind, neighbours, f, k)
            if whole or not is_open(at, kind, neighbours, neighbour_edge, f, k):
                out[count] = 3 * f + k
                count += 1
    return out[:count]


def joints(
    at: np.ndarray, kind: np.ndarray, neighbours: np.ndarray, neighbour_edge: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Facets (n,) and edges (n,) across which the fabric is whole, each once."""
    edges = find_joints(at, kind, neighbours, neighbour_edge)
    return edges // 3, edges % 3


def groups(a: np.ndarray, b: np.ndarray, n: int) -> np.ndarray:
    """Number of the connected group of each of n nodes of a graph with edges from nodes a to b (k,)."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    return connected_components(coo_array((np.ones(len(a), np.int8), (a, b)), shape=(n, n)), directed=False)[1]


def with_common_corners(
    at: np.ndarray, kind: np.ndarray, triangles: np.ndarray, neighbours: np.ndarray, neighbour_edge: np.ndarray
) -> np.ndarray:
    """Coordinates ``at`` (m, 3, 2) with those of corners that are one in the fabric made equal: their mean.

    In the strip facets reached on two ways give a corner two places a little apart, within what ``is_open`` allows.
    """
    uneven = uneven_vertices(at, kind, triangles, neighbours, neighbour_edge)
    if not uneven.any():
        return at
    facets = np.flatnonzero(uneven[triangles].any(axis=1))
    number = np.full(len(kind), -1)
    number[facets] = np.arange(len(facets))
    f, k = joints(at, kind, neighbours, neighbour_edge)
    g, e = neighbours[f, k], neighbour_edge[f, k].astype(np.int64)
    among = (number[f] >= 0) & (number[g] >= 0)
    f, g, k, e = 3 * number[f[among]], 3 * number[g[among]], k[among], e[among]
    a, b = np.concatenate([f + k, f + (k + 1) % 3]), np.concatenate([g + (e + 1) % 3, g + e])
    corners = np.nan_to_num(at[facets].reshape(-1, 2))
    group = groups(a, b, len(corners))
    size = np.bincount(group)
    mean = np.column_stack([np.bincount(group, x) / size for x in corners.T])
    moved = (uneven[triangles[facets]] & (kind[facets] > 0)[:, None]).ravel()
    out = at.copy()
    out[facets] = np.where(moved[:, None], mean[group], at[facets].reshape(-1, 2)).reshape(-1, 3, 2)
    return out


@kernel
def uneven_vertices(
    at: np.ndarray, kind: np.ndarray, triangles: np.ndarray, neighbours: np.ndarray, neighbour_edge: np.ndarray
) -> np.ndarray:
    """Vertices (n,) whose coordinates differ across an edge over which the fabric is whole."""
    out = np.zeros(triangles.max() + 1, np.bool_)
    for f in range(len(kind)):
        for k in range(3):
            g = neighbours[f, k]
            if surely_joined(kind, neighbours, f, k):
                continue
            if kind[f] == 0 or g < f or is_open(at, kind, neighbours, neighbour_edge, f, k):
                continue
            for n in range(2):
                mine, its = (k + n) % 3, (neighbour_edge[f, k] + 1 - n) % 3
                if at[f, mine, 0] != at[g, its, 0] or at[f, mine, 1] != at[g, its, 1]:
                    out[triangles[f, mine]] = True
    return out


def on_outline(at: np.ndarray, kind: np.ndarray, neighbours: np.ndarray, neighbour_edge: np.ndarray) -> np.ndarray:
    """Facets (n,) that have an edge on the outline of the fabric."""
    return np.unique(walk_outlines(at, kind, neighbours, neighbour_edge)[0] // 3)
def cut_off(at: np.ndarray, kind: np.ndarray, neighbours: np.ndarray, neighbour_edge: np.ndarray) -> np.ndarray:
    """Facets (m,) of the strip that hang together with no facet of the net."""
    f, k = joints(at, kind, neighbours, neighbour_edge)
    piece = groups(f, neighbours[f, k], len(kind))
    held = np.zeros(len(kind), bool)
    held[piece[kind == BY_NET]] = True
    return (kind == BEYOND) & ~held[piece]


