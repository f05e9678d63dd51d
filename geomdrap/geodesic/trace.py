"""Straightest geodesics on a triangle mesh: where a line from a point in a direction goes, and why it ends."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import TYPE_CHECKING, Any

import numpy as np

from geomdrap.errors import DrapeError
from geomdrap.geodesic.compiled import kernel
from geomdrap.geodesic.mesh import after, mesh_of
from geomdrap.geodesic.unfold import (
    ENDED,
    FACE_LIMIT,
    LEFT_THE_PART,
    TIE,
    TOO_MANY_FACES,
    first_exit,
    is_beyond,
    next_exit,
    step_over,
    turn_at,
)
from geomdrap.geodesic.vertex import go_straight_through

if TYPE_CHECKING:
    from geomdrap.surface import Surface

VERTEX_HIT = 1e-9  # a line this close to a vertex, in shares of the face's first edge, runs through it


class Stop(Enum):
    """Why a line ended."""

    LENGTH = "the length asked for was reached"
    RIM = "the line left the part"
    TOO_LONG = "the line crossed too many faces"


@dataclass(frozen=True)
class Trace:
    """A straightest line on a surface.

    Attributes: end ``face``, ``point`` (3,) mm and unit ``direction`` (3,), tangent to the end face; ``path``
    (k, 3) mm from start to end with a point at each edge that is crossed; ``path_faces`` (k - 1,), the face of
    each piece of it; ``length`` mm; ``stopped``.
    """

    face: int
    point: np.ndarray
    direction: np.ndarray
    path: np.ndarray
    path_faces: np.ndarray
    length: float
    stopped: Stop


@kernel
def vertex_ahead(row: np.ndarray, f: int, x: float, y: float, dx: float, dy: float, length: float) -> int:
    """Corner of face f that a line runs into before it ends, or -1."""
    tolerance = VERTEX_HIT * row[f, 2]
    for k in range(3):
        vx, vy = row[f, 2 * k], row[f, 2 * k + 1]
        way = dx * (vx - x) + dy * (vy - y)
        if tolerance < way < length - tolerance and abs(dx * (vy - y) - dy * (vx - x)) <= tolerance:
            return k
    return -1


@kernel
def follow(
    row: np.ndarray, link: np.ndarray, face: int, x: float, y: float, dx: float, dy: float, length: float
) -> Any:
    """Follow a straightest line and keep its path.

    Returns ``(status, face, x, y, dx, dy, length left, faces, points)``: end face, end point and direction in
    its frame; for each face crossed, its number and the point in its frame where the line leaves it.
    """
    faces = np.empty(64, np.int64)
    points = np.empty((64, 2))
    count = 0
    left = length
    tie = TIE * length
    entered = -1
    for _ in range(FACE_LIMIT):
        if count == len(faces):
            faces = np.concatenate((faces, np.empty_like(faces)))
            points = np.concatenate((points, np.empty_like(points)))
        hit = vertex_ahead(row, face, x, y, dx, dy, left)
        if entered < 0:
            k = first_exit(row, face, x, y, dx, dy, tie)
        else:
            k = next_exit(row, face, entered, x, y, dx, dy, tie)
        if hit < 0 and not is_beyond(row, face, k, x + left * dx, y + left * dy, tie):
            return ENDED, face, x + left * dx, y + left * dy, dx, dy, 0.0, faces[:count], points[:count]
        faces[count] = face
        if hit >= 0:
            vx, vy = row[face, 2 * hit], row[face, 2 * hit + 1]
            left -= dx * (vx - x) + dy * (vy - y)
            points[count] = vx, vy
            onward, at, ndx, ndy = go_straight_through(row, link, face, hit, dx, dy)
            if onward < 0:
                return LEFT_THE_PART, face, vx, vy, dx, dy, left, faces[:count], points[:count]
            face, entered, dx, dy = onward, -1, ndx, ndy
            x, y = row[face, 2 * at], row[face, 2 * at + 1]
            count += 1
            continue
        ax, ay = row[face, 2 * k], row[face, 2 * k + 1]
        ex, ey = row[face, 2 * after(k)] - ax, row[face, 2 * after(k) + 1] - ay
        approach = dx * ey - dy * ex
        along = approach <= TIE * (abs(ex) + abs(ey))  # the line runs along the edge and is on it already
        way = 0.0 if along else max(((ax - x) * ey - (ay - y) * ex) / approach, 0.0)
        points[count] = x + way * dx, y + way * dy
        onward = link[face, k]
        if onward < 0:
            x, y = points[count]
            return LEFT_THE_PART, face, x, y, dx, dy, left - way, faces[:count], points[:count]
        count += 1
        x, y, dx, dy = turn_at(row, face, k, x, y, dx, dy)
        x, y, dx, dy = step_over(row, face, k, x + way * dx, y + way * dy, dx, dy)
        left -= way
        entered = onward & 3
        face = onward >> 2
    return TOO_MANY_FACES, face, x, y, dx, dy, left, faces[:count], points[:count]


def to_plane(surface: Surface, face: int, vector: np.ndarray) -> tuple[float, float]:
    """Components of a 3-D vector in the 2-D frame of a face; the part along the normal is dropped."""
    return float(vector @ surface.e1[face]), float(vector @ surface.e2[face])


def to_space(surface: Surface, faces: np.ndarray, xy: np.ndarray) -> np.ndarray:
    """Points (k, 3) in space of 2-D points (k, 2) in the frames of faces (k,)."""
    return surface.origin[faces] + xy[:, :1] * surface.e1[faces] + xy[:, 1:] * surface.e2[faces]


def trace(
    surface: Surface,
    start: np.ndarray,
    direction: np.ndarray,
    length: float,
    *,
    face: int | None = None,
) -> Trace:
    """Trace a straightest geodesic.

    Parameters: ``start`` (3,) mm, moved to the nearest point of the surface unless its ``face`` is given;
    ``direction`` (3,), its part in the plane of the start face is taken; ``length`` mm, zero or more.
    Raises DrapeError for a negative or infinite length, or a direction along the normal.

    Source: straightest geodesics, K. Polthier and M. Schmies (1998); unfolding after H. Borouchaki and
    A. Cherouat's GeomDrap.
    """
    if not (np.isfinite(length) and length >= 0.0):
        raise DrapeError(f"a geodesic needs a finite length of zero or more, not {length}")
    start = np.asarray(start, dtype=float)
    if start.shape != (3,) or not np.isfinite(start).all():
        raise DrapeError(f"the start of a geodesic must be three finite numbers x, y, z in mm, not {start}")
    if face is None:
        near = surface.nearest(start[None])
        face, start = int(near.face[0]), near.point[0]
    x, y = to_plane(surface, face, start - surface.origin[face])
    dx, dy = to_plane(surface, face, np.asarray(direction, dtype=float))
    norm = float(np.hypot(dx, dy))
    if not norm > 1e-12 * float(np.linalg.norm(direction)):
        raise DrapeError("the direction of a geodesic is zero or along the surface normal; give one that is not")
    mesh = mesh_of(surface)
    status, end, ex, ey, edx, edy, left, faces, points = follow(
        mesh.row, mesh.link, face, x, y, dx / norm, dy / norm, length
    )
    ends = np.append(faces, end)
    inner = to_space(surface, ends, np.vstack([points, [[ex, ey]]]))
    return Trace(
        face=int(end),
        point=inner[-1],
        direction=edx * surface.e1[end] + edy * surface.e2[end],
        path=np.vstack([start, inner]),
        path_faces=ends,
        length=float(length - left),
        stopped={ENDED: Stop.LENGTH, LEFT_THE_PART: Stop.RIM, TOO_MANY_FACES: Stop.TOO_LONG}[status],
    )
