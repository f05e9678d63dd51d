"""Carrying the front on: where an axis leaves the part, another yarn becomes the generator of what lies beyond.

Of all yarns that could be continued, the one nearest to the axis is, straight on, since it differs least from what
the axis would have done had the part not ended there; of equals, the one that goes furthest; and those that are equal
in that, too, all together, so that the senses of u and v play no part. The cells on both of their sides are then
closed from them, and so on until no yarn leads anywhere new.
"""

from __future__ import annotations

import math

import numpy as np

from geomdrap.fishnet.fill import close_from, edge_nodes
from geomdrap.fishnet.grid import STATUS, Grid
from geomdrap.fishnet.march import (
    IS_BEHIND_FOLD,
    IS_FOLDED,
    IS_OFF_PART,
    UNREACHED,
    carry_on,
    inside,
    lay_yarn,
)
from geomdrap.fishnet.place import departure, has_piece, meets_itself, settle, side_between
from geomdrap.fishnet.reasons import say_why
from geomdrap.geodesic.compiled import inlined, kernel, tight
from geomdrap.geodesic.mesh import Mesh, in_space
from geomdrap.geodesic.unfold import ENDED, shoot

STEP_I = (1, 0, -1, 0)
STEP_J = (0, 1, 0, -1)
MOST_WAYS = 64  # yarns of one rank that are continued together


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
def lay_one(mesh: Mesh, grid: Grid, i: int, j: int, di: int, dj: int) -> bool:
    """Lay one more side of the yarn that arrives at node (i, j), alone."""
    if not carry_on(mesh, grid, i, j, di, dj):
        return False
    return settle(mesh, grid, np.array([[i + di, j + dj]]), 1) == 0


@kernel
def branch(mesh: Mesh, grid: Grid, i: int, j: int, di: int, dj: int, dx: float, dy: float) -> int:
    """Lay a generator from node (i, j) in a direction of its face's frame until it ends; the nodes laid."""
    x, y = grid.node[i, j, 0], grid.node[i, j, 1]
    if not inside(grid, i + di, j + dj):
        return 0
    if not lay_yarn(mesh, grid, i, j, di, dj, grid.face[i, j] - 1, x, y, dx, dy):
        return 0
    if settle(mesh, grid, np.array([[i + di, j + dj]]), 1) > 0:
        return 0
    laid = 1
    while inside(grid, i + (laid + 1) * di, j + (laid + 1) * dj):
        if not lay_one(mesh, grid, i + laid * di, j + laid * dj, di, dj):
            break
        laid += 1
    return laid


@tight
def beside_fold(grid: Grid, i: int, j: int) -> bool:
    """Whether one of the eight nodes around (i, j) is folded or behind a fold."""
    for k in range(max(i - 1, 0), min(i + 2, grid.face.shape[0])):
        for m in range(max(j - 1, 0), min(j + 2, grid.face.shape[1])):
            if grid.marks[k, m, STATUS] == IS_FOLDED or grid.marks[k, m, STATUS] == IS_BEHIND_FOLD:
                return True
    return False


@tight
def sides_ahead(mesh: Mesh, grid: Grid, i: int, j: int, di: int, dj: int) -> int:
    """How many sides the yarn that arrives at node (i, j) can go straight on into places not yet reached.

    Where it cannot go on at all: the reason (a Status), negative.
    """
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
            return n if n > 0 else -IS_BEHIND_FOLD
        side = side_between(grid, k - di, m - dj, di, dj)
        status, face, x, y, dx, dy, _, _ = shoot(mesh.row, mesh.link, face, x, y, dx, dy, side)
        x, y = x + side * dx, y + side * dy
        if status != ENDED:
            return n if n > 0 else -IS_OFF_PART
        px, py, pz = in_space(mesh.frames, face, x, y)
        why = meets_itself(mesh, grid, k, m, face, px, py, pz)
        if why != 0:
            return n if n > 0 else -why
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
def look_ahead(mesh: Mesh, grid: Grid, known: np.ndarray) -> None:
    """Count the sides ahead of every yarn that ends beside a place not yet reached: 1 + n, or -1 - reason.

    ``known`` (4, nu, nv) keeps what was counted before. A place that no yarn leads to takes the reason.
    """
    looked_at = np.empty((4 * ends_beside_nothing(grid), 2), np.int64)
    look_from(mesh, grid, known, looked_at)


@tight
def ends_beside_nothing(grid: Grid) -> int:
    """How many nodes lie beside a place not yet reached."""
    count = 0
    for i in range(grid.box[0], grid.box[1] + 1):
        for j in range(grid.box[2], grid.box[3] + 1):
            if grid.face[i, j] != 0 and not surrounded(grid, i, j):
                count += 1
    return count


