"""Cells that the plain iteration cannot close: a side that has to pivot at a vertex.

At a vertex whose faces add up to more than 360° (negative angle deficit) lines that pass on its left and on its
right part, and the wedge between them is reached by no straight line: a side that must end there jumps over the
vertex for ever. The shortest way into the wedge goes straight to the vertex and on from it, with at least half a
turn of faces on either hand. Such a side has its length to the last digit; its end moves round the vertex as that
of another side does round its node, and that is how the cell is closed.

Where sides jump over a vertex of positive deficit, the tip of a cone, there is no cell: the tip takes more angle out
of it than it has.

Source: J. S. B. Mitchell, D. M. Mount, C. H. Papadimitriou, The discrete geodesic problem, SIAM J. Comput. 16, 1987
(shortest paths pass through such vertices only).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from geomdrap.fishnet.cell import (
    CLOSED,
    FOLDED,
    MEET,
    NOT_CLOSED,
    OFF_PART,
    TOLERANCE,
    apart,
    crossing,
    meeting_rotation,
    moved_into,
)
from geomdrap.geodesic.compiled import inlined, kernel
from geomdrap.geodesic.mesh import after, in_frame
from geomdrap.geodesic.unfold import (
    ENDED,
    LEFT_THE_PART,
    TIE,
    first_exit,
    is_beyond,
    next_exit,
    shoot,
    step_over,
    turn_at,
)
from geomdrap.geodesic.vertex import go_straight_through, total_angle

ROUNDS = 400
NARROW = 1e-8  # radians: headings this close, of which either asks for the other's side, lie at a vertex
STRAIGHT = 1e-6  # radians by which a side at a vertex may fall short of half a turn of faces on one hand
DONE, NO_VERTEX, TIP = 0, 1, 2
CROSSED = 100_000  # faces after which a side is given up

# columns of ``lines``: the line of a side, its heading as an angle from the first one, and the headings known to lie
# right and left of the one sought
X, Y, DX, DY, LENGTH, TURNED, RIGHT, LEFT = 0, 1, 2, 3, 4, 5, 6, 7


@inlined
def turn_line(lines: np.ndarray, side: int, angle_rad: float) -> None:
    """Turn the departure of a line to the left."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    x, y = lines[side, DX], lines[side, DY]
    lines[side, DX], lines[side, DY] = c * x - s * y, s * x + c * y
    lines[side, TURNED] += angle_rad


@kernel
def vertex_between(
    row: np.ndarray,
    link: np.ndarray,
    face: int,
    line: np.ndarray,
    right: tuple[float, float],
    left: tuple[float, float],
) -> tuple[int, int, float, float, float, float]:
    """Vertex that two lines from one point pass on its right and on its left, before they end.

    ``line`` holds the start and the length, ``right`` and ``left`` unit directions. Returns ``(face, corner, way,
    turn, dx, dy)``: the vertex as a corner of the face before it, how far away it is (mm), the turn (radians) from
    the right line that leads straight to it, and the direction of arrival; face -1 where there is none.
    """
    length = line[LENGTH]
    tie = TIE * length
    ax, ay, bx, by = line[X], line[Y], line[X], line[Y]
    ux, uy, wx, wy = right[0], right[1], left[0], left[1]
    entered = -1
    for _ in range(CROSSED):
        if entered < 0:
            k, m = first_exit(row, face, ax, ay, ux, uy, tie), first_exit(row, face, bx, by, wx, wy, tie)
        else:
            k = next_exit(row, face, entered, ax, ay, ux, uy, tie)
            m = next_exit(row, face, entered, bx, by, wx, wy, tie)
        if k != m:
            corner = m if m == after(k) else k
            vx, vy = row[face, 2 * corner] - ax, row[face, 2 * corner + 1] - ay
            way = math.hypot(vx, vy)
            if not tie < way < length - tie:
                break
            turn = math.atan2(ux * vy - uy * vx, ux * vx + uy * vy)
            return face, corner, way, turn, vx / way, vy / way
        if not is_beyond(row, face, k, ax + length * ux, ay + length * uy, tie) or link[face, k] < 0:
            break
        ax, ay, ux, uy = turn_at(row, face, k, ax, ay, ux, uy)
        bx, by, wx, wy = turn_at(row, face, k, bx, by, wx, wy)
        ax, ay, ux, uy = step_over(row, face, k, ax, ay, ux, uy)
        bx, by, wx, wy = step_over(row, face, k, bx, by, wx, wy)
        entered = link[face, k] & 3
        face = link[face, k] >> 2
    return -1, 0, 0.0, 0.0, 0.0, 0.0


@kernel
def pivot(
    row: np.ndarray, link: np.ndarray, faces: np.ndarray, lines: np.ndarray, left: np.ndarray, side: int
) -> int:
    """Let a side go on from the vertex that its two nearest headings pass on either hand: DONE, NO_VERTEX or TIP.

    A TIP has a positive deficit: no line pivots there. ``left`` (2, 3) keeps the departures from the nodes and the
    half widths (radians) of the wedges behind vertices.
    """
    if left[side, 2] > 0.0:  # once a side: with a second vertex the angles at the first would have to be right, too
        return NO_VERTEX
    headings = np.empty((2, 2))
    for n, at in enumerate((RIGHT, LEFT)):
        turn = lines[side, at] - lines[side, TURNED]
        c, s = math.cos(turn), math.sin(turn)
        x, y = lines[side, DX], lines[side, DY]
        headings[n, 0], headings[n, 1] = c * x - s * y, s * x + c * y
    right, far = (headings[0, 0], headings[0, 1]), (headings[1, 0], headings[1, 1])
    face, corner, way, turn, dx, dy = vertex_between(row, link, faces[side], lines[side], right, far)
    total = total_angle(row, link, face, corner) if face >= 0 else -1.0
    if total < 0.0:
        return NO_VERTEX
    if total <= 2.0 * math.pi:
        return TIP
    beyond, at, ox, oy = go_straight_through(row, link, face, corner, dx, dy)
    c, s = math.cos(turn), math.sin(turn)
    left[side, 0], left[side, 1] = c * right[0] - s * right[1], s * right[0] + c * right[1]
    left[side, 2] = 0.5 * total - math.pi
    faces[side] = beyond
    lines[side, X], lines[side, Y] = row[beyond, 2 * at], row[beyond, 2 * at + 1]
    lines[side, DX], lines[side, DY] = ox, oy
    lines[side, LENGTH] -= way
    lines[side, TURNED], lines[side, RIGHT], lines[side, LEFT] = 0.0, -math.inf, math.inf
    return DONE


