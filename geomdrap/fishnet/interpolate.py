"""Reading a net between its nodes."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from geomdrap.fishnet.follow_surface import nearest_from

if TYPE_CHECKING:
    from geomdrap.fishnet.net import Net

ROUNDING = 1e-9  # cells: a place this close to the side of a cell lies on it


class _Places(NamedTuple):
    """Cells (k,) i, j in which places lie, shares (k,) s, t of them passed, and which (n,) have a valid cell."""

    i: np.ndarray
    j: np.ndarray
    s: np.ndarray
    t: np.ndarray
    ok: np.ndarray

    def mean(self, nodes: np.ndarray) -> np.ndarray:
        """Bilinear means (k, ...) of values at the nodes (nu, nv, ...)."""
        i, j = self.i, self.j
        s, t = (share.reshape(-1, *[1] * (nodes.ndim - 2)) for share in (self.s, self.t))
        return np.asarray(
            (1 - s) * (1 - t) * nodes[i, j]
            + s * (1 - t) * nodes[i + 1, j]
            + (1 - s) * t * nodes[i, j + 1]
            + s * t * nodes[i + 1, j + 1]
        )


def at_fabric_coordinates(net: Net, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Points (n, 3) on the surface and shear (n,) at fabric coordinates (n,), NaN outside the valid cells."""
    places = _places(net, u, v)
    points = np.full((len(places.ok), 3), np.nan)
    shear = np.full(len(places.ok), np.nan)
    if places.ok.any():
        shear[places.ok] = places.mean(net.shear)
        points[places.ok] = _on_part(net, places)
    return points, shear


def _on_part(net: Net, places: _Places) -> np.ndarray:
    """The nearest points (k, 3) of the part to bilinear means, looked for from each corner of their cells."""
    part, means = net.surface, places.mean(net.points)
    mesh = (part.points, part.triangles, part.neighbours, part.neighbour_edge)
    corners = [(places.i + di, places.j + dj) for di in (0, 1) for dj in (0, 1)]
    found = np.array([nearest_from(*mesh, means, net.face[corner])[0] for corner in corners])
    nearest = np.linalg.norm(found - means, axis=2).argmin(axis=0)
    return np.asarray(found[nearest, np.arange(len(means))])


def directions_at(net: Net, u: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Unit directions of warp and weft (n, 3) at fabric coordinates (n,), NaN outside the valid cells."""
    places = _places(net, u, v)
    both = np.full((2, len(places.ok), 3), np.nan)
    if places.ok.any():
        for family in range(2):
            mean = places.mean(net.yarns[family].astype(float))
            both[family, places.ok] = mean / np.linalg.norm(mean, axis=1, keepdims=True)
    return both[0], both[1]


def _places(net: Net, u: np.ndarray, v: np.ndarray) -> _Places:
    """The valid cell of each place; on a side or a node between cells any of them will do."""
    i, s, in_u = _cell_of(net.u, np.asarray(u, dtype=float))
    j, t, in_v = _cell_of(net.v, np.asarray(v, dtype=float))
    if min(net.cell_valid.shape) == 0:
        none = np.zeros(0, int)
        return _Places(none, none, s[:0], t[:0], np.zeros(len(i), bool))
    within = in_u & in_v
    ok = within & net.cell_valid[i, j]
    for di, dj in ((1, 0), (0, 1), (1, 1)):
        k, m = i - di, j - dj
        on_side = ((s <= ROUNDING) | (di == 0)) & ((t <= ROUNDING) | (dj == 0)) & (k >= 0) & (m >= 0)
        move = within & ~ok & on_side & net.cell_valid[np.maximum(k, 0), np.maximum(m, 0)]
        i, j = np.where(move, k, i), np.where(move, m, j)
        s, t = np.where(move & (di == 1), 1.0, s), np.where(move & (dj == 1), 1.0, t)
        ok = ok | move
    return _Places(i[ok], j[ok], s[ok], t[ok], ok)


def _cell_of(grid: np.ndarray, x: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Cell number, share of the cell passed, and whether x lies within the grid at all."""
    last = max(len(grid) - 2, 0)
    n = np.clip(np.searchsorted(grid, x, side="right") - 1, 0, last)
    width = grid[n + 1] - grid[n] if len(grid) > 1 else np.ones(len(x))
    share = (x - grid[n]) / width
    # a place a rounding error before a node counts as on it
    over = (share >= 1.0 - ROUNDING) & (n < last)
    n, share = np.where(over, n + 1, n), np.where(over, 0.0, share)
    within = (share >= -ROUNDING) & (share <= 1.0 + ROUNDING) & np.isfinite(x)
    return n, np.clip(share, 0.0, 1.0), within
