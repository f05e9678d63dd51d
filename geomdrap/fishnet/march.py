"""The march: generators from the seed, cells quadrant by quadrant, and the front carried on where an axis ends."""

from __future__ import annotations

import math

import numpy as np

from geomdrap.fishnet.cell import CLOSED, FOLDED, NOT_CLOSED, OFF_PART, close_cell
from geomdrap.fishnet.grid import PIECES, STATUS, TRIED, Grid
from geomdrap.fishnet.pivot import close_round_vertices
from geomdrap.fishnet.place import (
    PRESENT,
    add_piece,
    depart_as,
    departure,
    place,
    settle,
    side_between,
)
from geomdrap.geodesic.compiled import inlined, kernel, tight
from geomdrap.geodesic.mesh import Mesh, in_frame, in_space
from geomdrap.geodesic.trace import follow
from geomdrap.geodesic.unfold import ENDED

UNREACHED = 0
IS_OFF_PART = 2
IS_FOLDED = 4
IS_BEHIND_FOLD = 5
IS_NOT_CLOSED = 7

NOTHING, ADDED, DOUBTFUL = 0, 1, 2  # what trying a cell gave
SENSES = ((1, 1), (-1, 1), (-1, -1), (1, -1))

SAME_PLACE = 2e-3  # of the side: two fronts that meet this closely are one net; else there is a seam


@inlined
def inside(grid: Grid, i: int, j: int) -> bool:
    """Whether the grid has a place for node (i, j)."""
    return 0 <= i < grid.face.shape[0] and 0 <= j < grid.face.shape[1]


@kernel
def lay_yarn(
    mesh: Mesh,
    grid: Grid,
    i: int,
    j: int,
    di: int,
    dj: int,
    face: int,
    x: float,
    y: float,
    dx: float,
    dy: float,
) -> bool:
    """Continue a yarn straight on from a point by one side and put node (i + di, j + dj) there, to be settled."""
    k, m = i + di, j + dj
    side = side_between(grid, i, j, di, dj)
    status, end, ex, ey, ax, ay, _, _, _ = follow(mesh.row, mesh.link, face, x, y, dx, dy, side)
    if status != ENDED:
        grid.marks[k, m, STATUS] = IS_OFF_PART
        return False
    place(mesh, grid, k, m, end, ex, ey)
    add_piece(grid, i, j, di, dj, dx, dy, ax, ay)
    return True


@kernel
def lay_generators(
    mesh: Mesh, grid: Grid, i0: int, j0: int, starts: np.ndarray, places: np.ndarray, turns: np.ndarray
) -> None:
    """Lay the four half-axes, a node of each in turn so that on a closed part none runs all the way round.

    ``starts`` (4,) are the faces and ``places`` (4, 4) points and directions with which +u, +v, -u, -v leave;
    ``turns`` (4, n) radians is how each turns to the left at its nodes, the first at the seed; none beyond.
    """
    steps = ((1, 0), (0, 1), (-1, 0), (0, -1))
    going = np.ones(4, np.bool_)
    for n in range(max(grid.face.shape[0], grid.face.shape[1])):
        for a in range(4):
            di, dj = steps[a]
            i, j = i0 + n * di, j0 + n * dj
            if not going[a] or not inside(grid, i + di, j + dj):
                going[a] = False
                continue
            turn = turns[a, n] if n < turns.shape[1] else 0.0
            if n == 0:
                x, y, dx, dy = places[a]
                keep = departure(grid, i, j, di, dj)
                if turn != 0.0:
                    dx, dy = turned(dx, dy, turn)
                    keep = turned(keep[0], keep[1], turn)
                going[a] = lay_yarn(mesh, grid, i, j, di, dj, starts[a], x, y, dx, dy)
                if going[a]:  # the seed keeps the right angle: on a vertex its half-axes lie in other frames
                    depart_as(grid, i, j, di, dj, keep[0], keep[1])
            else:
                if turn != 0.0:  # bend what arrives, carry on straight, and put it back
                    before = departure(grid, i, j, -di, -dj)
                    bent = turned(before[0], before[1], turn)
                    depart_as(grid, i, j, -di, -dj, bent[0], bent[1])
                going[a] = carry_on(mesh, grid, i, j, di, dj)
                if turn != 0.0:
                    depart_as(grid, i, j, -di, -dj, before[0], before[1])
        settle_axes(mesh, grid, i0, j0, n + 1, going)


