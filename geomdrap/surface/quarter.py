"""Facets split in four at the middles of their edges."""

from __future__ import annotations

import numpy as np


def quartered(triangles: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Edges (e, 2) of facets (m, 3), the edge (m, 3) of each side, and the facets (4m, 3) that its middles make.

    ``count`` is the number of vertices: the middle of edge k becomes vertex count + k. Side k of a facet runs from
    its corner k to the next; the four parts of facet n are 4n to 4n + 3, the middle one last, all turned as it is.
    """
    sides = np.stack([triangles, np.roll(triangles, -1, axis=1)], axis=2)
    edges, number = np.unique(np.sort(sides.reshape(-1, 2), axis=1), axis=0, return_inverse=True)
    side = number.reshape(-1, 3)
    a, b, c = triangles.T
    ab, bc, ca = (count + side).T
    split = np.stack([a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca], axis=1).reshape(-1, 3)
    return edges, side, split
