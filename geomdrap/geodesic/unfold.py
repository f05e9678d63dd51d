"""Walking straight across unfolded triangles: the innermost loop of everything that drapes.

A face carries its own 2-D frame. A straight line that leaves a face is continued by turning the line, not the
mesh: its start point P and direction d are moved into the frame of the next face, where they are the *image* of the
start in the plane of that face. The end point is then simply P + length·d, however many faces lie between, and
nothing is accumulated on the way.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from geomdrap.geodesic.compiled import inlined, tight
from geomdrap.geodesic.mesh import BEND, CROSS, after, before

ENDED = 0
LEFT_THE_PART = 1
TOO_MANY_FACES = 2

# Face numbers masked with this are known to the compiler not to be negative, so that it need not check whether an
# index counts from the end of an array; that check would cost a third of the walk.
NO_SIGN = 0x3FFFFFFF

# Of the length of a line: what is nearer than this to a corner, an edge or the rim counts as on it; a line through
# a corner passes it on the same side every time. Rounding must not decide: on meshes with rows of facets lines run
# along edges and through corners all the time, and the same part in metres, or on another machine, has other digits.
TIE = 1e-9

# For each of the eight ways in which the corners of a face lie left or right of a line, two bits: the edge that
# begins right of it and ends left, 3 where there is none. A table, because the branches could not be predicted.
EXIT_OF_CODE = 0xC58B

FACE_LIMIT = 10_000_000  # crossed faces after which a line is called endless


@inlined
def side_of(row: np.ndarray, f: int, k: int, x: float, y: float, dx: float, dy: float) -> float:
    """Distance of corner k of face f to the left of a line."""
    return dx * (row[f, 2 * k + 1] - y) - dy * (row[f, 2 * k] - x)


@inlined
def step_over(
    row: np.ndarray, f: int, k: int, x: float, y: float, dx: float, dy: float
) -> tuple[float, float, float, float]:
    """Move a point and a direction over edge k of face f into the frame of the neighbour."""
    at = CROSS + 4 * k
    c, s = row[f, at], row[f, at + 1]
    return c * x - s * y + row[f, at + 2], s * x + c * y + row[f, at + 3], c * dx - s * dy, s * dx + c * dy


@tight
def first_exit_at_rim(row: np.ndarray, f: int, x: float, y: float, dx: float, dy: float) -> int:
    """Exit edge for a start on a corner or outside the face: the nearest edge that the line approaches."""
    best = -1
    best_way = np.inf
    for k in range(3):
        ax, ay = row[f, 2 * k], row[f, 2 * k + 1]
        ex, ey = row[f, 2 * after(k)] - ax, row[f, 2 * after(k) + 1] - ay
        approach = dx * ey - dy * ex
        if approach > TIE * (abs(ex) + abs(ey)):
            way = max(((ax - x) * ey - (ay - y) * ex) / approach, 0.0)
            if way < best_way:
                best_way = way
                best = k
    return best


@inlined
def first_exit(row: np.ndarray, f: int, x: float, y: float, dx: float, dy: float, tie: float) -> int:
    """Edge through which a line from a point in (or on the rim of) face f leaves it.

    That edge begins right of the line and ends left of it.
    """
    code = (
        (side_of(row, f, 0, x, y, dx, dy) > tie) * 2
        + (side_of(row, f, 1, x, y, dx, dy) > tie) * 4
        + (side_of(row, f, 2, x, y, dx, dy) > tie) * 8
    )
    k = (EXIT_OF_CODE >> code) & 3
    return k if k < 3 else first_exit_at_rim(row, f, x, y, dx, dy)


@inlined
def next_exit(row: np.ndarray, f: int, entered: int, x: float, y: float, dx: float, dy: float, tie: float) -> int:
    """Edge through which a line leaves a face that it entered over edge ``entered``."""
    if side_of(row, f, before(entered), x, y, dx, dy) > tie:
        return after(entered)
    return before(entered)


@inlined
def is_beyond(row: np.ndarray, f: int, k: int, x: float, y: float, tie: float) -> bool:
    """Whether a point lies on the far side of edge k of face f, by more than a tie."""
    ax, ay = row[f, 2 * k], row[f, 2 * k + 1]
    ex, ey = row[f, 2 * after(k)] - ax, row[f, 2 * after(k) + 1] - ay
    return ex * (y - ay) - ey * (x - ax) < -tie * (abs(ex) + abs(ey))


@inlined
def other_exit(row: np.ndarray, f: int, k: int, entered: int, x: float, y: float, tie: float) -> int:
    """The edge that a point on this side of edge k lies beyond all the same, or -1.

    That happens where a line runs along edge k and out over its corner, so that it never crosses that edge.
    """
    one, two = after(k), before(k)
    if one != entered and is_beyond(row, f, one, x, y, tie):
        return one
    if two != entered and is_beyond(row, f, two, x, y, tie):
        return two
    return -1


@inlined
def turn_at(
    row: np.ndarray, f: int, k: int, x: float, y: float, dx: float, dy: float
) -> tuple[float, float, float, float]:
    """Turn a line about the point where it crosses edge k by what ``bends`` says; its start turns with it."""
    start, fall = row[f, BEND + 2 * k], row[f, BEND + 2 * k + 1]
    if start == 0.0 and fall == 0.0:
        return x, y, dx, dy
    right = side_of(row, f, k, x, y, dx, dy)
    across = side_of(row, f, after(k), x, y, dx, dy) - right
    ax, ay = row[f, 2 * k], row[f, 2 * k + 1]
    bx, by = row[f, 2 * after(k)] - ax, row[f, 2 * after(k) + 1] - ay
    # a line that grazes the edge must not be turned back over it, and one along it crosses it nowhere in particular
    most = 0.25 * across / (abs(bx) + abs(by))
    if most <= TIE:
        return x, y, dx, dy
    t = min(max(-right / across, 0.0), 1.0)
    half = min(max(0.5 * (start - t * fall), -most), most)
    h2 = half * half
    # the rotation with tan(angle / 2) = half is a unit vector exactly, so that lines keep their length
    scale = 1.0 - h2 * (1.0 - h2) if h2 < 1e-6 else 1.0 / (1.0 + h2)
    c, s = (1.0 - h2) * scale, 2.0 * half * scale
    ex, ey = ax + t * bx, ay + t * by
    px, py = x - ex, y - ey
    return ex + c * px - s * py, ey + s * px + c * py, c * dx - s * dy, s * dx + c * dy


@tight
def shoot(
    row: np.ndarray, link: np.ndarray, face: int, x: float, y: float, dx: float, dy: float, length: float
) -> Any:
    """Follow the straightest line of a given length; a vertex that is hit is passed on its right.

    Parameters: ``row`` and ``link`` of a Mesh; face and 2-D start (x, y) with unit direction (dx, dy) in its
    frame, length in mm.
    Returns ``(status, face, x, y, dx, dy, clear, fall)``: the end face and the images of start and direction in its
    frame, so that the end point is ``(x + length·dx, y + length·dy)``; how far the line stays clear of the corners
    between which it passes, mm; and by how much, at most, ``bends`` turn it for each mm that it moves sideways,
    rad/mm. Where the line leaves the part, the status says so and the end point lies in the plane of the last face,
    beyond its rim.
    """
    face &= NO_SIGN
    tie = TIE * length
    k = first_exit(row, face, x, y, dx, dy, tie)
    entered = -1
    clear, fall = np.inf, 0.0
    for _ in range(FACE_LIMIT):
        ex, ey = x + length * dx, y + length * dy
        if not is_beyond(row, face, k, ex, ey, tie):
            other = other_exit(row, face, k, entered, ex, ey, tie)
            if other < 0:
                return ENDED, face, x, y, dx, dy, clear, fall
            k = other
        onward = link[face, k]
        if onward < 0:
            return LEFT_THE_PART, face, x, y, dx, dy, clear, fall
        left, right = side_of(row, face, after(k), x, y, dx, dy), -side_of(row, face, k, x, y, dx, dy)
        clear = min(clear, left, right)
        fall += abs(row[face, BEND + 2 * k + 1]) / (left + right)
        x, y, dx, dy = turn_at(row, face, k, x, y, dx, dy)
        x, y, dx, dy = step_over(row, face, k, x, y, dx, dy)
        face = (onward >> 2) & NO_SIGN
        entered = onward & 3
        k = next_exit(row, face, entered, x, y, dx, dy, tie)
    return TOO_MANY_FACES, face, x, y, dx, dy, clear, fall
