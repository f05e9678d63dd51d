"""The nearest point of a surface, exact at any scale."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from geomdrap.surface.types import Floats, Ints
from geomdrap.surface.weld import edge_lengths_squared


@dataclass(frozen=True)
class Nearest:
    """Nearest points of a surface: face (k,) int64, point (k, 3) mm, distance (k,) mm.

    A query that is not finite has face -1 and NaN.
    """

    face: Ints
    point: Floats
    distance: Floats


class NearestTree:
    """Tree of boxes over the triangles.

    The tree works on coordinates shifted to the centre and divided by the diagonal: libraries compare
    squared distances with absolute tolerances, which is wrong for parts in metres or far from the origin.
    """

    def __init__(self, points: Floats, triangles: Ints) -> None:
        import igl

        low, high = points.min(axis=0), points.max(axis=0)
        self.center = 0.5 * (low + high)
        self.scale = float(np.linalg.norm(high - low))
        self.points = np.ascontiguousarray((points - self.center) / self.scale)
        self.triangles = np.ascontiguousarray(triangles, dtype=np.int64)
        self.tree: Any = igl.AABB()
        self.tree.init(self.points, self.triangles)

    def query(self, points: Floats) -> Nearest:
        """Nearest points to points (k, 3)."""
        queries = np.ascontiguousarray(np.atleast_2d(points), dtype=np.float64)
        good = np.isfinite(queries).all(axis=1)
        face = np.full(len(queries), -1, np.int64)
        point = np.full((len(queries), 3), np.nan)
        if good.any():
            local = (queries[good] - self.center) / self.scale
            _, found, at = self.tree.squared_distance(self.points, self.triangles, local)
            face[good] = found.ravel()
            point[good] = at * self.scale + self.center
        return Nearest(face, point, np.linalg.norm(point - queries, axis=1))


def nearest_to_one(points: Floats, triangles: Ints, query: Floats) -> Nearest:
    """The nearest point to one query (1, 3), by a tree of the faces about it only: a whole one takes far longer.

    The nearest face has a corner that is further off than the nearest vertex by no more than its longest edge.
    """
    distance = np.linalg.norm(points - query, axis=1)
    longest = float(np.sqrt(edge_lengths_squared(points, triangles).max()))
    near = distance <= distance.min() + longest  # none where the query is not finite
    some = np.flatnonzero(near[triangles].any(axis=1))
    found = NearestTree(points, triangles[some]).query(query)
    return Nearest(some[found.face], found.point, found.distance) if len(some) else found
