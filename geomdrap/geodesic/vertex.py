"""Directions around a vertex: how a straightest line goes on, and how a heading leaves, where faces meet."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from geomdrap.geodesic.compiled import kernel
from geomdrap.geodesic.mesh import after, before

FAN_LIMIT = 100_000
ALONG_EDGE = 1e-9  # radians: a direction this close to an edge is along it, in the face before it
ALONG_RIM = 1e-7  # radians by which a line along the rim may point out of the part


@kernel
def wedge(row: np.ndarray, f: int, at: int) -> tuple[float, float, float]:
    """Unit direction from corner ``at`` of face f to the next corner, and the interior angle there (radians)."""
    x, y = row[f, 2 * at], row[f, 2 * at + 1]
    px, py = row[f, 2 * after(at)] - x, row[f, 2 * after(at) + 1] - y
    qx, qy = row[f, 2 * before(at)] - x, row[f, 2 * before(at) + 1] - y
    length = math.hypot(px, py)
    return px / length, py / length, math.atan2(px * qy - py * qx, px * qx + py * qy)


@kernel
def total_angle(row: np.ndarray, link: np.ndarray, face: int, at: int) -> float:
    """Sum of the face angles around an interior vertex (radians); -1 at a vertex of the rim."""
    total = 0.0
    here, k = face, at
    for _ in range(FAN_LIMIT):
        total += wedge(row, here, k)[2]
        onward = link[here, before(k)]
        if onward < 0:
            return -1.0
        here, k = onward >> 2, onward & 3
        if here == face and k == at:
            return total
    return -1.0


@kernel
def turn_left(row: np.ndarray, link: np.ndarray, face: int, at: int, angle_rad: float) -> Any:
    """Turn counter-clockwise about corner ``at``, from its first edge, by an angle measured in the faces.

    Returns ``(face, corner, dx, dy)`` of the direction reached; face -1 where the rim is in the way.
    """
    here, k = face, at
    left = angle_rad
    for _ in range(FAN_LIMIT):
        dx, dy, opening = wedge(row, here, k)
        onward = link[here, before(k)]
        if left <= opening + (ALONG_RIM if onward < 0 else ALONG_EDGE):
            c, s = math.cos(left), math.sin(left)
            return here, k, c * dx - s * dy, s * dx + c * dy
        if onward < 0:
            return -1, k, dx, dy
        left -= opening
        here, k = onward >> 2, onward & 3
    return -1, k, dx, dy


@kernel
def fan_start(row: np.ndarray, link: np.ndarray, face: int, at: int) -> tuple[int, int, float]:
    """First face and corner of the fan around a vertex of the rim, and the angle (radians) from there to ``face``."""
    here, k, angle = face, at, 0.0
    for _ in range(FAN_LIMIT):
        onward = link[here, k]
        if onward < 0:
            break
        here, k = onward >> 2, after(onward & 3)
        angle += wedge(row, here, k)[2]
    return here, k, angle


@kernel
def rim_angle(row: np.ndarray, link: np.ndarray, face: int, at: int) -> float:
    """Sum of the face angles (radians) around a vertex of the rim, from the first face of its fan (``fan_start``)."""
    total = 0.0
    here, k = face, at
    for _ in range(FAN_LIMIT):
        total += wedge(row, here, k)[2]
        onward = link[here, before(k)]
        if onward < 0:
            break
        here, k = onward >> 2, onward & 3
    return total


@kernel
def go_straight_through(row: np.ndarray, link: np.ndarray, face: int, at: int, dx: float, dy: float) -> Any:
    """Continue a line that runs into corner ``at`` so that the angles on its two sides are equal.

    This is the straightest geodesic of Polthier and Schmies (1998). At a vertex of the rim the side that has a half
    turn of faces decides, the left one first; where neither has, the line ends. Returns as ``turn_left``.
    """
    total = total_angle(row, link, face, at)
    ex, ey, _ = wedge(row, face, at)
    back = math.atan2(ex * -dy - ey * -dx, ex * -dx + ey * -dy)
    if total >= 0.0:
        ahead = (back + 0.5 * total) % total
        return turn_left(row, link, face, at, ahead if ahead < total - ALONG_EDGE else 0.0)
    onward, k, ox, oy = turn_left(row, link, face, at, back + math.pi)
    if onward >= 0:
        return onward, k, ox, oy
    first, k, angle = fan_start(row, link, face, at)
    behind = angle + back - math.pi
    if behind < -ALONG_RIM:
        return -1, at, dx, dy
    return turn_left(row, link, first, k, max(behind, 0.0))
