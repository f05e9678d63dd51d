"""Reading a net between its nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from geomdrap.fishnet.net import Net


def at_fabric_coordinates(net: Net, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 3) on the surface and shear (n,) at fabric coordinates (n,), NaN outside the valid cells."""
    i, s, in_u = _cell_of(net.u, np.asarray(u, dtype=float))
    j, t, in_v = _cell_of(net.v, np.asarray(v, dtype=float))
    points = np.full((len(i), 3), np.nan)
    shear = np.full(len(i), np.nan)
    if min(net.cell_valid.shape) == 0:
        return points, shear
    ok = in_u & in_v & net.cell_valid[i, j]
    i, j, s, t = i[ok], j[ok], s[ok], t[ok]
    weights = ((1 - s) * (1 - t), s * (1 - t), (1 - s) * t, s * t)
    corners = ((i, j), (i + 1, j), (i, j + 1), (i + 1, j + 1))
    shear[ok] = sum(w * net.shear[c] for w, c in zip(weights, corners, strict=True))
    flat = sum(w[:, None] * net.points[c] for w, c in zip(weights, corners, strict=True))
    if len(i):
        points[ok] = net.surface.nearest(flat).point
    return points, shear


def _cell_of(grid: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Cell number, share of the cell passed, and whether x lies within the grid at all."""
    last = max(len(grid) - 2, 0)
    n = np.clip(np.searchsorted(grid, x, side="right") - 1, 0, last)
    width = grid[n + 1] - grid[n] if len(grid) > 1 else np.ones(len(x))
    share = (x - grid[n]) / width
    within = (share >= -1e-9) & (share <= 1.0 + 1e-9) & np.isfinite(x)
    return n, np.clip(share, 0.0, 1.0), within