@tight
def look_from(mesh: Mesh, grid: Grid, known: np.ndarray, looked_at: np.ndarray) -> None:
    """``look_ahead``, with room for the places (n, 2) that are looked at."""
    count = 0
    for i in range(grid.box[0], grid.box[1] + 1):
        for j in range(grid.box[2], grid.box[3] + 1):
            if grid.face[i, j] == 0 or surrounded(grid, i, j):
                continue
            for a in range(4):
                di, dj = STEP_I[a], STEP_J[a]
                if known[a, i, j] == 0 and leads_on(grid, i, j, di, dj):
                    sides = sides_ahead(mesh, grid, i, j, di, dj)
                    known[a, i, j] = 1 + sides if sides >= 0 else sides - 1
                    looked_at[count, 0], looked_at[count, 1] = i + di, j + dj
                    count += 1
    for n in range(count):
        i, j = looked_at[n, 0], looked_at[n, 1]
        if grid.marks[i, j, STATUS] == UNREACHED:
            grid.marks[i, j, STATUS] = why_not(grid, i, j, known)


@inlined
def why_not(grid: Grid, i: int, j: int, known: np.ndarray) -> int:
    """The reason why no yarn leads to place (i, j); UNREACHED where one does or none was looked at."""
    why = UNREACHED
    for a in range(4):
        k, m = i - STEP_I[a], j - STEP_J[a]
        if inside(grid, k, m) and grid.face[k, m] > 0 and known[a, k, m] != 0:
            if known[a, k, m] > 1:
                return UNREACHED
            why = max(why, -known[a, k, m] - 1)
    return why


@tight
def next_ways_on(grid: Grid, i0: int, j0: int, known: np.ndarray, ways: np.ndarray) -> tuple[int, int]:
    """The yarns to continue next, all of one rank, in ``ways`` (n, 3) as i, j, direction; ``(n, sides)``."""
    count, most, nearest = 0, 0, grid.face.size
    for i in range(grid.box[0], grid.box[1] + 1):
        for j in range(grid.box[2], grid.box[3] + 1):
            if grid.face[i, j] == 0 or surrounded(grid, i, j):
                continue
            for a in range(4):
                di, dj = STEP_I[a], STEP_J[a]
                sides = known[a, i, j] - 1
                away = abs(j - j0) if dj == 0 else abs(i - i0)
                if sides <= 0 or away > nearest or not leads_on(grid, i, j, di, dj):
                    continue
                if away < nearest or sides > most:
                    count, nearest, most = 0, away, sides
                if sides == most and count < len(ways):
                    ways[count, 0], ways[count, 1], ways[count, 2] = i, j, a
                    count += 1
    return count, most


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
def lay_ways(mesh: Mesh, grid: Grid, ways: np.ndarray, sides: int) -> np.ndarray:
    """Continue ``ways`` (n, 3) by up to so many sides, a node of each in turn; the nodes laid (k, 2).

    Where two would lay the same node neither does: a cell will close there.
    """
    going = np.ones(len(ways), np.bool_)
    laid = np.empty((len(ways) * sides, 2), np.int64)
    ends = np.empty((len(ways), 2), np.int64)
    total = 0
    for n in range(sides):
        for w in range(len(ways)):
            a = ways[w, 2]
            ends[w, 0], ends[w, 1] = ways[w, 0] + (n + 1) * STEP_I[a], ways[w, 1] + (n + 1) * STEP_J[a]
            going[w] = going[w] and grid.marks[ends[w, 0], ends[w, 1], STATUS] == UNREACHED
        alone = np.ones(len(ways), np.bool_)
        for w in range(len(ways)):
            for x in range(w):
                if going[w] and going[x] and ends[w, 0] == ends[x, 0] and ends[w, 1] == ends[x, 1]:
                    alone[w] = alone[x] = False
        first = total
        for w in range(len(ways)):
            di, dj = STEP_I[ways[w, 2]], STEP_J[ways[w, 2]]
            going[w] = going[w] and alone[w]
            going[w] = going[w] and carry_on(mesh, grid, ends[w, 0] - di, ends[w, 1] - dj, di, dj)
            if going[w]:
                laid[total, 0], laid[total, 1] = ends[w, 0], ends[w, 1]
                total += 1
        if total == first:
            break
        settle(mesh, grid, laid[first:total], total - first)
        for w in range(len(ways)):
            going[w] = going[w] and grid.face[ends[w, 0], ends[w, 1]] > 0
    return laid[:total]


@kernel
def carry_front_on(mesh: Mesh, grid: Grid, i0: int, j0: int) -> int:
    """Extend the net round notches, holes and corners until the whole reachable part has it; yarns continued."""
    known = np.zeros((4, grid.face.shape[0], grid.face.shape[1]), np.int32)
    claims = np.zeros(grid.face.shape, np.int32)
    ways = np.empty((MOST_WAYS, 3), np.int64)
    continued = 0
    close_from(mesh, grid, i0, j0, edge_nodes(grid), claims)
    while True:
        look_ahead(mesh, grid, known)
        count, sides = next_ways_on(grid, i0, j0, known, ways)
        if count == 0:
            say_why(grid)
            return continued
        laid = lay_ways(mesh, grid, ways[:count], sides)
        if len(laid) == 0:  # all of them cross another one at once
            laid = lay_ways(mesh, grid, ways[:1], sides)
        continued += count
        close_from(mesh, grid, i0, j0, laid, claims)
