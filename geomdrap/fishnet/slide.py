"""Yarns that slide along each other: weft pieces that grow with the shear beside them.

The length of a weft piece depends on the shear of the cells on its two sides, one of which is closed after it. So the
net is marched with the lengths that the net before gave, until they no longer change. Each length then belongs to the
mean of both cells, which is second order in the pitch; and since shear at a place depends on lengths nearer to the
seed only, the rounds converge faster than any power.
"""

from __future__ import annotations

import math

import numpy as np

from geomdrap.fishnet.grid import PIECES, Grid
from geomdrap.fishnet.place import WARP_PIECE, WEFT_PIECE
from geomdrap.fishnet.shear import corner_cosine
from geomdrap.geodesic.compiled import kernel

SETTLED = 1e-7  # change of a strain below which the lengths are taken as found
ROUNDS = 25
MOST_SINE = math.sin(math.radians(88.0))  # a side would be 30 times as long there


@kernel
def cell_sines(grid: Grid) -> np.ndarray:
    """Sine of the shear of the cells (nu - 1, nv - 1), NaN where there is none."""
    nu, nv = grid.face.shape
    out = np.full((nu - 1, nv - 1), np.nan)
    for i in range(max(grid.box[0], 0), min(grid.box[1], nu - 1)):
        for j in range(max(grid.box[2], 0), min(grid.box[3], nv - 1)):
            pieces = grid.marks[i, j, PIECES] == WARP_PIECE + WEFT_PIECE
            closed = grid.marks[i, j + 1, PIECES] & WARP_PIECE and grid.marks[i + 1, j, PIECES] & WEFT_PIECE
            if pieces and closed:
                out[i, j] = 0.25 * (
                    corner_cosine(grid, i, j, 1, 1)
                    - corner_cosine(grid, i + 1, j, -1, 1)
                    + corner_cosine(grid, i + 1, j + 1, -1, -1)
                    - corner_cosine(grid, i, j + 1, 1, -1)
                )
    return out


@kernel
def side_sine(sines: np.ndarray, i: int, j: int) -> float:
    """Sine of the shear on the weft piece from node (i, j): of the two cells beside it, or beyond the last one."""
    nu = sines.shape[0]
    before = sines[i - 1, j] if i > 0 else np.nan
    behind = sines[i, j] if i < nu else np.nan
    if not math.isnan(before) and not math.isnan(behind):
        return 0.5 * (before + behind)
    if not math.isnan(before):
        further = sines[i - 2, j] if i > 1 else np.nan
        return before if math.isnan(further) else 1.5 * before - 0.5 * further
    further = sines[i + 1, j] if i + 1 < nu else np.nan
    return behind if math.isnan(further) else 1.5 * behind - 0.5 * further


@kernel
def weft_strains(grid: Grid, i0: int, slip: float) -> np.ndarray:
    """Strains (nu, nv) that sliding gives the weft pieces from node (i, j) to (i, j + 1).

    Pieces that are not there take that of the next one towards the seed, so that the net of the next round ends
    where it should.
    """
    nu, nv = grid.face.shape
    sines = cell_sines(grid)
    out = np.zeros((nu, nv))
    for j in range(nv - 1):
        for step in (1, -1):
            last = 0.0
            for i in range(i0, nu if step > 0 else -1, step):
                sine = side_sine(sines, i, j)
                if not math.isnan(sine):
                    sine = min(max(sine, -MOST_SINE), MOST_SINE)
                    last = (1.0 - sine * sine) ** (-0.5 * slip) - 1.0
                out[i, j] = last
    return out
