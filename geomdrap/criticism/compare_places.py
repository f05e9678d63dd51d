"""Where on the part the compared points lie: shear, distance from the origin, curvature, distance from the rim."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.measurement.rim import distance_to_rim

if TYPE_CHECKING:
    from geomdrap.fishnet import Net
    from geomdrap.measurement.match import Matched
    from geomdrap.surface import Surface


@dataclass(frozen=True, eq=False)
class Places:
    """All (n,), NaN where there is no prediction.

    ``shear``: size of the predicted shear, degrees. ``distance``: from the origin in the flat fabric, mm.
    ``curvature``: principal curvature of the part that is larger in size, 1/m, positive where the part bulges towards
    its normal, negative in hollows. ``rim``: straight distance from the part's boundary, mm, infinite without one.
    """

    shear: np.ndarray
    distance: np.ndarray
    curvature: np.ndarray
    rim: np.ndarray


def places_of(net: Net, matched: Matched) -> Places:
    """Where the predicted points of a net lie."""
    known = np.where(matched.used, 1.0, np.nan)
    face = net.surface.nearest(matched.point).face
    curvature = 1000.0 * vertex_curvature(net.surface)[net.surface.triangles[face]].mean(axis=1)
    return Places(
        shear=np.abs(matched.shear),
        distance=np.hypot(matched.u, matched.v) * known,
        curvature=curvature * known,
        rim=distance_to_rim(net.surface, matched.point),
    )


def vertex_curvature(surface: Surface) -> np.ndarray:
    """Principal curvature of larger size at the vertices (n,) 1/mm, positive where the part bulges to its normal.

    Mean over the faces about a vertex by area of what their vertex normals say (S. Rusinkiewicz, Estimating
    curvatures and their derivatives on triangle meshes, 2004, section 2).
    """
    first, mixed, second = _second_forms(surface)
    middle, deviation = 0.5 * (first + second), np.hypot(0.5 * (first - second), mixed)
    larger = np.where(middle >= 0.0, middle + deviation, middle - deviation)
    corners = surface.triangles.ravel()
    weight = np.bincount(corners, np.repeat(surface.areas, 3), len(surface.points))
    total = np.bincount(corners, np.repeat(surface.areas * larger, 3), len(surface.points))
    return total / np.where(weight > 0.0, weight, 1.0)


def _second_forms(surface: Surface) -> np.ndarray:
    """Second fundamental forms of the faces (3, m): e1·e1, e1·e2, e2·e2, least squares over the three edges."""
    corners, normals = surface.points[surface.triangles], surface.vertex_normals[surface.triangles]
    rows, right = [], []
    for k in range(3):
        edge, turn = corners[:, (k + 1) % 3] - corners[:, k], normals[:, (k + 1) % 3] - normals[:, k]
        x, y = (np.einsum("ij,ij->i", edge, e) for e in (surface.e1, surface.e2))
        zero = np.zeros_like(x)
        rows += [np.stack([x, y, zero], axis=1), np.stack([zero, x, y], axis=1)]
        right += [np.einsum("ij,ij->i", turn, e) for e in (surface.e1, surface.e2)]
    matrix, values = np.stack(rows, axis=1), np.stack(right, axis=1)
    gram = np.einsum("mki,mkj->mij", matrix, matrix)
    size = np.trace(gram, axis1=1, axis2=2)[:, None, None]
    solved = np.linalg.solve(gram + 1e-12 * size * np.eye(3), np.einsum("mki,mk->mi", matrix, values)[..., None])
    return np.asarray(solved[..., 0].T)
