"""Closing every cell that can be closed, from whichever side: what the quadrants of the seed do not reach.

Rounds are taken from the nodes that are new, so that no sense of u or v goes first: of the cells that could give the
same node in one round the one that starts nearest to the seed does, and of equals the one that is squarest.
"""

from __future__ import annotations

import numpy as np

from geomdrap.fishnet.grid import PIECES, TRIED, Grid
from geomdrap.fishnet.march import DOUBTFUL, NOTHING, SENSES, inside, is_open, try_cell
from geomdrap.fishnet.place import WARP_PIECE, WEFT_PIECE, departure, has_piece, settle
from geomdrap.geodesic.compiled import inlined, kernel, tight
from geomdrap.geodesic.mesh import Mesh


@inlined
def squareness(grid: Grid, i: int, j: int, su: int, sv: int) -> float:
    """Sine of the angle between the pieces from node (i, j) toward i + su and j + sv."""
    ux, uy = departure(grid, i, j, su, 0)
    vx, vy = departure(grid, i, j, 0, sv)
    return abs(ux * vy - uy * vx)


@tight
def cells_around(
    grid: Grid, i0: int, j0: int, nodes: np.ndarray, claims: np.ndarray, cells: np.ndarray, square: np.ndarray
) -> int:
    """Open cells with a corner among ``nodes`` (n, 2), the best for each node that they give; how many.

    A and the sense of march go into ``cells`` (16 n, 4), their squareness into ``square`` (16 n,). ``claims``
    (nu, nv) is zero, and is left so.
    """
    count = 0
    for n in range(len(nodes)):
        for corner in range(4):
            for s in range(4):
                su, sv = SENSES[s]
                i = nodes[n, 0] - (corner & 1) + (0 if su > 0 else 1)
                j = nodes[n, 1] - (corner >> 1) + (0 if sv > 0 else 1)
                if not inside(grid, i, j) or not inside(grid, i + su, j + sv) or not is_open(grid, i, j, su, sv):
                    continue
                k, m = i + su, j + sv
                if grid.marks[k, m, TRIED] & (1 << ((su > 0) + 2 * (sv > 0))):
                    continue
                sine = squareness(grid, i, j, su, sv)
                if claims[k, m] > 0:
                    old = claims[k, m] - 1
                    rank = abs(i - i0) + abs(j - j0)
                    best = abs(cells[old, 0] - i0) + abs(cells[old, 1] - j0)
                    if rank > best or (rank == best and sine <= square[old]):
                        continue
                    at = old
                else:
                    at = count
                    count += 1
                    claims[k, m] = at + 1
                cells[at, 0], cells[at, 1], cells[at, 2], cells[at, 3] = i, j, su, sv
                square[at] = sine
    for n in range(count):
        claims[cells[n, 0] + cells[n, 2], cells[n, 1] + cells[n, 3]] = 0
    return count


@tight
def try_cells(mesh: Mesh, grid: Grid, cells: np.ndarray, tried: np.ndarray, new: np.ndarray) -> tuple[int, bool]:
    """Try ``cells`` (n, 4); the nodes ``tried`` and those ``new`` (n, 2): how many are, and if any is doubtful."""
    count = 0
    doubtful = False
    for n in range(len(cells)):
        i, j, su, sv = cells[n, 0], cells[n, 1], cells[n, 2], cells[n, 3]
        tried[n, 0], tried[n, 1] = i + su, j + sv
        known = grid.face[i + su, j + sv] > 0
        result = try_cell(mesh, grid, i, j, su, sv)
        if result != NOTHING and not known:
            doubtful = doubtful or result == DOUBTFUL
            new[count, 0], new[count, 1] = i + su, j + sv
            count += 1
    return count, doubtful


@kernel
def close_from(mesh: Mesh, grid: Grid, i0: int, j0: int, nodes: np.ndarray, claims: np.ndarray) -> None:
    """Close cells outward from ``nodes`` (n, 2), in rounds, until nothing more can be closed."""
    while len(nodes) > 0:
        cells = np.empty((16 * len(nodes), 4), np.int64)
        cells = cells[: cells_around(grid, i0, j0, nodes, claims, cells, np.empty(len(cells)))]
        nodes = np.empty((len(cells), 2), np.int64)  # all that were tried: where a cell gives nothing another one may
        new = np.empty_like(nodes)
        count, doubtful = try_cells(mesh, grid, cells, nodes, new)
        if doubtful:
            settle(mesh, grid, new, count)


@kernel
def edge_nodes(grid: Grid) -> np.ndarray:
    """The nodes (n, 2) from which less than four pieces go."""
    nodes = np.empty((list_edge_nodes(grid, np.empty((0, 2), np.int64)), 2), np.int64)
    list_edge_nodes(grid, nodes)
    return nodes


@tight
def list_edge_nodes(grid: Grid, nodes: np.ndarray) -> int:
    """Put the nodes from which less than four pieces go into ``nodes`` (n, 2), as many as it holds; how many."""
    count = 0
    for i in range(grid.box[0], grid.box[1] + 1):
        for j in range(grid.box[2], grid.box[3] + 1):
            if grid.face[i, j] == 0 or (
                grid.marks[i, j, PIECES] == WARP_PIECE | WEFT_PIECE
                and has_piece(grid, i, j, -1, 0)
                and has_piece(grid, i, j, 0, -1)
            ):
                continue
            if count < len(nodes):
                nodes[count, 0], nodes[count, 1] = i, j
            count += 1
    return count
