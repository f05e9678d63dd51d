"""The seed: where the ply touches down first, and how its yarns leave from there."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import DrapeError
from geomdrap.fishnet.centroid import on_part
from geomdrap.geodesic.trace import trace
from geomdrap.geodesic.vertex import ALONG_EDGE, fan_start, rim_angle, total_angle, turn_left

if TYPE_CHECKING:
    from collections.abc import Sequence

    from geomdrap.geodesic.mesh import Mesh
    from geomdrap.surface import Surface

    Origin = str | int | Sequence[float] | np.ndarray

AT_VERTEX = 1e-4  # of the face's size: a seed this close to a vertex is on it, as its rounded coordinates are
ALONG_NORMAL = math.cos(math.radians(5.0))  # a reference direction this close to the normal gives no heading


@dataclass(frozen=True)
class Seed:
    """Origin of the net: ``face``, ``point`` (3,) mm, unit ``normal``, ``warp`` and ``weft`` (3,) there.

    ``starts`` (4,) and ``places`` (4, 4) are the faces, plane points and plane directions with which the
    half-axes +u, +v, -u, -v leave.
    """

    face: int
    point: np.ndarray
    normal: np.ndarray
    warp: np.ndarray
    weft: np.ndarray
    starts: np.ndarray
    places: np.ndarray


def locate(surface: Surface, origin: Origin) -> tuple[int, np.ndarray, float]:
    """Face, point (3,) on the surface and distance (mm) of an origin: ``centroid``, a point or a vertex number.

    Raises DrapeError where the origin cannot be read, and for a vertex that the part does not have.
    """
    if isinstance(origin, str) and origin != "centroid":
        match = re.fullmatch(r"vertex:(\d+)", origin.strip())
        if not match:
            raise DrapeError(f"origin {origin!r} is not 'centroid', 'vertex:NUMBER' or three coordinates x, y, z")
        origin = int(match[1])
    if isinstance(origin, (int, np.integer)):
        return _vertex(surface, int(origin))
    target = on_part(surface) if isinstance(origin, str) else _vector(origin)
    if target.shape != (3,) or not np.isfinite(target).all():
        raise DrapeError(f"origin {origin} is not three finite numbers x, y, z in mm")
    if np.abs(target).max() > 1e6 * max(float(np.abs(surface.bounds).max()), surface.diagonal):
        raise DrapeError(f"origin {origin} lies nowhere near {surface.source}; check its unit (mm)")
    near = surface.nearest(target[None])
    away = surface.centroid if isinstance(origin, str) else target
    return int(near.face[0]), near.point[0], float(np.linalg.norm(near.point[0] - away))


def _vector(numbers: object) -> np.ndarray:
    """An array of floats; empty where these are no numbers, which no later check accepts."""
    try:
        return np.asarray(numbers, dtype=float)
    except (TypeError, ValueError):
        return np.empty(0)


def _vertex(surface: Surface, number: int) -> tuple[int, np.ndarray, float]:
    known = surface.vertex_of_input
    vertex = int(known[number]) if 0 <= number < len(known) else -1
    faces = np.flatnonzero((surface.triangles == vertex).any(axis=1)) if vertex >= 0 else np.array([], int)
    if len(faces) == 0:
        raise DrapeError(f"{surface.source} has no vertex {number} on a face; vertices are 0 to {len(known) - 1}")
    return int(faces[0]), surface.points[vertex], 0.0


def heading_frame(normal: np.ndarray, reference: Sequence[float] | None) -> np.ndarray:
    """Unit reference direction (3,) in the plane across ``normal``: the part's +x, or +y where x is along it.

    Raises DrapeError for a reference direction of the user's that is zero or within 5° of the normal.
    """
    for direction in [np.eye(3)[0], np.eye(3)[1]] if reference is None else [_vector(reference)]:
        norm = np.linalg.norm(direction)
        if direction.shape != (3,) or not (np.isfinite(norm) and norm > 0.0):
            raise DrapeError(f"reference direction {reference} is not three numbers that point somewhere")
        if abs(direction @ normal) < ALONG_NORMAL * norm:
            flat = direction - (direction @ normal) * normal
            return flat / np.linalg.norm(flat)
    raise DrapeError("the reference direction is within 5° of the surface normal at the origin; choose another")


def plant(
    surface: Surface,
    point: np.ndarray,
    angle: float,
    mesh: Mesh,
    reference: Sequence[float] | None = None,
    weft_angle: float = 90.0,
) -> Seed:
    """Seed at a point (3,) of the surface, the warp at ``angle`` degrees, the weft ``weft_angle`` degrees beyond.

    On a vertex, or as close to one as written coordinates are, the four half-axes share the angles of its faces in
    proportion, so that opposite ones are one straightest line.
    """
    face, point, _ = locate(surface, point)
    vertex = _corner_at(surface, face, point)
    fan = (mesh.row, mesh.link, face, vertex)
    around = total_angle(*fan) if vertex >= 0 else -1.0
    normal = surface.normals[face]
    if around > 0.0:
        point = surface.points[surface.triangles[face, vertex]]
        normal = surface.lidded.vertex_normals[surface.triangles[face, vertex]]
    across = heading_frame(normal, reference)
    beside = np.cross(normal, across)
    headings_rad = np.radians(angle + np.array([0.0, weft_angle, 180.0, 180.0 + weft_angle]))
    directions = np.cos(headings_rad)[:, None] * across + np.sin(headings_rad)[:, None] * beside
    starts, places = np.full(4, face), np.empty((4, 4))
    if around > 0.0:
        base_rad = _angle_in_fan(surface.lidded, face, vertex, normal, directions[0], around)
        for a in range(4):
            turn = base_rad + (headings_rad[a] - headings_rad[0]) * around / (2.0 * math.pi)
            turn %= around
            start, at, dx, dy = turn_left(*fan, turn if turn < around - ALONG_EDGE else 0.0)
            starts[a], places[a] = start, (*mesh.row[start, 2 * at : 2 * at + 2], dx, dy)
    else:
        frame = np.array([surface.e1[face], surface.e2[face]])
        places[:, :2] = frame @ (point - surface.origin[face])
        places[:, 2:] = directions @ frame.T
        places[:, 2:] /= np.linalg.norm(places[:, 2:], axis=1, keepdims=True)
    return Seed(face, point, normal, directions[0], directions[1], starts, places)


def out_of_corner(
    surface: Surface, origin: Origin, point: np.ndarray, mesh: Mesh, pitch: float
) -> tuple[np.ndarray, tuple[str, ...]]:
    """The centroid, moved inward where it lies on a corner of the rim too narrow for two yarns at right angles.

    It goes straight along the middle of the corner by a pitch, or half way through the part where that is less.
    Returns the point (3,) and a note if it was moved. A seed of the user's own is left where it is.
    """
    if not (isinstance(origin, str) and origin == "centroid"):
        return point, ()
    face, point, _ = locate(surface, point)
    corner = _corner_at(surface, face, point)
    if corner < 0 or total_angle(mesh.row, mesh.link, face, corner) >= 0.0:
        return point, ()
    first, at, _ = fan_start(mesh.row, mesh.link, face, corner)
    opening = rim_angle(mesh.row, mesh.link, first, at)
    if opening >= 0.5 * math.pi:
        return point, ()
    face, at, dx, dy = turn_left(mesh.row, mesh.link, first, at, 0.5 * opening)
    middle = dx * surface.e1[face] + dy * surface.e2[face]
    way = trace(surface, point, middle, pitch, face=face).length
    moved = trace(surface, point, middle, way if way == pitch else 0.5 * way, face=face)
    note = f"the centroid lies on a narrow corner of the rim: the origin was moved {moved.length:.4g} mm inward"
    return moved.point, (note,)


def _corner_at(surface: Surface, face: int, point: np.ndarray) -> int:
    """Corner of the face that the point lies on, or -1."""
    away = np.linalg.norm(surface.points[surface.triangles[face]] - point, axis=1)
    nearest = int(away.argmin())
    return nearest if away[nearest] <= AT_VERTEX * math.sqrt(surface.areas[face]) else -1


def _angle_in_fan(
    surface: Surface, face: int, at: int, normal: np.ndarray, direction: np.ndarray, around: float
) -> float:
    """Angle in the faces (radians) from the fan's first edge to a direction of the tangent plane.

    Seen along the normal the fan's edges cut the tangent plane into sectors; a sector is stretched evenly on its
    face, and all of them together to the angle that the faces have.
    """
    seen: list[float] = []
    real: list[float] = []
    here, k = face, at
    while True:
        corners = surface.points[surface.triangles[here]]
        first, second = corners[(k + 1) % 3] - corners[k], corners[(k + 2) % 3] - corners[k]
        seen.append(
            math.atan2(
                normal @ np.cross(direction, first),
                direction @ first - (direction @ normal) * (normal @ first),
            )
        )
        real.append(math.atan2(float(np.linalg.norm(np.cross(first, second))), float(first @ second)))
        over = (k + 2) % 3
        k, here = int(surface.neighbour_edge[here, over]), int(surface.neighbours[here, over])
        if here == face and k == at:
            break
    sectors = np.diff([*seen, seen[0]]) % (2.0 * math.pi)
    before = np.concatenate([[0.0], np.cumsum(real)])
    for n, sector in enumerate(sectors):
        into = -seen[n] % (2.0 * math.pi)  # from edge n, counter-clockwise, to the direction at angle 0
        if into <= sector:
            return float(before[n] + (into / sector if sector > 0.0 else 0.0) * real[n]) % around
    return 0.0
