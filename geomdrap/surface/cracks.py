"""Cracks: boundary vertices that lie on the middle of another face's boundary edge (T-junctions)."""

from __future__ import annotations

import numpy as np
from numba import njit

from geomdrap.surface.prepare import Prepared
from geomdrap.surface.types import Floats

#: a vertex this near to an edge, as a share of its length, is on it: patches meet within their chord errors
NEAR = 0.01
#: pairs of edge and vertex looked at before the search is given up (a pile of loose triangles)
MOST_PAIRS = 50_000_000


def find_cracks(mesh: Prepared) -> Floats:
    """Places (k, 3) mm of the boundary vertices on the middle of a boundary edge, each vertex once."""
    face, k = np.nonzero(mesh.neighbours < 0)
    if len(face) == 0:
        return np.empty((0, 3))
    start, end = mesh.triangles[face, k], mesh.triangles[face, (k + 1) % 3]
    vertices = np.unique(start)
    places = mesh.points[vertices]
    axis = int(np.argmax(np.ptp(places, axis=0)))
    places = places[np.argsort(places[:, axis], kind="stable")]
    begin, finish = mesh.points[start], mesh.points[end]
    reach = NEAR * np.linalg.norm(finish - begin, axis=1)
    low = np.minimum(begin[:, axis], finish[:, axis]) - reach
    high = np.maximum(begin[:, axis], finish[:, axis]) + reach
    first, last = np.searchsorted(places[:, axis], low), np.searchsorted(places[:, axis], high)
    hit = vertices_on_edges(places, begin, finish, first, last, reach)
    return np.unique(places[hit], axis=0)


@njit(cache=True)
def vertices_on_edges(  # type: ignore[no-untyped-def]
    places, starts, ends, first, last, reach
):
    """Which of the places (n, 3) lie within reach (e,) of the inner part of an edge: (n,) bool.

    For each edge only the places from first (e,) to last (e,), near it along one axis, are looked at.
    """
    hit = np.zeros(len(places), np.bool_)
    pairs = 0
    for e in range(len(starts)):
        pairs += last[e] - first[e]
        if pairs > MOST_PAIRS:
            return hit
        ux, uy, uz = ends[e, 0] - starts[e, 0], ends[e, 1] - starts[e, 1], ends[e, 2] - starts[e, 2]
        squared = ux * ux + uy * uy + uz * uz
        for i in range(first[e], last[e]):
            x, y, z = places[i, 0] - starts[e, 0], places[i, 1] - starts[e, 1], places[i, 2] - starts[e, 2]
            t = (x * ux + y * uy + z * uz) / squared
            if NEAR < t < 1.0 - NEAR:
                x, y, z = x - t * ux, y - t * uy, z - t * uz
                if x * x + y * y + z * z <= reach[e] * reach[e]:
                    hit[i] = True
    return hit
