"""A surface as the kernels want it: everything about a face in one row."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from geomdrap.geodesic.bend import bends
from geomdrap.geodesic.compiled import inlined, tight

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
    unfolded = surface.unfolded
    row = np.zeros((len(unfolded), 24))
    row[:, 2] = unfolded[:, 0]
    row[:, 4:6] = unfolded[:, 1:3]
    row[:, CROSS:BEND] = unfolded[:, 3:15]
    if spread > 0.0:
        topology = (surface.triangles, surface.neighbours, surface.neighbour_edge, unfolded)
        row[:, BEND:] = bends(*topology, surface.deficits, spread).reshape(-1, 6)
    link = np.where(surface.neighbours < 0, -1, 4 * surface.neighbours + surface.neighbour_edge)
    frames = np.hstack([surface.origin, surface.e1, surface.e2])
    return Mesh(row, np.ascontiguousarray(link, dtype=np.int32), np.ascontiguousarray(frames))
