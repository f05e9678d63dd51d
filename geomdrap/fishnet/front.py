"""Carrying the front on: where an axis leaves the part, another yarn becomes the generator of what lies beyond.

Of all yarns that could be continued, the one nearest to the axis is, straight on, since it differs least from what
the axis would have done had the part not ended there; of equals, the one that goes furthest. The cells on both of
its sides are then closed from it, and so on until no yarn leads anywhere new.
"""

from __future__ import annotations

import math

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
    lay_yarn,
)
from geomdrap.fishnet.place import (
    MEETS_ITSELF,
    PRESENT,
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
def branch_off(mesh: Mesh, grid: Grid, i0: int, j0: int, weft_rad: float) -> None:
    """Let the missing generator leave from another node where the seed has none of its family: on rims and corners.

    It leaves from the node nearest to the seed from which it can, at the angle that warp and weft have at the seed.
    """
    alone = grid.box[0] == grid.box[1], grid.box[2] == grid.box[3]
    if alone[0] == alone[1]:
        return
    di, dj = (0, 1) if alone[0] else (1, 0)  # the family that is there
    turn_rad = -weft_rad if alone[0] else weft_rad
    for away in range(1, max(grid.face.shape)):
        for sense in (1, -1):
            i, j = i0 + sense * away * di, j0 + sense * away * dj
            if not inside(grid, i, j) or grid.face[i, j] == 0:
                continue
            bx, by = departure(grid, i, j, -sense * di, -sense * dj)
            c, s = -sense * math.cos(turn_rad), -sense * math.sin(turn_rad)
            dx, dy = c * bx - s * by, s * bx + c * by
            if branch(mesh, grid, i, j, dj, di, dx, dy) + branch(mesh, grid, i, j, -dj, -di, -dx, -dy) > 0:
                return


@kernel
def branch(mesh: Mesh, grid: Grid, i: int, j: int, di: int, dj: int, dx: float, dy: float) -> int:
    """Lay a generator from node (i, j) in a direction of its face's frame until it ends; the nodes laid."""
    laid = 0
    x, y = grid.node[i, j, 0], grid.node[i, j, 1]
    if inside(grid, i + di, j + dj) and lay_yarn(mesh, grid, i, j, di, dj, grid.face[i, j] - 1, x, y, dx, dy):
        laid = 1
        while inside(grid, i + (laid + 1) * di, j + (laid + 1) * dj):
            if not carry_on(mesh, grid, i + laid * di, j + laid * dj, di, dj):
                break
            laid += 1
    return laid


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
        status, face, x, y, dx, dy = shoot(mesh.row, mesh.link, face, x, y, dx, dy, side)
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
def next_way_on(mesh: Mesh, grid: Grid, i0: int, j0: int, known: np.ndarray) -> tuple[int, int, int, int, int]:
    """The yarn to continue next: ``(sides, i, j, di, dj)``, sides 0 if there is none.

    ``known`` (4, nu, nv) keeps 1 + the sides ahead that were counted before.
    """
    best, bi, bj, ba, nearest = 0, 0, 0, 0, grid.face.size
    for i in range(grid.box[0], grid.box[1] + 1):
        for j in range(grid.box[2], grid.box[3] + 1):
            if grid.face[i, j] == 0 or surrounded(grid, i, j):
                continue
            for a in range(4):
                di, dj = STEP_I[a], STEP_J[a]
                away = abs(j - j0) if dj == 0 else abs(i - i0)
                if away > nearest or not leads_on(grid, i, j, di, dj):
                    continue
                if known[a, i, j] == 0:
                    known[a, i, j] = 1 + sides_ahead(mesh, grid, i, j, di, dj)
                sides = known[a, i, j] - 1
                if sides > 0 and (away < nearest or sides > best):
                    best, bi, bj, ba, nearest = sides, i, j, a, away
    return best, bi, bj, STEP_I[ba], STEP_J[ba]


@inlined
def leads_on(grid: Grid, i: int, j: int, di: int, dj: int) -> bool:
    """Whether a yarn arrives at node (i, j) and has not been followed beyond it."""
    return (
        inside(grid, i + di, j + dj)
        and grid.marks[i + di, j + dj, STATUS] == UNREACHED
        and inside(grid, i - di, j - dj)
        and has_piece(grid, i, j, -di, -dj)
    )


@kernel
def carry_front_on(mesh: Mesh, grid: Grid, i0: int, j0: int) -> int:
    """Extend the net round notches, holes and corners until the whole reachable part has it; yarns continued."""
    known = np.zeros((4, grid.face.shape[0], grid.face.shape[1]), np.int32)
    continued = 0
    close_everywhere(mesh, grid)
    while True:
        sides, i, j, di, dj = next_way_on(mesh, grid, i0, j0, known)
        if sides == 0:
            say_why(grid)
            return continued
        laid = 0
        while laid < sides and grid.marks[i + (laid + 1) * di, j + (laid + 1) * dj, STATUS] == UNREACHED:
            if not carry_on(mesh, grid, i + laid * di, j + laid * dj, di, dj):
                break
            laid += 1
        continued += laid > 0
        close_everywhere(mesh, grid)


@kernel
def say_why(grid: Grid) -> None:
    """Give the nodes around the net that nothing reached the reason of those before them; folds come last."""
    spread(grid, False)
    spread(grid, True)


@kernel
def spread(grid: Grid, folds: bool) -> None:
    """Carry reasons outward, row by row and back, until no node takes one any more."""
    i0, i1 = max(grid.box[0] - 1, 0), min(grid.box[1] + 1, grid.face.shape[0] - 1)
    j0, j1 = max(grid.box[2] - 1, 0), min(grid.box[3] + 1, grid.face.shape[1] - 1)
    changed = True
    while changed:
        changed = False
        for sense in (1, -1):
            for a in range(i1 - i0 + 1):
                i = i0 + a if sense > 0 else i1 - a
                for b in range(j1 - j0 + 1):
                    j = j0 + b if sense > 0 else j1 - b
                    if grid.marks[i, j, STATUS] != UNREACHED:
                        continue
                    k, m = i - sense, j - sense
                    why = reason_to_carry(grid.marks[k, j, STATUS], folds) if i0 <= k <= i1 else UNREACHED
                    if why == UNREACHED and j0 <= m <= j1:
                        why = reason_to_carry(grid.marks[i, m, STATUS], folds)
                    if why != UNREACHED:
                        grid.marks[i, j, STATUS] = why
                        changed = True


@inlined
def reason_to_carry(status: int, folds: bool) -> int:
    """The reason that a node beside one with this status takes, UNREACHED for none."""
    if status in (UNREACHED, PRESENT):
        return UNREACHED
    if status in (IS_FOLDED, IS_BEHIND_FOLD):
        return IS_BEHIND_FOLD if folds else UNREACHED
    return status
