"""Shear angles of cells and nodes; positive where the +u and +v directions close."""

from __future__ import annotations

import math

import numpy as np

from geomdrap.geodesic.compiled import kernel


@kernel
def shear_of_cells(points: np.ndarray, u: np.ndarray, v: np.ndarray, valid: np.ndarray) -> np.ndarray:
    """Signed shear (nu - 1, nv - 1) in degrees of the cells from their diagonals; NaN where not valid."""
    out = np.full(valid.shape, np.nan)
    for i in range(valid.shape[0]):
        a = u[i + 1] - u[i]
        for j in range(valid.shape[1]):
            if valid[i, j]:
                b = v[j + 1] - v[j]
                long2 = short2 = 0.0
                for k in range(3):
                    long2 += (points[i + 1, j + 1, k] - points[i, j, k]) ** 2
                    short2 += (points[i + 1, j, k] - points[i, j + 1, k]) ** 2
                sine = (long2 - short2) / (long2 + short2) * (a * a + b * b) / (2.0 * a * b)
                out[i, j] = math.degrees(math.asin(min(max(sine, -1.0), 1.0)))
    return out


@kernel
def corner_shear(points: np.ndarray, i: int, j: int, su: int, sv: int) -> float:
    """Shear in degrees of the corner at node (i, j) between its pieces toward i + su and j + sv."""
    dot = uu = vv = 0.0
    for k in range(3):
        a = points[i + su, j, k] - points[i, j, k]
        b = points[i, j + sv, k] - points[i, j, k]
        dot += a * b
        uu += a * a
        vv += b * b
    return su * sv * math.degrees(math.asin(min(max(dot / math.sqrt(uu * vv), -1.0), 1.0)))


@kernel
def shear_at_nodes(points: np.ndarray, valid: np.ndarray) -> np.ndarray:
    """Signed shear (nu, nv) in degrees: mean over the corners of the valid cells at each node, NaN without one."""
    nu, nv = points.shape[:2]
    total = np.zeros((nu, nv))
    count = np.zeros((nu, nv), np.int8)
    for i in range(nu - 1):
        for j in range(nv - 1):
            if valid[i, j]:
                for di in range(2):
                    for dj in range(2):
                        total[i + di, j + dj] += corner_shear(points, i + di, j + dj, 1 - 2 * di, 1 - 2 * dj)
                        count[i + di, j + dj] += 1
    return np.where(count > 0, total / np.maximum(count, 1), np.nan)
