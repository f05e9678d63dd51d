"""The fourth corner of a cell: where two geodesics of given length, from B and from D, end in one point C.

Unfolded into the plane of the face where they end, both lines are straight, so C is the crossing of two circles
around the images of B and D: no derivative is needed and one correction is exact as long as the lines cross the
same faces. Where they end in faces that do not touch, a Newton step in space with the exact derivative
dC/dθ = length·(normal × direction) brings them together first.

After the equilateral cell of F. Trochu et al. and of H. Borouchaki and A. Cherouat's GeomDrap (modified MOSAIC).
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from geomdrap.geodesic.compiled import inlined, tight
from geomdrap.geodesic.mesh import in_frame, in_space
from geomdrap.geodesic.unfold import ENDED, LEFT_THE_PART, TIE, is_beyond, shoot, step_over

CLOSED = 0
OFF_PART = 1
FOLDED = 2
NOT_CLOSED = 3

# Of the side: distance between the ends of the two lines before the last correction. The correction leaves its
# square, and its product with the bends on the way: 1e-8 of the side on a fine mesh, 1e-6 on a very coarse one.
TOLERANCE = 1e-5
# Of the side: where the corrected lines cross the same edges, and end in the same face, only the bends on the way
# differ for them; with those changing by less than this the next round would find nothing to correct.
SETTLED = 5e-9
MEET = 1e-7  # of the side: ends this close that lie in faces which do not touch are one
ROUNDS = 24
TOGETHER = 6  # rounds in which both lines are turned at once


@inlined
def crossing(
    bx: float, by: float, lb: float, dx: float, dy: float, ld: float, sense: float
) -> tuple[bool, float, float]:
    """Crossing of the circles (B, lb) and (D, ld) for which B, C, D turn counter-clockwise (sense > 0)."""
    ex, ey = dx - bx, dy - by
    apart2 = ex * ex + ey * ey
    if apart2 <= 1e-24 * lb * lb:
        return False, 0.0, 0.0
    along = 0.5 * (apart2 + lb * lb - ld * ld) / apart2
    height2 = lb * lb / apart2 - along * along
    if height2 <= 0.0:
        return False, 0.0, 0.0
    height = sense * math.sqrt(height2)
    return True, bx + along * ex + height * ey, by + along * ey - height * ex


@inlined
def is_inside(row: np.ndarray, f: int, x: float, y: float, tie: float) -> bool:
    """Whether a point lies on face f."""
    return not (is_beyond(row, f, 0, x, y, tie) or is_beyond(row, f, 1, x, y, tie) or is_beyond(row, f, 2, x, y, tie))


@inlined
def moved_into(
    row: np.ndarray, link: np.ndarray, g: int, f: int, x: float, y: float, dx: float, dy: float
) -> tuple[bool, float, float, float, float]:
    """A point and a direction of face g in the frame of face f, where that is the same or touches it."""
    together = f == g
    for k in range(3):
        if not together and link[g, k] >= 0 and link[g, k] >> 2 == f:
            x, y, dx, dy = step_over(row, g, k, x, y, dx, dy)
            together = True
    return together, x, y, dx, dy


@inlined
def apart(frames: np.ndarray, f: int, x: float, y: float, g: int, p: float, q: float) -> float:
    """Distance in space of two points in the frames of two faces, mm."""
    ax, ay, az = in_space(frames, f, x, y)
    bx, by, bz = in_space(frames, g, p, q)
    return math.sqrt((ax - bx) ** 2 + (ay - by) ** 2 + (az - bz) ** 2)


@tight
def meeting_rotation(
    frames: np.ndarray,
    f: int,
    x: float,
    y: float,
    dx: float,
    dy: float,
    lb: float,
    g: int,
    p: float,
    q: float,
    ex: float,
    ey: float,
    ld: float,
) -> tuple[float, float]:
    """Least-squares rotations (radians) of two lines that bring their ends together in space.

    A line ends in face f at (x, y) with direction (dx, dy); its end moves by lb·(-dy, dx) per radian.
    """
    aa = ab = bb = ar = br = 0.0
    for k in range(3):
        end_b = frames[f, k] + x * frames[f, 3 + k] + y * frames[f, 6 + k]
        end_d = frames[g, k] + p * frames[g, 3 + k] + q * frames[g, 6 + k]
        a = lb * (dx * frames[f, 6 + k] - dy * frames[f, 3 + k])
        b = -ld * (ex * frames[g, 6 + k] - ey * frames[g, 3 + k])
        r = end_d - end_b
        aa += a * a
        ab += a * b
        bb += b * b
        ar += a * r
        br += b * r
    det = aa * bb - ab * ab
    if det <= 1e-12 * aa * bb:
        return 0.0, 0.0
    turn_b, turn_d = (bb * ar - ab * br) / det, (aa * br - ab * ar) / det
    return min(max(turn_b, -0.5), 0.5), min(max(turn_d, -0.5), 0.5)


@tight
def close_cell(
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
    """Close one cell.

    Parameters: ``row``, ``link``, ``frames`` of a Mesh; for B and for D a face, the point in its frame, a first
    guess of the unit direction toward C and the length of the side (mm); ``sense`` is +1 where B, C, D turn
    counter-clockwise, else -1.
    Returns ``(status, face, x, y, dep_b (2), arr_b (2), dep_d (2), arr_d (2))`` flat: C and the directions in
    which the two sides leave B and D and arrive at C.
    """
    tolerance = TOLERANCE * max(lb, ld)
    for n in range(ROUNDS):
        sb, f, px, py, ux, uy, clear, fall = shoot(row, link, fb, xb, yb, bx, by, lb)
        sd, g, qx, qy, wx, wy, clear_d, fall_d = shoot(row, link, fd, xd, yd, dx, dy, ld)
        clear, fall = min(clear, clear_d) if f == g else -1.0, max(fall, fall_d)
        together, qx, qy, wx, wy = moved_into(row, link, g, f, qx, qy, wx, wy)
        if together:
            found, cx, cy = crossing(px, py, lb, qx, qy, ld, sense)
            if not found:
                return FOLDED, -1, 0.0, 0.0, bx, by, ux, uy, dx, dy, wx, wy
            nbx, nby = (cx - px) / lb, (cy - py) / lb
            ndx, ndy = (cx - qx) / ld, (cy - qy) / ld
            miss = max(abs(nbx - ux), abs(nby - uy)) * lb
            miss = max(miss, max(abs(ndx - wx), abs(ndy - wy)) * ld)
            # Turn the departures as much as the arrivals have to turn; one at a time where both keep changing
            # sides of a vertex together. Dividing by the old direction's square keeps all of them unit vectors.
            both = n < TOGETHER
            if both or n % 2 == 0:
                square = ux * ux + uy * uy
                c, s = (nbx * ux + nby * uy) / square, (nby * ux - nbx * uy) / square
                bx, by = c * bx - s * by, s * bx + c * by
            if both or n % 2 == 1:
                square = wx * wx + wy * wy
                c, s = (ndx * wx + ndy * wy) / square, (ndy * wx - ndx * wy) / square
                dx, dy = c * dx - s * dy, s * dx + c * dy
            settled = 2.0 * miss <= clear and miss * fall <= SETTLED and sb == ENDED and sd == ENDED
            if miss <= tolerance or (settled and is_inside(row, f, cx, cy, TIE * lb)):
                state = CLOSED if sb == ENDED and sd == ENDED else OFF_PART
                return state, f, cx, cy, bx, by, nbx, nby, dx, dy, ndx, ndy
        else:
            if sb == LEFT_THE_PART and sd == LEFT_THE_PART:
                return OFF_PART, -1, 0.0, 0.0, bx, by, ux, uy, dx, dy, wx, wy
            ex, ey, kx, ky = px + lb * ux, py + lb * uy, qx + ld * wx, qy + ld * wy
            if sb == ENDED and sd == ENDED and apart(frames, f, ex, ey, g, kx, ky) <= MEET * max(lb, ld):
                wx, wy = in_frame(frames, g, f, wx, wy)  # both end at a vertex, in faces across it
                return CLOSED, f, ex, ey, bx, by, ux, uy, dx, dy, wx, wy
            turn_b, turn_d = meeting_rotation(frames, f, ex, ey, ux, uy, lb, g, kx, ky, wx, wy, ld)
            c, s = math.cos(turn_b), math.sin(turn_b)
            bx, by = c * bx - s * by, s * bx + c * by
            c, s = math.cos(turn_d), math.sin(turn_d)
            dx, dy = c * dx - s * dy, s * dx + c * dy
    state = NOT_CLOSED if sb == ENDED and sd == ENDED else OFF_PART
    return state, -1, 0.0, 0.0, bx, by, ux, uy, dx, dy, wx, wy
