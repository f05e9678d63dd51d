"""How the sample parts are meshed: rows stitched together, plane regions filled, outlines sampled.

Every function is deterministic. A *row* is an open or closed line of vertices across a part; two rows may
have different numbers of vertices, so that facets stay near equilateral where a part narrows to a pole.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from numpy.typing import ArrayLike, NDArray

from geomdrap.errors import SurfaceError

Points = NDArray[np.float64]
Triangles = NDArray[np.int64]
Mesh = tuple[Points, Triangles]

ROW_STEP = 3.0 / np.pi  # row distance / edge at which ring i about a flat pole has exactly 6 i vertices


def require_positive(**values: float) -> None:
    """Raise a SurfaceError that names the first value which is not a positive finite number."""
    for name, value in values.items():
        if not (np.isfinite(value) and value > 0):
            raise SurfaceError(f"{name} must be a positive number, not {value}")


def segments(length: float, edge: float, at_least: int = 1) -> int:
    """Return the number of equal segments, each about ``edge`` long, that divide ``length``."""
    return max(at_least, round(length / edge))


def line(start: ArrayLike, end: ArrayLike, edge: float) -> Points:
    """Points (n, 2) from ``start`` to ``end``, both included, about ``edge`` apart."""
    a, b = np.asarray(start, float), np.asarray(end, float)
    t = np.linspace(0.0, 1.0, segments(float(np.linalg.norm(b - a)), edge) + 1)[:, None]
    return (1.0 - t) * a + t * b  # this form returns both ends exactly


def arc(centre: ArrayLike, radius: float, start: float, end: float, edge: float) -> Points:
    """Points (n, 2) on a circle from angle ``start`` to ``end`` [deg], both included.

    About ``edge`` apart, and never more than 30° apart.
    """
    turn = np.radians(abs(end - start))
    count = segments(float(radius * turn), edge, int(np.ceil(abs(end - start) / 30.0 - 1e-9)))
    angles = np.radians(np.linspace(start, end, count + 1))
    return np.asarray(centre, float) + radius * np.stack([np.cos(angles), np.sin(angles)], axis=1)


def chain(*pieces: Points) -> Points:
    """Join polylines end to end; the start of each piece replaces the end of the piece before."""
    return np.concatenate([*(piece[:-1] for piece in pieces[:-1]), pieces[-1]])


@dataclass(frozen=True)
class Row:
    """A line of vertices with the positions that say which vertices of two rows belong together.

    points: (n, 3) mm; position: (n,) increasing, in [0, 1) if closed. One vertex alone is a pole.
    """

    points: Points
    position: Points
    closed: bool = False

    def edge_middles(self) -> Points:
        """Positions (k,) of the middles of the row's edges: k = n if closed, else n − 1."""
        if len(self.points) == 1:
            return np.empty(0)
        following = np.append(self.position[1:], self.position[0] + 1.0)
        middles = 0.5 * (self.position + following)
        return np.round(middles % 1.0 if self.closed else middles[:-1], 9) % (1.0 if self.closed else np.inf)


def ring(points: Points, offset: float = 0.0) -> Row:
    """Make a closed row whose vertices are evenly placed, the first at ``offset`` steps."""
    return Row(points, (np.arange(len(points)) + offset) / len(points), closed=True)


def _band(lower: Row, upper: Row) -> Triangles:
    """Triangles between two rows, numbered from 0 in ``lower`` and then on in ``upper``.

    Each edge of either row carries one triangle, whose third corner is the vertex of the other row that
    the walk has reached; the walk takes the edges in the order of their middles.
    """
    middles_a, middles_b = lower.edge_middles(), upper.edge_middles()
    edges_a, edges_b = np.argsort(middles_a, kind="stable"), np.argsort(middles_b, kind="stable")
    order = np.argsort(np.concatenate([middles_a[edges_a], middles_b[edges_b]]), kind="stable")
    is_a = order < len(middles_a)
    n, m = len(lower.points), len(upper.points)
    first_a = edges_a[0] if len(edges_a) else 0
    first_b = edges_b[0] if len(edges_b) else 0
    at_a = first_a + np.cumsum(is_a) - is_a
    at_b = first_b + np.cumsum(~is_a) - ~is_a
    third = np.where(is_a, (at_a + 1) % n, n + (at_b + 1) % m)
    return np.stack([at_a % n, third, n + at_b % m], axis=1)


def stitch(rows: Sequence[Row]) -> Mesh:
    """Join successive rows by bands of triangles.

    Seen with the rows running to the right and following each other upward, facets are counter-clockwise.
    """
    starts = np.cumsum([0, *(len(row.points) for row in rows)])
    triangles = []
    for k, (lower, upper) in enumerate(pairwise(rows)):
        triangles.append(_band(lower, upper) + starts[k])  # rows follow each other in the numbering
    return np.concatenate([row.points for row in rows]), np.concatenate(triangles)


