"""Splitting large facets, so that fields over the part are resolved to the pitch."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Refined:
    """Facets no longer than asked for: points (n, 3) mm, triangles (m, 3), parent (m,) facet of the part."""

    points: np.ndarray
    triangles: np.ndarray
    parent: np.ndarray
    neighbours: np.ndarray
    neighbour_edge: np.ndarray


def refine(
    points: np.ndarray,
    triangles: np.ndarray,
    neighbours: np.ndarray,
    neighbour_edge: np.ndarray,
    longest: float,
) -> Refined:
    """Split every edge longer than ``longest`` mm at its middle, until none is left.

    Both facets of an edge split it at the same point, so no gap opens; a facet becomes 2, 3 or 4, in its own plane.
    """
    parent = np.arange(len(triangles))
    done: list[tuple[np.ndarray, np.ndarray]] = []  # facets without a long edge: none of their neighbours splits one
    rest, owners = triangles, parent
    while True:
        long = _longer(points, rest, longest)
        to_split = long.any(axis=1)
        if not to_split.any():
            break
        done.append((rest[~to_split], owners[~to_split]))
        rest, owners, long = rest[to_split], owners[to_split], long[to_split]
        edges = np.sort(np.stack([rest, np.roll(rest, -1, axis=1)], axis=2), axis=2)
        points, rest, owners = _split(points, rest, owners, edges, long)
    if not done:
        return Refined(points, triangles, parent, neighbours, neighbour_edge)
    from geomdrap.surface.topology import match_edges, sorted_edges

    parent = np.concatenate([*(p for _, p in done), owners])
    triangles = np.ascontiguousarray(np.concatenate([*(t for t, _ in done), rest]).astype(np.int32))
    order, start = sorted_edges(triangles, len(points))
    beside, beside_edge, _ = match_edges(order, start, len(triangles))
    return Refined(points, triangles, parent, beside, beside_edge)


def _longer(points: np.ndarray, triangles: np.ndarray, length: float) -> np.ndarray:
    """Which edges (m, 3) of the facets are longer than ``length`` mm."""
    square = np.zeros(triangles.shape)
    for x in points.T:
        corners = x[triangles]
        square += (corners - corners[:, [1, 2, 0]]) ** 2
    return square > length * length


def _split(
    points: np.ndarray, triangles: np.ndarray, parent: np.ndarray, edges: np.ndarray, long: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """One round: a new vertex on each long edge, and the facets cut by the one to three that they have."""
    key = edges[..., 0].astype(np.int64) * len(points) + edges[..., 1]
    unique, inverse = np.unique(key[long], return_inverse=True)
    middle = np.full(triangles.shape, -1, np.int64)
    middle[long] = len(points) + inverse
    added = 0.5 * (points[unique // len(points)] + points[unique % len(points)])
    count = long.sum(axis=1)
    pieces, owners = [triangles[count == 0]], [parent[count == 0]]
    for n, cut in ((1, _one), (2, _two), (3, _three)):
        rows = np.flatnonzero(count == n)
        first = np.argmax(long[rows], axis=1) if n == 1 else np.argmin(long[rows], axis=1)
        turn = (first[:, None] + np.arange(3)) % 3
        corners, middles = (np.take_along_axis(a[rows], turn, axis=1) for a in (triangles, middle))
        made = cut(corners, middles)
        pieces.append(made.reshape(-1, 3))
        owners.append(np.repeat(parent[rows], made.shape[1]))
    return np.vstack([points, added]), np.vstack(pieces), np.concatenate(owners)


def _one(c: np.ndarray, m: np.ndarray) -> np.ndarray:
    """Cut from the middle of edge 0 to the opposite corner."""
    a, b, o, x = *c.T, m[:, 0]
    return np.stack([np.stack([a, x, o], 1), np.stack([x, b, o], 1)], 1)


def _two(c: np.ndarray, m: np.ndarray) -> np.ndarray:
    """Cut the corner between the middles of edges 1 and 2; edge 0 stays whole."""
    a, b, o, x, y = *c.T, m[:, 1], m[:, 2]
    return np.stack([np.stack([a, b, x], 1), np.stack([a, x, y], 1), np.stack([x, o, y], 1)], 1)


def _three(c: np.ndarray, m: np.ndarray) -> np.ndarray:
    """Cut all three corners."""
    a, b, o = c.T
    x, y, z = m.T
    return np.stack(
        [np.stack([a, x, z], 1), np.stack([x, b, y], 1), np.stack([y, o, z], 1), np.stack([x, y, z], 1)], 1
    )