@inlined
def improve(
    row: np.ndarray, link: np.ndarray, faces: np.ndarray, lines: np.ndarray, left: np.ndarray, side: int, turn: float
) -> bool:
    """Turn a side as it asks, but not beyond a heading that asked for the way back; pivot where two of them meet.

    True where they meet at the tip of a cone.
    """
    tip = False
    at = RIGHT if turn > 0.0 else LEFT
    here = lines[side, TURNED]
    lines[side, at] = here
    low, high = lines[side, RIGHT], lines[side, LEFT]
    if high <= low:  # the other side has moved on since
        lines[side, LEFT if turn > 0.0 else RIGHT] = math.inf if turn > 0.0 else -math.inf
    elif high - low < NARROW:
        found = pivot(row, link, faces, lines, left, side)
        if found == DONE:
            return False
        tip = found == TIP
        lines[side, RIGHT], lines[side, LEFT] = -math.inf, math.inf
    elif not low < here + turn < high and math.isfinite(high - low):
        turn = 0.5 * (low + high) - here
    turn_line(lines, side, turn)
    return tip


@kernel
def close_round_vertices(  # noqa: PLR0912
    row: np.ndarray,
    link: np.ndarray,
    frames: np.ndarray,
    fb: int,
    xb: float,
    yb: float,
    bx: float,
    by: float,
    lb: float,
    fd: int,
    xd: float,
    yd: float,
    dx: float,
    dy: float,
    ld: float,
    sense: float,
) -> Any:
    """Close a cell whose sides may pivot at vertices; parameters and result are those of ``close_cell``."""
    tolerance = TOLERANCE * max(lb, ld)
    faces = np.array([fb, fd])
    lines = np.array([[xb, yb, bx, by, lb, 0.0, -math.inf, math.inf], [xd, yd, dx, dy, ld, 0.0, -math.inf, math.inf]])
    left = np.zeros((2, 3))
    tip = False
    state, end, cx, cy, nbx, nby, ndx, ndy = NOT_CLOSED, -1, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for n in range(ROUNDS):
        lb, ld = lines[0, LENGTH], lines[1, LENGTH]
        b, d = lines[0], lines[1]
        sb, f, px, py, ux, uy, _, _ = shoot(row, link, faces[0], b[X], b[Y], b[DX], b[DY], lb)
        sd, g, qx, qy, wx, wy, _, _ = shoot(row, link, faces[1], d[X], d[Y], d[DX], d[DY], ld)
        together, qx, qy, wx, wy = moved_into(row, link, g, f, qx, qy, wx, wy)
        if together:
            found, cx, cy = crossing(px, py, lb, qx, qy, ld, sense)
            if not found:
                state = FOLDED
                break
            nbx, nby, ndx, ndy = (cx - px) / lb, (cy - py) / lb, (cx - qx) / ld, (cy - qy) / ld
            turn_b = math.atan2(ux * nby - uy * nbx, ux * nbx + uy * nby)
            turn_d = math.atan2(wx * ndy - wy * ndx, wx * ndx + wy * ndy)
            if max(abs(turn_b) * lb, abs(turn_d) * ld) <= tolerance:
                turn_line(lines, 0, turn_b)
                turn_line(lines, 1, turn_d)
                end, state = f, CLOSED if sb == ENDED and sd == ENDED else OFF_PART
                break
        else:
            if sb == LEFT_THE_PART and sd == LEFT_THE_PART:
                state = OFF_PART
                break
            ex, ey, kx, ky = px + lb * ux, py + lb * uy, qx + ld * wx, qy + ld * wy
            if sb == ENDED and sd == ENDED and apart(frames, f, ex, ey, g, kx, ky) <= MEET * max(lb, ld):
                ndx, ndy = in_frame(frames, g, f, wx, wy)
                end, cx, cy, nbx, nby, state = f, ex, ey, ux, uy, CLOSED
                break
            turn_b, turn_d = meeting_rotation(frames, f, ex, ey, ux, uy, lb, g, kx, ky, wx, wy, ld)
        side = n % 2
        if abs(turn_b) * lb <= 0.1 * tolerance:
            side = 1
        elif abs(turn_d) * ld <= 0.1 * tolerance:
            side = 0
        tip = improve(row, link, faces, lines, left, side, turn_b if side == 0 else turn_d) or tip
    if tip and state == NOT_CLOSED:
        state = FOLDED
    for side in range(2):
        if left[side, 2] > 0.0:
            if abs(lines[side, TURNED]) > left[side, 2] + STRAIGHT and state == CLOSED:
                state = NOT_CLOSED
        else:
            left[side, 0], left[side, 1] = lines[side, DX], lines[side, DY]
    return state, end, cx, cy, left[0, 0], left[0, 1], nbx, nby, left[1, 0], left[1, 1], ndx, ndy
