"""Carrying the front on: where an axis leaves the part, another yarn becomes the generator of what lies beyond.

Of all yarns that could be continued, the one that goes furthest is, straight on; the cells on both of its sides
are then closed from it, and so on until no yarn leads anywhere new. One long generator in place of many short
ones keeps the net smooth, and the choice does not depend on the numbering.
"""

from __future__ import annotations

import numpy as np

from geomdrap.fishnet.grid import STATUS, Grid
from geomdrap.fishnet.march import (
    IS_BEHIND_FOLD,
    IS_FOLDED,
    IS_OFF_PART,
    UNREACHED,
    carry_on,
    close_everywhere,
    inside,
)
from geomdrap.fishnet.place import (
    MEETS_ITSELF,
    departure,
    has_piece,
    meets_itself,
    side_between,
)
from geomdrap.geodesic.compiled import inlined, kernel
from geomdrap.geodesic.mesh import Mesh, in_space
from geomdrap.geodesic.unfold import ENDED, shoot


STEP_I = (1, 0, -1, 0)
STEP_J = (0, 1, 0, -1)


@kernel
def beside_fold(grid: Grid, i: int, j: int) -> bool:
    """Whether one of the eight nodes around (i, j) is folded or behind a fold."""
    for k in range(max(i - 1, 0), min(i + 2, grid.face.shape[0])):
        for m in range(max(j - 1, 0), min(j + 2, grid.face.shape[1])):
            if grid.marks[k, m, STATUS] == IS_FOLDED or grid.marks[k, m, STATUS] == IS_BEHIND_FOLD:
                return True
    return False


@kernel
def sides_ahead(mesh: Mesh, grid: Grid, i: int, j: int, di: int, dj: int) -> int:
    """How many sides the yarn that arrives at node (i, j) can go straight on into places not yet reached."""
    bx, by = departure(grid, i, j, -di, -dj)
    face = grid.face[i, j] - 1
    x, y = grid.node[i, j, 0], grid.node[i, j, 1]
    dx, dy = -bx, -by
    n = 0
    while True:
        k, m = i + (n + 1) * di, j + (n + 1) * dj
        if not inside(grid, k, m) or grid.marks[k, m, STATUS] != UNREACHED:
            return n
        if beside_fold(grid, k, m):
            if n == 0:
                grid.marks[k, m, STATUS] = IS_BEHIND_FOLD
            return n
        side = side_between(grid, k - di, m - dj, di, dj)
        status, face, x, y, dx, dy = shoot(
            mesh.row, mesh.link, face, x, y, dx, dy, side
        )
        x, y = x + side * dx, y + side * dy
        if status != ENDED:
            if n == 0:
                grid.marks[k, m, STATUS] = IS_OFF_PART
            return n
        px, py, pz = in_space(mesh.frames, face, x, y)
        if meets_itself(mesh, grid, k, m, face, px, py, pz, side):
            if n == 0:
                grid.marks[k, m, STATUS] = MEETS_ITSELF
            return n
        n += 1


@inlined
def surrounded(grid: Grid, i: int, j: int) -> bool:
    """Whether all four neighbours of node (i, j) have been reached or tried."""
    nu, nv = grid.face.shape
    return (
        (i + 1 >= nu or grid.marks[i + 1, j, STATUS] != UNREACHED)
        and (j + 1 >= nv or grid.marks[i, j + 1, STATUS] != UNREACHED)
        and (i == 0 or grid.marks[i - 1, j, STATUS] != UNREACHED)
        and (j == 0 or grid.marks[i, j - 1, STATUS] != UNREACHED)
    )


@kernel
def ways_from(mesh: Mesh, grid: Grid, i: int, j: int, known: np.ndarray) -> tuple[int, int]:
    """Most sides that a yarn can go straight on from node (i, j), and in which of the four directions."""
    best, best_a = 0, 0
    for a in range(4):
        di, dj = STEP_I[a], STEP_J[a]
        if not inside(grid, i + di, j + dj) or grid.marks[i + di, j + dj, STATUS] != UNREACHED:
            continue
        if not inside(grid, i - di, j - dj) or not has_piece(grid, i, j, -di, -dj):
            continue
        if known[a, i, j] == 0:
            known[a, i, j] = 1 + sides_ahead(mesh, grid, i, j, di, dj)
        if known[a, i, j] - 1 > best:
            best, best_a = known[a, i, j] - 1, a
    return best, best_a


@kernel
def longest_way_on(
    mesh: Mesh, grid: Grid, i0: int, j0: int, known: np.ndarray
) -> tuple[int, int, int, int, int]:
    """The yarn that can be continued furthest: ``(sides, i, j, di, dj)``; of equals, the nearest to the seed.

    ``known`` (4, nu, nv) keeps 1 + the sides ahead that were counted before.
    """
    best, bi, bj, ba, nearest = 0, 0, 0, 0, 0
    for i in range(grid.box[0], grid.box[1] + 1):
        for j in range(grid.box[2], grid.box[3] + 1):
            if grid.face[i, j] > 0 and not surrounded(grid, i, j):
                sides, a = ways_from(mesh, grid, i, j, known)
                away = abs(i - i0) + abs(j - j0)
                if sides > best or (sides == best and sides > 0 and away < nearest):
                    best, bi, bj, ba, nearest = sides, i, j, a, away
    return best, bi, bj, STEP_I[ba], STEP_J[ba]


@kernel
def carry_front_on(mesh: Mesh, grid: Grid, i0: int, j0: int) -> int:
    """Extend the net round notches, holes and corners until the whole reachable part has it; yarns continued."""
    known = np.zeros((4, grid.face.shape[0], grid.face.shape[1]), np.int32)
    continued = 0
    close_everywhere(mesh, grid)
    while True:
        sides, i, j, di, dj = longest_way_on(mesh, grid, i0, j0, known)
        if sides == 0:
            return continued
        laid = 0
        while laid < sides and grid.marks[i + (laid + 1) * di, j + (laid + 1) * dj, STATUS] == UNREACHED:
            if not carry_on(mesh, grid, i + laid * di, j + laid * dj, di, dj):
                break
            laid += 1
        continued += laid > 0
        close_everywhere(mesh, grid)
