"""The seed that the part itself gives: its area centroid, laid onto it."""

from __future__ import annotations

from typing import TYPE_CHECKING
from weakref import WeakKeyDictionary

import numpy as np

if TYPE_CHECKING:
    from geomdrap.surface import Surface

ONE_SIDED = 0.1  # mean normal of a part that has an upper side: tubes and closed parts have none
NEAR = 0.02  # of the part's diagonal: a centroid this close lies on the part, and its nearest point is meant
AS_NEAR = 0.02  # distances that differ by less than this share tell nothing apart on facets
APART = 0.5  # of the distance: places this far from each other are two
ON_CORNER = 1e-3  # of the facet's size: digits of a file in single precision are coarser than those of a seed
ON_RIM_OF_FACET = 1e-9  # of its size: the line meets both of two facets on their edge, never none


def on_part(surface: Surface) -> np.ndarray:
    """The centroid laid onto the part (3,): the nearest point, or where it lies off the part, the one across from it.

    Across is along the part's mean normal. On a dome that is the crown, while the nearest point may be on a flank,
    and hangs on single facets where several are as near.
    """
    point = surface.nearest(surface.centroid[None]).point[0]
    if np.linalg.norm(point - surface.centroid) > NEAR * surface.diagonal:
        met = across(surface)
        return point if met is None else met
    return point


_ACROSS: WeakKeyDictionary[Surface, np.ndarray | None] = WeakKeyDictionary()


def across(surface: Surface) -> np.ndarray | None:
    """As ``_across``, found once for a part."""
    if surface not in _ACROSS:
        _ACROSS[surface] = _across(surface)
    return _ACROSS[surface]


def _across(surface: Surface) -> np.ndarray | None:
    """The point (3,) nearest to the centroid at which a line through it along the mean normal meets the part.

    None where it misses (over a hole), and where the part has no upper side.
    """
    total = surface.areas @ surface.normals
    size = float(np.linalg.norm(total))
    if size <= ONE_SIDED * surface.area:
        return None
    up = total / size
    local = surface.points - surface.centroid
    around = local - (local @ up)[:, None] * up
    slack = ON_RIM_OF_FACET * surface.diagonal
    low, high = around <= slack, around >= -slack
    a, b, c = surface.triangles.T
    about = (low[a] | low[b] | low[c]) & (high[a] | high[b] | high[c])  # the line is within the facet's box
    faces = np.flatnonzero(about.all(axis=1))
    first, second, third = around[surface.triangles[faces]].swapaxes(0, 1)
    height = (local @ up)[surface.triangles[faces]]
    parts = [np.cross(a, b) @ up for a, b in ((second, third), (third, first), (first, second))]
    weight = np.stack(parts, axis=1) * np.sign(surface.normals[faces] @ up)[:, None]
    whole = weight.sum(axis=1)
    met = np.flatnonzero((whole > 0.0) & (weight.min(axis=1) >= -ON_RIM_OF_FACET * whole))
    if len(met) == 0:
        return None
    at = (weight[met] * height[met]).sum(axis=1) / whole[met]
    n = int(np.abs(at).argmin())
    return _snapped(surface, int(faces[met[n]]), surface.centroid + at[n] * up)


def _snapped(surface: Surface, face: int, point: np.ndarray) -> np.ndarray:
    """The point, or the corner it all but lies on: beside a tip all of its deficit would fall to one quadrant."""
    corners = surface.points[surface.triangles[face]]
    away = np.linalg.norm(corners - point, axis=1)
    on_it = away.min() <= ON_CORNER * np.sqrt(surface.areas[face])
    return np.array(corners[away.argmin()] if on_it else point)


def said(surface: Surface, point: np.ndarray, pitch: float) -> tuple[str, ...]:
    """A note where the seed (3,) lies further than a pitch from the centroid, or other places are as near."""
    away = float(np.linalg.norm(point - surface.centroid))
    if away <= pitch:
        return ()
    lies = f"the centroid lies {away:.4g} mm off the part; the origin is"
    met = across(surface)
    if met is not None and np.linalg.norm(point - met) <= 1e-6 * surface.diagonal:
        return (f"{lies} straight across from it, at {_words(point)} (another: --origin x,y,z)",)
    rival = _rival(surface, point, away)
    if rival is None:
        return (f"{lies} the nearest point, {_words(point)} (another: --origin x,y,z)",)
    return (f"{lies} {_words(point)}, but {_words(rival)} and others are as near: choose one with --origin x,y,z",)


def _words(point: np.ndarray) -> str:
    return "(" + ", ".join(f"{round(float(c), 2) + 0.0:g}" for c in point) + ")"


def _rival(surface: Surface, point: np.ndarray, away: float) -> np.ndarray | None:
    """A place (3,) that is as near to the centroid as the point, the furthest from that; or None."""
    places = np.concatenate([surface.points, surface.points[surface.triangles].mean(axis=1)])
    near = np.linalg.norm(places - surface.centroid, axis=1) <= (1.0 + AS_NEAR) * away
    apart = np.where(near, np.linalg.norm(places - point, axis=1), 0.0)
    return places[apart.argmax()] if apart.max() > APART * away else None
