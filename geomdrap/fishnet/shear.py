"""Shear angles and yarn directions, read from how the yarn pieces leave and reach their nodes.

Angles are measured in the facets, as somebody living in the surface would. Straight distances in space would show
shear where there is none: on a bend of the radius of a cell, a cell that lies askew seems to shear by 5°.
"""

from __future__ import annotations

import math

import numpy as np

from geomdrap.fishnet.grid import PIECES, Grid
from geomdrap.fishnet.place import WARP_PIECE, WEFT_PIECE, departure
from geomdrap.geodesic.compiled import inlined, tight
from geomdrap.geodesic.mesh import Mesh


@inlined
def corner_cosine(grid: Grid, i: int, j: int, su: int, sv: int) -> float:
    """Cosine of the angle at node (i, j) between its pieces toward i + su and j + sv."""
    ax, ay = departure(grid, i, j, su, 0)
    bx, by = departure(grid, i, j, 0, sv)
    return min(max(ax * bx + ay * by, -1.0), 1.0)


def shears(grid: Grid, i0: int, j0: int, valid: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Signed shear of the cells (nu - 1, nv - 1) and at the nodes (nu, nv), degrees, NaN where there is none.

    ``valid`` (nu - 1, nv - 1); the first cell is that of grid node (i0, j0). A cell's comes from its diagonals, each
    taken across the two unfolded triangles that it cuts the cell into: with sides a, b and corner angles A, B, C, D,
    BD² is the mean of a² + b² - 2ab cos A and the same with C, AC² that of B and D; sin γ = (AC² - BD²) / 4ab.
    A node's is the mean of its corners, each with the sign of its quadrant.
    """
    cells = np.full(valid.shape, np.nan)
    nodes = np.zeros((valid.shape[0] + 1, valid.shape[1] + 1))
    put_shears(grid, i0, j0, valid, cells, nodes, np.zeros(nodes.shape, np.uint8))
    return cells, nodes


@tight
def put_shears(
    grid: Grid, i0: int, j0: int, valid: np.ndarray, cells: np.ndarray, nodes: np.ndarray, count: np.ndarray
) -> None:
    """``shears`` into ``cells``, all NaN, and ``nodes``, all zero; ``count``, of their shape, is zero."""
    for m in range(valid.shape[0]):
        for n in range(valid.shape[1]):
            if not valid[m, n]:
                continue
            total = 0.0
            for di in range(2):
                for dj in range(2):
                    su, sv = 1 - 2 * di, 1 - 2 * dj
                    sine = su * sv * corner_cosine(grid, i0 + m + di, j0 + n + dj, su, sv)
                    total += sine
                    nodes[m + di, n + dj] += math.asin(sine)
                    count[m + di, n + dj] += 1
            cells[m, n] = math.degrees(math.asin(0.25 * total))
    for m in range(nodes.shape[0]):
        for n in range(nodes.shape[1]):
            nodes[m, n] = math.degrees(nodes[m, n] / count[m, n]) if count[m, n] > 0 else math.nan


def yarn_directions(mesh: Mesh, grid: Grid, i0: int, i1: int, j0: int, j1: int) -> np.ndarray:
    """Unit directions of warp and weft at nodes [i0:i1, j0:j1] in space (2, nu, nv, 3), NaN where no yarn is.

    The mean of how the yarn arrives and how it goes on, in the plane of the node's facet.
    """
    out = np.full((2, i1 - i0, j1 - j0, 3), np.nan, np.float32)
    put_directions(mesh, grid, i0, i1, j0, j1, out)
    return out


@tight
def put_directions(mesh: Mesh, grid: Grid, i0: int, i1: int, j0: int, j1: int, out: np.ndarray) -> None:
    """``yarn_directions`` into ``out``, all NaN."""
    for i in range(i0, i1):
        for j in range(j0, j1):
            if grid.face[i, j] == 0:
                continue
            f = grid.face[i, j] - 1
            ways = (
                (i + 1 < i1 and grid.marks[i, j, PIECES] & WARP_PIECE != 0, 1, 0),
                (i > i0 and grid.marks[i - 1, j, PIECES] & WARP_PIECE != 0, -1, 0),
                (j + 1 < j1 and grid.marks[i, j, PIECES] & WEFT_PIECE != 0, 0, 1),
                (j > j0 and grid.marks[i, j - 1, PIECES] & WEFT_PIECE != 0, 0, -1),
            )
            for family in range(2):
                x = y = 0.0
                for n in range(2):
                    there, di, dj = ways[2 * family + n]
                    if there:
                        dx, dy = departure(grid, i, j, di, dj)
                        x, y = x + (di + dj) * dx, y + (di + dj) * dy
                norm = math.hypot(x, y)
                if norm > 0.0:
                    for k in range(3):
                        along = x * mesh.frames[f, 3 + k] + y * mesh.frames[f, 6 + k]
                        out[family, i - i0, j - j0, k] = along / norm