@kernel
def settle_axes(mesh: Mesh, grid: Grid, i0: int, j0: int, n: int, going: np.ndarray) -> None:
    """Settle the n-th nodes of the half-axes; one whose node is taken back goes no further."""
    ends = np.array([[i0 + n, j0], [i0, j0 + n], [i0 - n, j0], [i0, j0 - n]])
    settle(mesh, grid, ends[going], going.sum())
    for a in range(4):
        going[a] = going[a] and grid.face[ends[a, 0], ends[a, 1]] > 0


@inlined
def turned(dx: float, dy: float, angle_rad: float) -> tuple[float, float]:
    """A direction turned counter-clockwise."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    return c * dx - s * dy, s * dx + c * dy


@tight
def carry_on(mesh: Mesh, grid: Grid, i: int, j: int, di: int, dj: int) -> bool:
    """Lay one more side of the yarn that arrives at node (i, j) in direction (di, dj)."""
    bx, by = departure(grid, i, j, -di, -dj)
    x, y = grid.node[i, j, 0], grid.node[i, j, 1]
    return lay_yarn(mesh, grid, i, j, di, dj, grid.face[i, j] - 1, x, y, -bx, -by)


@tight
def same_place(mesh: Mesh, grid: Grid, i: int, j: int, face: int, x: float, y: float, side: float) -> bool:
    """Whether a point is where node (i, j) already lies."""
    px, py, pz = in_space(mesh.frames, face, x, y)
    qx, qy, qz = in_space(mesh.frames, grid.face[i, j] - 1, grid.node[i, j, 0], grid.node[i, j, 1])
    return (px - qx) ** 2 + (py - qy) ** 2 + (pz - qz) ** 2 <= (SAME_PLACE * side) ** 2


@inlined
def is_open(grid: Grid, i: int, j: int, su: int, sv: int) -> bool:
    """Whether the cell from A = (i, j) to C = (i + su, j + sv) can be tried: A, B, D are joined, C is not to both."""
    k, m = i + su, j + sv
    low_i, low_j = min(i, k), min(j, m)
    # bits 1 and 2: warp and weft piece at the cell's low corner; 4: weft piece opposite; 8: warp piece opposite
    pieces = (
        (grid.marks[low_i, low_j, PIECES] & 3)
        + (grid.marks[low_i + 1, low_j, PIECES] & 2) * 2
        + (grid.marks[low_i, low_j + 1, PIECES] & 1) * 8
    )
    need = (1 if sv > 0 else 8) + (2 if su > 0 else 4)
    if pieces == 15 or (pieces & need) != need:
        return False
    state = grid.marks[k, m, STATUS]
    return state in (UNREACHED, PRESENT, IS_OFF_PART, IS_NOT_CLOSED)


@inlined
def try_cell(mesh: Mesh, grid: Grid, i: int, j: int, su: int, sv: int) -> int:
    """Close the open cell between A = (i, j) and C = (i + su, j + sv): NOTHING, ADDED a node or side, or DOUBTFUL.

    A doubtful node may lie on another stretch of the net: the nodes of its rank must be settled.
    """
    k, m = i + su, j + sv
    known = grid.marks[k, m, STATUS] == PRESENT
    bit = 1 << ((su > 0) + 2 * (sv > 0))
    if grid.marks[k, m, TRIED] & bit:
        return NOTHING
    grid.marks[k, m, TRIED] |= bit

    # the sides of a small cell are parallel: B to C as A to D, D to C as A to B
    ux, uy = departure(grid, i, j, su, 0)
    vx, vy = departure(grid, i, j, 0, sv)
    c, s = ux * vx + uy * vy, ux * vy - uy * vx
    sense = float(su * sv)
    if s * sense <= 0.0:
        if not known:
            grid.marks[k, m, STATUS] = IS_FOLDED
        return NOTHING
    px, py = departure(grid, k, j, -su, 0)
    qx, qy = departure(grid, i, m, 0, -sv)
    xb, yb = grid.node[k, j, 0], grid.node[k, j, 1]
    xd, yd = grid.node[i, m, 0], grid.node[i, m, 1]
    lb, ld = side_between(grid, k, j, 0, sv), side_between(grid, i, m, su, 0)
    cell = (
        mesh.row,
        mesh.link,
        mesh.frames,
        grid.face[k, j] - 1,
        xb,
        yb,
        -(c * px - s * py),
        -(s * px + c * py),
        lb,
        grid.face[i, m] - 1,
        xd,
        yd,
        -(c * qx + s * qy),
        -(c * qy - s * qx),
        ld,
        sense,
    )
    state, face, x, y, obx, oby, abx, aby, odx, ody, adx, ady = close_cell(*cell)
    if state == NOT_CLOSED:
        state, face, x, y, obx, oby, abx, aby, odx, ody, adx, ady = close_round_vertices(*cell)
    if known:  # two fronts meet
        if state != CLOSED or not same_place(mesh, grid, k, m, face, x, y, lb):
            return NOTHING
        abx, aby = in_frame(mesh.frames, face, grid.face[k, m] - 1, abx, aby)
        adx, ady = in_frame(mesh.frames, face, grid.face[k, m] - 1, adx, ady)
    # at B and D, too, the corner of the cell must open to its own side
    if state == CLOSED and ((oby * px - obx * py) * sense >= 0.0 or (ody * qx - odx * qy) * sense <= 0.0):
        state = FOLDED
    if state != CLOSED and not known:
        grid.marks[k, m, STATUS] = (
            IS_FOLDED if state == FOLDED else IS_OFF_PART if state == OFF_PART else IS_NOT_CLOSED
        )
        return NOTHING
    doubtful = not known and place(mesh, grid, k, m, face, x, y)
    add_piece(grid, k, j, 0, sv, obx, oby, abx, aby)
    add_piece(grid, i, m, su, 0, odx, ody, adx, ady)
    return DOUBTFUL if doubtful else ADDED


@inlined
def shadowed(grid: Grid, i: int, j: int, su: int, sv: int) -> bool:
    """Whether the cell from node (i, j) rests on a node that is folded or behind a fold."""
    b, d = grid.marks[i + su, j, STATUS], grid.marks[i, j + sv, STATUS]
    return b in (IS_FOLDED, IS_BEHIND_FOLD) or d in (IS_FOLDED, IS_BEHIND_FOLD)


@tight
def fill_diagonal(
    mesh: Mesh,
    grid: Grid,
    box: np.ndarray,
    i0: int,
    j0: int,
    diagonal: int,
    su: int,
    sv: int,
    new: np.ndarray,
    count: int,
) -> tuple[int, bool]:
    """Close the cells of one quadrant on a diagonal; the nodes in ``new`` (n, 2) and whether any is doubtful.

    ``box`` (4,) is how far the half-axes go. A fold throws a shadow: what is behind it would have to be cut and
    stitched, so it is left bare and marked.
    """
    columns, rows = abs(box[1 if su > 0 else 0] - i0), abs(box[3 if sv > 0 else 2] - j0)
    doubtful = False
    for a in range(max(0, diagonal - rows + 1), min(diagonal + 1, columns)):
        i, j = i0 + a * su, j0 + (diagonal - a) * sv
        if is_open(grid, i, j, su, sv):
            known = grid.marks[i + su, j + sv, STATUS] == PRESENT
            result = try_cell(mesh, grid, i, j, su, sv)
            if result != NOTHING and not known:
                doubtful = doubtful or result == DOUBTFUL
                new[count, 0], new[count, 1] = i + su, j + sv
                count += 1
        elif grid.marks[i + su, j + sv, STATUS] == UNREACHED and shadowed(grid, i, j, su, sv):
            grid.marks[i + su, j + sv, STATUS] = IS_BEHIND_FOLD
    return count, doubtful


@kernel
def fill_quadrants(mesh: Mesh, grid: Grid, i0: int, j0: int) -> None:
    """Close the cells between the half-axes outward from the seed, a diagonal in all quadrants at a time.

    In that order a cell is tried before anything that lies behind it, and no quadrant is there before the others.
    """
    box = grid.box.copy()
    new = np.empty((2 * (box[1] - box[0] + box[3] - box[2]) + 4, 2), np.int64)
    for diagonal in range(max(box[1] - i0, i0 - box[0]) + max(box[3] - j0, j0 - box[2])):
        count = 0
        doubtful = False
        for su, sv in SENSES:
            count, doubt = fill_diagonal(mesh, grid, box, i0, j0, diagonal, su, sv, new, count)
            doubtful = doubtful or doubt
        if doubtful:
            settle(mesh, grid, new, count)
