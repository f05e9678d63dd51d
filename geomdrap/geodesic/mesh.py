"""A surface as the kernels want it: everything about a face in one row."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple
from weakref import WeakKeyDictionary

import numpy as np

from geomdrap.geodesic.bend import bends
from geomdrap.geodesic.compiled import inlined

if TYPE_CHECKING:
    from geomdrap.surface import Surface

# columns of Mesh.row
CORNER = 0  # x, y of corners 0, 1, 2 in the face's own frame
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


_SMOOTH: WeakKeyDictionary[Surface, Mesh] = WeakKeyDictionary()
_PLAIN: WeakKeyDictionary[Surface, Mesh] = WeakKeyDictionary()


def mesh_of(surface: Surface, *, smooth: bool = True) -> Mesh:
    """The kernels' view of a surface, made once; without ``smooth`` lines stay straight on the very facets."""
    made = _SMOOTH if smooth else _PLAIN
    if surface not in made:
        made[surface] = _make(surface, smooth)
    return made[surface]


def _make(surface: Surface, smooth: bool) -> Mesh:
    unfolded = surface.unfolded
    row = np.zeros((len(unfolded), 24))
    row[:, 2] = unfolded[:, 0]
    row[:, 4:6] = unfolded[:, 1:3]
    row[:, CROSS:BEND] = unfolded[:, 3:15]
    if smooth:
        row[:, BEND:] = bends(
            surface.triangles, surface.neighbours, surface.neighbour_edge, unfolded, len(surface.points)
        ).reshape(-1, 6)
    link = np.where(surface.neighbours < 0, -1, 4 * surface.neighbours + surface.neighbour_edge)
    frames = np.hstack([surface.origin, surface.e1, surface.e2])
    return Mesh(row, np.ascontiguousarray(link, dtype=np.int32), np.ascontiguousarray(frames))
