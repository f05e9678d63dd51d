"""How far places on a part are from its rim."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from geomdrap.surface import Surface

CHUNK = 2_000_000  # pairs of points and edges at a time


def distance_to_rim(surface: Surface, points: np.ndarray) -> np.ndarray:
    """Straight distance in mm (n,) of points (n, 3) from the boundary edges; infinite where there are none."""
    loops = surface.boundary_loops
    if not loops:
        return np.where(np.isfinite(points).all(axis=1), np.inf, np.nan)
    edges = np.concatenate(loops)
    face, k = edges // 3, edges % 3
    start = surface.points[surface.triangles[face, k]]
    along = surface.points[surface.triangles[face, (k + 1) % 3]] - start
    step = max(1, CHUNK // len(edges))
    parts = [_distance(points[n : n + step], start, along) for n in range(0, len(points), step)]
    return np.concatenate(parts) if parts else np.zeros(0)


def _distance(points: np.ndarray, start: np.ndarray, along: np.ndarray) -> np.ndarray:
    """Distance (k,) of points (k, 3) from the nearest of segments start + t · along (m, 3), 0 ≤ t ≤ 1."""
    away = points[:, None] - start
    length2 = np.einsum("ij,ij->i", along, along)
    t = np.clip(np.einsum("kij,ij->ki", away, along) / length2, 0.0, 1.0)
    foot = away - t[..., None] * along
    return np.asarray(np.sqrt(np.einsum("kij,kij->ki", foot, foot).min(axis=1)))
