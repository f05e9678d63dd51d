"""Shear and yarn directions at the nodes of a simulated ply."""

from __future__ import annotations

import numpy as np

from geomdrap.blind.terms import Array


def differences(grid: Array) -> tuple[Array, Array]:
    """Central differences of ``grid`` (n, n, k) along u and v, per side; NaN where a neighbour is missing."""
    along_u, along_v = np.full_like(grid, np.nan), np.full_like(grid, np.nan)
    along_u[1:-1] = 0.5 * (grid[2:] - grid[:-2])
    along_v[:, 1:-1] = 0.5 * (grid[:, 2:] - grid[:, :-2])
    return along_u, along_v


def angle_between(warp: Array, weft: Array) -> Array:
    """Shear γ [deg] = 90° − angle(warp, weft) of vectors (..., 3), positive where they close."""
    size = np.linalg.norm(warp, axis=-1) * np.linalg.norm(weft, axis=-1)
    return np.rad2deg(np.arcsin(np.clip(np.sum(warp * weft, axis=-1) / size, -1.0, 1.0)))


def node_shear(points: Array) -> Array:
    """Shear (n, n) deg of nodes (n, n, 3): the mean of the four corners there; NaN where one is missing."""
    total = np.zeros(points.shape[:2])
    along_u, along_v = np.full_like(points, np.nan), np.full_like(points, np.nan)
    along_u[:-1], along_v[:, :-1] = points[1:] - points[:-1], points[:, 1:] - points[:, :-1]
    before_u, before_v = np.full_like(points, np.nan), np.full_like(points, np.nan)
    before_u[1:], before_v[:, 1:] = along_u[:-1], along_v[:, :-1]
    for warp in (along_u, before_u):
        for weft in (along_v, before_v):
            total += angle_between(warp, weft)
    return 0.25 * total
