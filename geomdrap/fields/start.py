"""Facets on which nodes of the net lie: where the walks over the part begin."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geomdrap.geodesic.compiled import kernel

if TYPE_CHECKING:
    from geomdrap.fields.refine import Refined
    from geomdrap.fishnet import Net

FEW = 32  # pieces of a facet that are looked through one by one
NEAR = 8  # nearest pieces to look through for one of the facet that a node lies on


def starts(net: Net, mesh: Refined) -> tuple[np.ndarray, np.ndarray]:
    """Facets (n,) of ``mesh`` with nodes on them and the nodes' coordinates (n, 2) in cells, the seed's first."""
    i, j = np.nonzero(net.face >= 0)
    nearest_first = np.argsort(np.hypot(net.u[i], net.v[j]), kind="stable")
    i, j = i[nearest_first], j[nearest_first]
    points, faces, nodes = net.points[i, j], net.face[i, j].astype(np.int64), np.column_stack([i, j]).astype(float)
    if len(mesh.parent) == len(net.surface.triangles):
        return faces, nodes
    order = np.argsort(mesh.parent, kind="stable")
    begin = np.concatenate([[0], np.cumsum(np.bincount(mesh.parent, minlength=len(net.surface.triangles)))])
    found = nearest_piece(points, faces, order, begin, mesh.points, mesh.triangles)
    many = np.flatnonzero(found < 0)
    if len(many):
        found[many] = _among_many(points[many], faces[many], mesh)
    there = found >= 0
    return found[there], nodes[there]


@kernel
def nearest_piece(
    points: np.ndarray, faces: np.ndarray, order: np.ndarray, begin: np.ndarray, corners: np.ndarray,
    triangles: np.ndarray,
) -> np.ndarray:
    """For each point (n, 3) on a facet, its piece whose middle is nearest; -1 where there are more than ``FEW``.

    The pieces of facet f are ``order[begin[f] : begin[f + 1]]``.
    """
    out = np.full(len(points), -1)
    for n in range(len(points)):
        first, last = begin[faces[n]], begin[faces[n] + 1]
        if last - first > FEW:
            continue
        least = np.inf
        for k in range(first, last):
            away = 0.0
            for c in range(3):
                middle = 0.0
                for m in range(3):
                    middle += corners[triangles[order[k], m], c] / 3.0
                away += (middle - points[n, c]) ** 2
            if away < least:
                least, out[n] = away, order[k]
    return out


def _among_many(points: np.ndarray, faces: np.ndarray, mesh: Refined) -> np.ndarray:
    """The same with a tree; -1 where none of the nearest pieces is of the facet (another sheet of a thin wall)."""
    from scipy.spatial import cKDTree

    middle = mesh.points[mesh.triangles].mean(axis=1)
    near = cKDTree(middle).query(points, k=min(NEAR, len(middle)))[1].reshape(len(faces), -1)
    own = mesh.parent[near] == faces[:, None]
    return np.where(own.any(axis=1), np.take_along_axis(near, own.argmax(axis=1)[:, None], axis=1)[:, 0], -1)
