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
    from geomdrap.fishnet.fabric import Fabric
    from geomdrap.fishnet.seed import Seed
    from geomdrap.surface import Surface

LEAST_SIDE = 0.5  # of the pitch: a fabric that shrinks more is a wrong parameter
SPARE = 1.3  # fabric is longer than its shadow on the tangent plane


UNLIMITED = 1 << 40


@dataclass(frozen=True)
class Extent:
    """Cells from the seed toward +u, -u, +v, -v, and the most that the blank allows in each of them."""

    east: int
    west: int
    north: int
    south: int
    limits: tuple[int, int, int, int] = (UNLIMITED,) * 4

    def status_around(self, grid: Grid) -> np.ndarray:
        """Status of the nodes and of a frame of one node around them; beyond a full grid: beyond the blank."""
        i0, i1, j0, j1 = (int(k) for k in grid.box[:4])
        padded = np.full((grid.face.shape[0] + 2, grid.face.shape[1] + 2), np.uint8(Status.BLANK))
        padded[1:-1, 1:-1] = grid.marks[..., STATUS]
        return padded[i0 : i1 + 3, j0 : j1 + 3].copy()


def first_extent(surface: Surface, seed: Seed, pitch: float, reach: tuple[float, float] | None) -> Extent:
    """Extent from the part's shadow on the tangent plane at the seed, within the blank.

    Raises DrapeError for a blank without a length and for more nodes than memory holds.
    """
    limits = (UNLIMITED,) * 4
    if reach is not None:
        if len(reach) != 2 or not all(math.isfinite(r) and r > 0.0 for r in reach):
            raise DrapeError(f"the blank must have two positive half lengths in mm, not {reach}")
        along, across = (int(min(r / pitch + 1e-9, UNLIMITED)) for r in reach)
        limits = (along, along, across, across)
    away = surface.points - seed.point
    along_u, along_v = away @ seed.warp, away @ seed.weft
    shadow = (along_u.max(), -along_u.min(), along_v.max(), -along_v.min())
    counts = [math.ceil(SPARE * max(float(side), 0.0) / pitch) + 2 for side in shadow]
    return _within(counts, limits, pitch)


def _within(counts: list[int], limits: tuple[int, int, int, int], pitch: float) -> Extent:
    """An extent cut to its limits, if memory holds it: of a grid turned against the part a quarter is net."""
    east, west, north, south = (min(c, m) for c, m in zip(counts, limits, strict=True))
    _require_memory((east + west + 1.0) * (north + south + 1.0) / 4.0, pitch)
    return Extent(east, west, north, south, limits)


def _require_memory(nodes: float, pitch: float) -> None:
    """Raise DrapeError where the nodes would not fit into half of the machine's memory."""
    have = os.sysconf("SC_PAGE_SIZE") * os.sysconf("SC_PHYS_PAGES") if hasattr(os, "sysconf") else 8e9
    need = nodes * BYTES_PER_NODE
    if need > 0.5 * have:
        raise DrapeError(
            f"a pitch of {pitch:g} mm gives about {nodes:.2g} nodes, which need {need / 1e9:.3g} GB of memory "
            f"(this machine has {have / 1e9:.3g} GB); use a larger pitch or a smaller blank (--blank)"
        )


def sides(extent: Extent, pitch: float, fabric: Fabric) -> tuple[np.ndarray, np.ndarray]:
    """Side lengths of the cells along u and along v, mm, with the fabric's strains.

    Raises DrapeError where the fabric would shrink to less than half.
    """
    along = _strained(extent.west, extent.east, pitch, fabric.strain_warp, fabric.strain_growth_warp)
    across = _strained(extent.south, extent.north, pitch, fabric.strain_weft, fabric.strain_growth_weft)
    return along, across


def _strained(before: int, after: int, pitch: float, strain: float, growth: float) -> np.ndarray:
    """Sides of one family; their strain is that of their middle, ``growth`` per mm from the origin."""
    away = np.abs(np.arange(-before, after) + 0.5) * pitch
    share = 1.0 + strain + growth * away
    if share.min(initial=1.0) < LEAST_SIDE:
        raise DrapeError(
            f"the strains of the fabric shrink it to {share.min():.2g} of its length {away.max():.4g} mm from the "
            "origin; use smaller ones"
        )
    return pitch * share


def grow(extent: Extent, grid: Grid, pitch: float) -> Extent:
    """A larger extent where the net reached the border of the grid before that of the blank, else the same one."""
    nu, nv = grid.face.shape
    i0, i1, j0, j1 = grid.box[:4]
    reached = (i1 == nu - 1, i0 == 0, j1 == nv - 1, j0 == 0)
    now = (extent.east, extent.west, extent.north, extent.south)
    if not any(r and n < m for r, n, m in zip(reached, now, extent.limits, strict=True)):
        return extent
    return _within([2 * n + 2 if r else n for r, n in zip(reached, now, strict=True)], extent.limits, pitch)
