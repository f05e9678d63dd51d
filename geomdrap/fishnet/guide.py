"""Generators that are steered along curves on the part, in place of geodesics.

A generator is a chain of straight sides. To follow a curve it turns at each node by what brings the next node onto
the curve again: found by shooting the side, looking where the curve is nearest to its end, and turning there, until
the two agree.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import DrapeError
from geomdrap.geodesic.mesh import in_space, normal_of
from geomdrap.geodesic.trace import follow
from geomdrap.geodesic.unfold import ENDED

if TYPE_CHECKING:
    from collections.abc import Sequence

    from geomdrap.geodesic.mesh import Mesh
    from geomdrap.surface import Surface

FINE = 0.1  # cells between the points of a curve when it is laid onto the part
ROUNDS, AGREES_RAD, NEARLY_RAD = 60, 1e-10, 1e-4
SHARPEST_RAD = math.radians(60.0)  # turn at a node beyond which a curve bends too tightly for the pitch
TO_AND_FRO = 200
WINDOW = 2.0  # sides ahead in which the curve is looked for


@dataclass(frozen=True, eq=False)
class Curve:
    """A curve on the part: points (k, 3) mm, ``along`` (k,) the distance of each from the first, mm."""

    points: np.ndarray
    along: np.ndarray

    def nearest(self, point: np.ndarray, low: float, high: float) -> tuple[np.ndarray, float]:
        """The point (3,) of the curve nearest to a point, between two distances along it, and its distance along."""
        first = max(int(np.searchsorted(self.along, low, "right")) - 1, 0)
        last = min(int(np.searchsorted(self.along, high, "left")), len(self.along) - 1)
        a, b = self.points[first:last], self.points[first + 1 : last + 1]
        way = b - a
        share = np.clip(((point - a) * way).sum(axis=1) / (way * way).sum(axis=1), 0.0, 1.0)
        foot = a + share[:, None] * way
        k = int(np.linalg.norm(foot - point, axis=1).argmin())
        start, end = self.along[first + k], self.along[first + k + 1]
        return foot[k], float(start + share[k] * (end - start))

    @property
    def length(self) -> float:
        """Its length, mm."""
        return float(self.along[-1])

    def tangent(self, at: float) -> np.ndarray:
        """Unit direction (3,) of the curve at a distance along it."""
        k = min(max(int(np.searchsorted(self.along, at, "right")), 1), len(self.along) - 1)
        way = self.points[k] - self.points[k - 1]
        return np.asarray(way / np.linalg.norm(way))


def curve_on(
    part: Surface, points: Sequence[Sequence[float]] | np.ndarray, name: str, pitch: float, project: bool
) -> Curve:
    """A curve through points (k, 3) mm, laid onto the part; ``name`` is how messages call it.

    Raises DrapeError for fewer than two points, and where it lies further than a pitch from the part, unless
    ``project`` is set.
    """
    try:
        given = np.asarray(points, dtype=float)
    except (TypeError, ValueError):
        given = np.empty(0)
    if given.ndim != 2 or given.shape[1] != 3 or not np.isfinite(given).all():
        raise DrapeError(f"{name} must be points (k, 3) in mm, finite numbers x, y, z")
    steps = np.linalg.norm(np.diff(given, axis=0), axis=1)
    given = given[np.concatenate([[True], steps > 0.0])]
    if len(given) < 2:
        raise DrapeError(f"{name} must have two different points at least")
    steps = np.linalg.norm(np.diff(given, axis=0), axis=1)
    at = np.concatenate([[0.0], np.cumsum(steps)])
    fine = np.union1d(at, np.linspace(0.0, at[-1], max(2, math.ceil(at[-1] / (FINE * pitch)))))
    dense = np.column_stack([np.interp(fine, at, x) for x in given.T])
    near = part.nearest(dense)
    far = np.flatnonzero(near.distance > pitch)
    if len(far) and not project:
        x, y, z = dense[far[0]]
        raise DrapeError(
            f"{name} leaves {part.source}: at ({x:.6g}, {y:.6g}, {z:.6g}) it lies {near.distance[far[0]]:.4g} mm "
            f"off, more than the pitch of {pitch:.4g} mm; move it, or allow the nearest points with --project "
            "(project=True)"
        )
    moved = np.linalg.norm(np.diff(near.point, axis=0), axis=1)
    on_part = near.point[np.concatenate([[True], moved > 1e-9 * pitch])]
    if len(on_part) < 2:
        raise DrapeError(f"{name} comes to a single point when it is laid onto {part.source}; use another curve")
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(on_part, axis=0), axis=1))])
    return Curve(on_part, along)


def crossing(warp: Curve, weft: Curve, pitch: float) -> np.ndarray:
    """The point (3,) where two curves meet. Raises DrapeError where they do not come within a pitch of each other."""
    from scipy.spatial import cKDTree

    away, k = (np.asarray(found) for found in cKDTree(weft.points).query(warp.points))
    first = int(away.argmin())
    if away[first] > pitch:
        raise DrapeError(
            f"the warp guide and the weft guide do not cross: they stay {away[first]:.4g} mm apart; the ply is laid "
            "from where they do"
        )
    foot = weft.points[int(k[first])]
    for _ in range(TO_AND_FRO):  # the way to the crossing shrinks by cos² of the angle between them each time
        foot = warp.nearest(foot, 0.0, warp.length)[0]
        foot = weft.nearest(foot, 0.0, weft.length)[0]
    return foot


def turns_along(
    mesh: Mesh, curve: Curve, face: int, place: np.ndarray, sides: np.ndarray, sense: int, name: str
) -> np.ndarray:
    """Turns (n,) to the left, radians, with which a half-axis of ``sides`` (n,) mm follows a curve.

    It leaves the point ``place[:2]`` of a face's plane in the direction ``place[2:]`` and follows the curve in its
    sense (1) or against it (-1); past the end of the curve, and past the rim, it goes straight on. The first turn is
    at the seed.
    Raises DrapeError where the curve bends more tightly than the sides can follow.
    """
    turns = np.zeros(len(sides))
    x, y, dx, dy = (float(c) for c in place)
    seed = np.array(in_space(mesh.frames, face, x, y))
    _, at = curve.nearest(seed, 0.0, curve.length)
    for n, side in enumerate(sides):
        turn, end, at = _next_turn(mesh, curve, (face, x, y, dx, dy), float(side), at, sense)
        if end is None:
            break
        if not abs(turn) <= SHARPEST_RAD:
            px, py, pz = in_space(mesh.frames, face, x, y)
            raise DrapeError(
                f"{name} bends too tightly for a pitch of {side:.4g} mm at ({px:.6g}, {py:.6g}, {pz:.6g}); use a "
                "smaller pitch, or a smoother curve"
            )
        turns[n] = turn
        face, x, y, dx, dy = end
    return turns


def _next_turn(
    mesh: Mesh, curve: Curve, ray: tuple[int, float, float, float, float], side: float, at: float, sense: int
) -> tuple[float, tuple[int, float, float, float, float] | None, float]:
    """The turn that brings the end of the next side onto the curve, that end, and where on the curve it is.

    The end is None where the curve or the part ends before; the turn is NaN where the side cannot follow the curve.
    """
    face, x, y, dx, dy = ray
    here, normal = np.array(in_space(mesh.frames, face, x, y)), np.array(normal_of(mesh.frames, face))
    ahead = at + sense * WINDOW * side
    turn, low, high = 0.0, -math.pi, math.pi
    for _ in range(ROUNDS):
        c, s = math.cos(turn), math.sin(turn)
        status, f, ex, ey, ax, ay, *_ = follow(
            mesh.row, mesh.link, face, x, y, c * dx - s * dy, s * dx + c * dy, side
        )
        if status != ENDED:
            return turn, None, at
        end = np.array(in_space(mesh.frames, f, ex, ey))
        foot, to = curve.nearest(end, *sorted((at, ahead)))
        if not 0.0 < to < curve.length:
            return 0.0, None, to
        is_at, should = end - here, foot - here
        error = math.atan2(float(normal @ np.cross(is_at, should)), float(is_at @ should))
        low, high = (turn, high) if error > 0.0 else (low, turn)
        if abs(error) < AGREES_RAD or high - low < AGREES_RAD:
            break
        # laid onto facets a curve has corners, between which the nearest place may jump: halve what is left
        turn = turn + error if low < turn + error < high else 0.5 * (low + high)
    if not (abs(error) < NEARLY_RAD or high - low < NEARLY_RAD):
        turn = math.nan
    return turn, (int(f), ex, ey, ax, ay), to
