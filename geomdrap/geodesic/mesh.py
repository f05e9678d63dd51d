"""A surface as the kernels want it: everything about a face in one row."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from geomdrap.geodesic.bend import bends
from geomdrap.geodesic.compiled import inlined, kernel, tight

if TYPE_CHECKING:
    from geomdrap.surface import Surface

# columns of Mesh.row; the first six are x, y of corners 0, 1, 2 in the face's own frame
CROSS = 6  # per edge cosine, sine, shift x, shift y into the neighbour's frame
BEND = 18  # per edge the two numbers of ``bends``


class Mesh(NamedTuple):
    """What the kernels need of a surface; few arrays, because each costs time at every call.

    ``row`` (m, 24): corners, crossings and bends of a face, three cache lines. ``link`` (m, 3) int32: 4 × the
    neighbour across edge k + the number of that edge there, -1 on the rim. ``frames`` (m, 9): origin, e1, e2.
    """

    row: np.ndarray
    link: np.ndarray
    frames: np.ndarray


@inlined
def after(k: int) -> int:
    """The next corner or edge of a face."""
    return k + 1 if k < 2 else 0


@inlined
def before(k: int) -> int:
    """The corner or edge of a face before this one."""
    return k - 1 if k > 0 else 2


@inlined
def in_space(frames: np.ndarray, f: int, x: float, y: float) -> tuple[float, float, float]:
    """Point in space of a point in the frame of face f."""
    return (
        frames[f, 0] + x * frames[f, 3] + y * frames[f, 6],
        frames[f, 1] + x * frames[f, 4] + y * frames[f, 7],
        frames[f, 2] + x * frames[f, 5] + y * frames[f, 8],
    )


@inlined
def normal_of(frames: np.ndarray, f: int) -> tuple[float, float, float]:
    """Unit normal of face f."""
    return (
        frames[f, 4] * frames[f, 8] - frames[f, 5] * frames[f, 7],
        frames[f, 5] * frames[f, 6] - frames[f, 3] * frames[f, 8],
        frames[f, 3] * frames[f, 7] - frames[f, 4] * frames[f, 6],
    )


@tight
def in_frame(frames: np.ndarray, face: int, other: int, dx: float, dy: float) -> tuple[float, float]:
    """Direction of one face, turned into the plane of another that is near it."""
    if face == other:
        return dx, dy
    ex = ey = 0.0
    for k in range(3):
        along = dx * frames[face, 3 + k] + dy * frames[face, 6 + k]
        ex += along * frames[other, 3 + k]
        ey += along * frames[other, 6 + k]
    norm = math.hypot(ex, ey)
    return ex / norm, ey / norm


KEPT = 2  # views of a surface: a diagnosis has a fine net and a coarse one in turns
_MADE: WeakKeyDictionary[Surface, dict[float, Mesh]] = WeakKeyDictionary()


def mesh_of(surface: Surface, spread: float = 0.0) -> Mesh:
    """The kernels' view of a surface, kept until ``KEPT`` other values of ``spread`` are asked for.

    ``spread`` mm is how far ``bends`` may move curvature; with 0 lines stay straight on the very facets.
    """
    made = _MADE.setdefault(surface, {})
    if spread not in made:
        made[spread] = _make(surface, spread)
        if len(made) > KEPT:
            del made[next(iter(made))]
    return made[spread]


def _make(surface: Surface, spread: float) -> Mesh:
    unfolded, turns = surface.unfolded, np.zeros((len(surface.triangles), 3, 2))
    if spread > 0.0:
        topology = (surface.triangles, surface.neighbours, surface.neighbour_edge, unfolded)
        turns = bends(*topology, surface.corner_angles, surface.deficits, spread)
    across = surface.neighbours, surface.neighbour_edge
    return Mesh(*_rows(unfolded, turns, *across, surface.origin, surface.e1, surface.e2))


@kernel
def _rows(
    unfolded: np.ndarray,
    turns: np.ndarray,
    neighbours: np.ndarray,
    neighbour_edge: np.ndarray,
    origin: np.ndarray,
    e1: np.ndarray,
    e2: np.ndarray,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The arrays of a ``Mesh``, written face by face: by columns it takes several times as long."""
    m = len(unfolded)
    row, link, frames = np.empty((m, 24)), np.empty((m, 3), np.int32), np.empty((m, 9))
    for f in range(m):
        row[f, 0] = row[f, 1] = row[f, 3] = 0.0
        row[f, 2], row[f, 4], row[f, 5] = unfolded[f, 0], unfolded[f, 1], unfolded[f, 2]
        for k in range(BEND - CROSS):
            row[f, CROSS + k] = unfolded[f, 3 + k]
        for k in range(3):
            row[f, BEND + 2 * k], row[f, BEND + 2 * k + 1] = turns[f, k, 0], turns[f, k, 1]
            g = neighbours[f, k]
            link[f, k] = -1 if g < 0 else 4 * g + neighbour_edge[f, k]
            frames[f, k], frames[f, 3 + k], frames[f, 6 + k] = origin[f, k], e1[f, k], e2[f, k]
    return row, link, frames