def grid_triangles(rows: int, columns: int, kept: NDArray[np.bool_] | None = None) -> Triangles:
    """Two triangles in each cell of a grid of vertices numbered row by row, diagonals alternating.

    Alternation keeps the mesh free of a preferred direction and symmetric about its middle lines when
    the numbers of cells are even. ``kept`` (rows − 1, columns − 1) leaves cells out where it is False.
    """
    i, j = np.meshgrid(np.arange(rows - 1), np.arange(columns - 1), indexing="ij")
    wanted = np.ones(i.shape, bool) if kept is None else kept
    i, j = i[wanted], j[wanted]
    a = i * columns + j
    b, c, d = a + 1, a + columns + 1, a + columns
    rising = ((i + j) % 2 == 0)[:, None]
    first = np.where(rising, np.stack([a, b, c], 1), np.stack([a, b, d], 1))
    second = np.where(rising, np.stack([a, c, d], 1), np.stack([b, c, d], 1))
    return np.stack([first, second], axis=1).reshape(-1, 3)


def inside(points: Points, loops: Sequence[Points]) -> NDArray[np.bool_]:
    """Which points (n, 2) lie inside an odd number of the closed polygons, each (k, 2)."""
    odd = np.zeros(len(points), bool)
    for loop in loops:
        for a, b in zip(loop, np.roll(loop, -1, axis=0), strict=True):
            if a[1] == b[1]:
                continue
            crosses = (points[:, 1] < a[1]) != (points[:, 1] < b[1])
            odd ^= crosses & (points[:, 0] < a[0] + (points[:, 1] - a[1]) * (b[0] - a[0]) / (b[1] - a[1]))
    return odd


def _lattice(loops: Sequence[Points], edge: float) -> Points:
    """Points of a hexagonal lattice inside the loops, not too near to them."""
    from scipy.spatial import cKDTree

    low, high = loops[0].min(axis=0), loops[0].max(axis=0)
    centre, half = 0.5 * (low + high), 0.5 * (high - low)
    rise = edge * np.sqrt(0.75)
    rows = np.arange(-int(half[1] / rise) - 1, int(half[1] / rise) + 2)
    columns = np.arange(-int(half[0] / edge) - 1, int(half[0] / edge) + 2)
    x = centre[0] + edge * (columns[None, :] + 0.5 * (rows[:, None] % 2))
    y = np.broadcast_to(centre[1] + rise * rows[:, None], x.shape)
    points = np.stack([x.ravel(), y.ravel()], axis=1)
    points = points[inside(points, loops)]
    fence = np.concatenate([p for loop in loops for p in (loop, 0.5 * (loop + np.roll(loop, -1, axis=0)))])
    return points[cKDTree(fence).query(points)[0] > 0.68 * edge]


def fill(outline: Points, holes: Sequence[Points], edge: float, rounds: int = 8) -> Mesh:
    """Mesh the plane region inside ``outline`` and outside ``holes`` with near-equilateral triangles.

    outline, holes: closed polygons (k, 2), their vertices about ``edge`` apart and kept as they are: they
    come first in the result, in order. Delaunay triangles of a hexagonal lattice, smoothed ``rounds`` times.
    Returns points (n, 2) and triangles (m, 3), counter-clockwise. An edge of an outline that is much longer
    than ``edge`` may be cut across.
    """
    from scipy.spatial import Delaunay

    loops = [outline, *holes]
    fixed = sum(len(loop) for loop in loops)
    points = np.concatenate([*loops, _lattice(loops, edge)])
    for _ in range(rounds):
        begin, neighbours = Delaunay(points).vertex_neighbor_vertices
        means = np.add.reduceat(points[neighbours], begin[:-1], axis=0) / np.diff(begin)[:, None]
        points[fixed:] = means[fixed:]
    triangles = Delaunay(points).simplices.astype(np.int64)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    (ux, uy), (vx, vy) = (b - a).T, (c - a).T
    twice_area = ux * vy - uy * vx
    triangles[twice_area < 0] = triangles[twice_area < 0][:, [0, 2, 1]]
    wanted = np.abs(twice_area) > 1e-6 * edge * edge  # Delaunay leaves flat ones along straight outlines
    doubtful = (triangles < fixed).all(axis=1)  # a corner inside the region puts the triangle there
    wanted[doubtful] &= inside(((a + b + c) / 3.0)[doubtful], loops)
    return points, triangles[wanted]


def join(*meshes: Mesh) -> Mesh:
    """Put meshes together, vertices in exactly the same place becoming one; empty triangles dropped."""
    starts = np.cumsum([0, *(len(points) for points, _ in meshes)])
    triangles = np.concatenate([t + s for (_, t), s in zip(meshes, starts[:-1], strict=True)])
    points = np.concatenate([p for p, _ in meshes]) + 0.0  # −0 and 0 are one place
    _, first, number = np.unique(points, axis=0, return_index=True, return_inverse=True)
    kept = np.sort(first)  # keep the order of first appearance
    triangles = np.searchsorted(kept, first)[number.ravel()][triangles]
    x, y, z = triangles.T
    return points[kept], triangles[(x != y) & (y != z) & (z != x)]
