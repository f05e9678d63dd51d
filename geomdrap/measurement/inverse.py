"""Fabric coordinates of places on the part: the net read backwards."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from geomdrap.fishnet import Net

STARTS = 6
"""Nodes near a place from which the walk to it is tried: the nearest may lie on another sheet."""


def fabric_coordinates(net: Net, face: np.ndarray, points: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """u, v (n,) mm of places (n, 3) mm on faces (n,) of ``net.surface``; NaN where no cell of the net is.

    Walks through the net from nearby nodes whose facets face the same way as the place's own.
    """
    from scipy.spatial import cKDTree

    from geomdrap.fields.locate import locate

    p, q = np.full(len(points), np.nan), np.full(len(points), np.nan)
    here = np.flatnonzero(face >= 0)
    rows, columns = np.nonzero(np.isfinite(net.points[..., 0]))
    if len(rows) == 0 or min(net.cell_valid.shape) == 0 or len(here) == 0:
        return p, q
    count = min(STARTS, len(rows))
    _, near = cKDTree(net.points[rows, columns]).query(points[here], k=count)
    near = near.reshape(len(here), count)
    facing = net.surface.normals[net.face[rows, columns]]
    lattice, valid = np.ascontiguousarray(net.points), np.ascontiguousarray(net.cell_valid)
    for k, starts in zip(here.tolist(), near, strict=True):
        same_side = starts[facing[starts] @ net.surface.normals[face[k]] > 0.0]
        x, y, z = points[k]
        for n in same_side.tolist():
            found, a, b = locate(lattice, valid, float(rows[n]), float(columns[n]), x, y, z, net.pitch)
            if found:
                p[k], q[k] = a, b
                break
    return _from_cells(net.u, p), _from_cells(net.v, q)


def _from_cells(grid: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Coordinate (n,) mm at a position (n,) counted in cells from the first node."""
    return np.where(np.isfinite(cells), np.interp(cells, np.arange(len(grid)), grid), np.nan)
