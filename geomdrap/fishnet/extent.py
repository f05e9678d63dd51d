"""How many rows and columns the net may need, before it is known."""

from __future__ import annotations

import math
import os
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import DrapeError
from geomdrap.fishnet.grid import BYTES_PER_NODE, STATUS, Grid, Status

if TYPE_CHECKING:
    from geomdrap.fishnet.seed import Seed
    from geomdrap.surface import Surface

SPARE = 1.3  # fabric is longer than its shadow on the tangent plane


@dataclass(frozen=True)
class Extent:
    """Cells from the seed toward +u, -u, +v, -v; ``bounded``: they end where the blank does."""

    east: int
    west: int
    north: int
    south: int
    bounded: bool

    def status_around(self, grid: Grid) -> np.ndarray:
        """Status of the nodes and of a frame of one node around them; beyond the grid: beyond the blank."""
        i0, i1, j0, j1 = (int(k) for k in grid.box)
        padded = np.full((grid.face.shape[0] + 2, grid.face.shape[1] + 2), np.uint8(Status.BLANK))
        padded[1:-1, 1:-1] = grid.marks[..., STATUS]
        return padded[i0 : i1 + 3, j0 : j1 + 3].copy()


def first_extent(
    surface: Surface, seed: Seed, pitch: float, reach: tuple[float, float] | None
) -> Extent:
    """Extent from the blank, or else from the part's shadow on the tangent plane at the seed.

    Raises DrapeError for a blank without a length and for more nodes than memory holds.
    """
    if reach is not None:
        if len(reach) != 2 or not all(math.isfinite(r) and r > 0.0 for r in reach):
            raise DrapeError(f"the blank must have two positive half lengths in mm, not {reach}")
    _require_memory(1.2 * surface.area / pitch**2, pitch)
    away = surface.points - seed.point
    along, across = away @ seed.warp, away @ seed.weft
    counts = [
        math.ceil(SPARE * max(float(side), 0.0) / pitch) + 2
        for side in (along.max(), -along.min(), across.max(), -across.min())
    ]
    if reach is not None:
        limits = [math.floor(r / pitch + 1e-9) for r in (reach[0], reach[0], reach[1], reach[1])]
        counts = limits
    extent = Extent(*counts, bounded=reach is not None)
    _require_memory((counts[0] + counts[1]) * (counts[2] + counts[3]) / 4.0, pitch)
    return extent


def _require_memory(nodes: float, pitch: float) -> None:
    """Raise DrapeError where the nodes would not fit into half of the machine's memory."""
    have = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") if hasattr(os, "sysconf") else 8e9
    need = nodes * BYTES_PER_NODE
    if need > 0.5 * have:
        raise DrapeError(
            f"a pitch of {pitch:g} mm gives about {nodes:.2g} nodes, which need {need / 1e9:.3g} GB of memory "
            f"(this machine has {have / 1e9:.3g} GB); use a larger pitch or a smaller blank (--blank)"
        )


def sides(extent: Extent, pitch: float) -> tuple[np.ndarray, np.ndarray]:
    """Side lengths of the cells along u and along v, mm."""
    return np.full(extent.east + extent.west, pitch), np.full(extent.north + extent.south, pitch)


def grow(extent: Extent, grid: Grid, surface: Surface, pitch: float) -> Extent:
    """A larger extent where the net reached the border of an unbounded grid, else the same one."""
    if extent.bounded:
        return extent
    nu, nv = grid.face.shape
    i0, i1, j0, j1 = grid.box
    larger = Extent(
        east=extent.east * (2 if i1 == nu - 1 else 1),
        west=extent.west * (2 if i0 == 0 else 1),
        north=extent.north * (2 if j1 == nv - 1 else 1),
        south=extent.south * (2 if j0 == 0 else 1),
        bounded=False,
    )
    if larger != extent:
        _require_memory((larger.east + larger.west) * (larger.north + larger.south) / 4.0, pitch)
    return larger
