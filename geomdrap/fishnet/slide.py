"""Yarns that slide along each other: weft pieces that grow with the shear beside them.

A weft piece is as long as the shear makes it that the fabric has there, and lengths and shear together obey a
hyperbolic equation whose characteristics are the warp yarns and lines that lean from the weft yarns towards the weft
axis. What a cell needs to know therefore lies in the cells below it *and beyond*: shear is taken at the same place in
the two rows of cells nearer to the warp axis, centred on the piece, and carried on in a straight line to this row.
That is second order in the pitch, needs no iteration, and does not blow up what the facets stir, as any rule does
that takes the shear of the cell alone.
"""

from __future__ import annotations

import math

import numpy as np

from geomdrap.fishnet.grid import PIECES, STATUS, STRAIN, Grid
from geomdrap.fishnet.march import (
    DOUBTFUL,
    IS_BEHIND_FOLD,
    NOTHING,
    SENSES,
    UNREACHED,
    is_open,
    shadowed,
    try_cell,
)
from geomdrap.fishnet.place import WARP_PIECE, WEFT_PIECE, departure, settle
from geomdrap.fishnet.shear import corner_cosine
from geomdrap.geodesic.compiled import inlined, kernel
from geomdrap.geodesic.mesh import Mesh

MOST_SINE = math.sin(math.radians(85.0))  # shear beyond which pieces grow no more


@kernel
def cell_sine(grid: Grid, i: int, j: int) -> float:
    """Sine of the shear of the cell whose low corner is node (i, j), NaN where there is none."""
    nu, nv = grid.face.shape
    if not (0 <= i < nu - 1 and 0 <= j < nv - 1):
        return math.nan
    whole = grid.marks[i, j, PIECES] == WARP_PIECE + WEFT_PIECE
    if not (whole and grid.marks[i, j + 1, PIECES] & WARP_PIECE and grid.marks[i + 1, j, PIECES] & WEFT_PIECE):
        return math.nan
    return 0.25 * (
        corner_cosine(grid, i, j, 1, 1)
        - corner_cosine(grid, i + 1, j, -1, 1)
        + corner_cosine(grid, i + 1, j + 1, -1, -1)
        - corner_cosine(grid, i, j + 1, 1, -1)
    )


@kernel
def row_sine(sines: np.ndarray, i: int, j: int, su: int) -> float:
    """Sine of the shear in row j of cells at node column i: between two cells, or beyond the last toward su."""
    nu, nv = sines.shape
    if not 0 <= j < nv:
        return math.nan
    inner, outer = (i - 1, i) if su > 0 else (i, i - 1)
    near = sines[inner, j] if 0 <= inner < nu else math.nan
    far = sines[outer, j] if 0 <= outer < nu else math.nan
    if math.isnan(far):
        before = sines[inner - su, j] if 0 <= inner - su < nu else math.nan
        return near if math.isnan(before) else 1.5 * near - 0.5 * before
    return far if math.isnan(near) else 0.5 * (near + far)


@inlined
def strain_of(sine: float, slip: float) -> float:
    """Strain of a weft piece beside shear of this sine."""
    sine = min(max(sine, -MOST_SINE), MOST_SINE)
    return (1.0 - sine * sine) ** (-0.5 * slip) - 1.0


@kernel
def foreseen_sine(grid: Grid, sines: np.ndarray, i: int, j: int, su: int, sv: int) -> float:
    """Sine of the shear on the weft piece that the cell from node (i, j) is about to lay at column i + su.

    Along the line through those of the two rows below; where there is one, as there; where there is none, as at the
    corner (i, j).
    """
    row = j if sv > 0 else j - 1
    below = row_sine(sines, i + su, row - sv, su)
    if not math.isnan(below):
        further = row_sine(sines, i + su, row - 2 * sv, su)
        return below if math.isnan(further) else 2.0 * below - further
    ux, uy = departure(grid, i, j, su, 0)
    vx, vy = departure(grid, i, j, 0, sv)
    return su * sv * (ux * vx + uy * vy)


@kernel
def fill_quadrant_sliding(
    mesh: Mesh, grid: Grid, sines: np.ndarray, i0: int, j0: int, su: int, sv: int, slip: float
) -> None:
    """Close the cells of one quadrant outward from the seed, each weft piece as long as its shear makes it.

    Diagonal by diagonal, and of a diagonal the lowest row first.
    """
    columns, rows = abs(grid.box[1 if su > 0 else 0] - i0), abs(grid.box[3 if sv > 0 else 2] - j0)
    new = np.empty((columns + rows + 1, 2), np.int64)
    for diagonal in range(columns + rows - 1):
        count = 0
        doubtful = False
        for a in range(min(diagonal, columns - 1), max(0, diagonal - rows + 1) - 1, -1):
            i, j = i0 + a * su, j0 + (diagonal - a) * sv
            low_i, low_j = i if su > 0 else i - 1, j if sv > 0 else j - 1
            if is_open(grid, i, j, su, sv):
                grid.node[i + su, low_j, STRAIN] = strain_of(foreseen_sine(grid, sines, i, j, su, sv), slip)
                known = grid.face[i + su, j + sv] > 0
                result = try_cell(mesh, grid, i, j, su, sv)
                if result != NOTHING:
                    sines[low_i, low_j] = cell_sine(grid, low_i, low_j)
                    if not known:
                        doubtful = doubtful or result == DOUBTFUL
                        new[count, 0], new[count, 1] = i + su, j + sv
                        count += 1
            elif grid.marks[i + su, j + sv, STATUS] == UNREACHED and shadowed(grid, i, j, su, sv):
                grid.marks[i + su, j + sv, STATUS] = IS_BEHIND_FOLD
        if doubtful:
            settle(mesh, grid, new, count)


@kernel
def fill_quadrants_sliding(mesh: Mesh, grid: Grid, i0: int, j0: int, slip: float) -> None:
    """Close the cells between the half-axes with weft pieces that slide, and foresee the pieces beyond.

    Pieces that are not there yet take the strain of the next one towards the weft axis, so that the front can be
    carried on.
    """
    nu, nv = grid.face.shape
    sines = np.full((nu - 1, nv - 1), math.nan)
    for su, sv in SENSES:
        fill_quadrant_sliding(mesh, grid, sines, i0, j0, su, sv, slip)
    for j in range(nv - 1):
        for step in (1, -1):
            last = 0.0
            for i in range(i0, nu if step > 0 else -1, step):
                if grid.marks[i, j, PIECES] & WEFT_PIECE:
                    last = grid.node[i, j, STRAIN]
                else:
                    grid.node[i, j, STRAIN] = last


@kernel
def strain_on_axis(grid: Grid, i0: int, slip: float) -> np.ndarray:
    """Strains (nv,) of the pieces of the weft generator, from the shear of the cells on its two sides."""
    out = np.zeros(grid.face.shape[1])
    for j in range(grid.face.shape[1] - 1):
        before, behind = cell_sine(grid, i0 - 1, j), cell_sine(grid, i0, j)
        if math.isnan(before) or math.isnan(behind):
            before = behind = before if math.isnan(behind) else behind
        if not math.isnan(before):
            out[j] = strain_of(0.5 * (before + behind), slip)
    return out
