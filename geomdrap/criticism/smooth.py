"""The smooth tool that facets stand for: every facet split into four, their new corners on curved patches.

Measured marks lie on the tool, not on its facets. Chords of a few millimetres cut some hundredths of a millimetre off
a bend, and their edges turn yarns one by one; over a whole net that adds up to as much as the noise of an instrument.
On the split facets it is a quarter.

Source: A. Vlachos, J. Peters, C. Boyd and J. L. Mitchell, Curved PN triangles, I3D 2001: the middle of an edge.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.fishnet import Effect
from geomdrap.fishnet.relax_surface import smooth_normals
from geomdrap.surface.quarter import quartered

if TYPE_CHECKING:
    from geomdrap.surface import Surface

MOST_FACETS = 120_000  # after splitting
LEAST_LIFT = 1e-3  # mm: where no middle moves further, the part is as good as its facets


class SmoothTool(Effect):
    """The net is draped on the smooth tool that the facets stand for, after all that acts on the surface."""

    name = "smooth-tool"
    stage = "surface"
    rank = math.inf

    def on_surface(self, surface: Surface) -> Surface:
        """The surface with its facets split and rounded."""
        return smoothed(surface)


@dataclass(frozen=True, eq=False)
class Split:
    """How the facets (m, 3) of a part were split: ``edges`` and ``side`` as from ``quartered``, and what was made."""

    triangles: np.ndarray
    edges: np.ndarray
    side: np.ndarray
    made: Surface


def smoothed(surface: Surface, splits: list[Split] | None = None) -> Surface:
    """The part with its facets split in four and rounded; itself where that makes no difference, too many, or is cut.

    What is split is added to ``splits``: the same facets with their vertices elsewhere are not split anew.
    """
    if 4 * len(surface.triangles) > MOST_FACETS or surface.cuts:
        return surface
    known = next((s for s in splits or () if s.triangles is surface.triangles), None)
    if known is not None:
        points = _rounded(surface, known.edges, known.side)
        return surface if points is None else known.made.moved(points)
    return _split(surface, splits)


def _split(surface: Surface, splits: list[Split] | None) -> Surface:
    """``smoothed`` of a part that was not yet split."""
    from geomdrap.surface import Surface

    edges, side, split = quartered(surface.triangles, len(surface.points))
    points = _rounded(surface, edges, side)
    if points is None:
        return surface
    numbers = np.repeat(surface.source_face, 4)
    made = Surface(points, split, source=surface.source, face_numbers=numbers, notes=surface.notes)
    made = made.numbered_by(surface.vertex_of_input)
    if surface.findings.unit_hint:
        made = made.doubted(surface.findings.unit_hint)
    # what a surface does to its vertices, as to weld some or to turn facets over, is not done again
    if splits is not None and np.array_equal(made.points, points) and np.array_equal(made.triangles, split):
        splits.append(Split(surface.triangles, edges, side, made))
    return made


def _rounded(surface: Surface, edges: np.ndarray, side: np.ndarray) -> np.ndarray | None:
    """The vertices and the middles of the ``edges``, on the smooth tool; None where all lie as well on the chords."""
    number = side.ravel()
    total = [np.bincount(number, column) for column in _lifts(surface).reshape(-1, 3).T]
    lifts = np.column_stack(total) / np.bincount(number)[:, None]
    if np.linalg.norm(lifts, axis=1).max() < LEAST_LIFT:
        return None
    return np.vstack([surface.points, surface.points[edges].mean(axis=1) + lifts])


def note_on(surface: Surface) -> tuple[str, ...]:
    """A sentence where a part is cut, or has too many facets to be smoothed; none where not."""
    if surface.cuts:
        return ("nets lie on the facets of the part itself: one that is cut is not rounded to the smooth tool",)
    count = len(surface.triangles)
    if 4 * count <= MOST_FACETS:
        return ()
    return (
        f"nets lie on the {count} facets of the part itself: only up to {MOST_FACETS // 4} are they rounded to the "
        "smooth tool that they stand for",
    )


def _lifts(surface: Surface) -> np.ndarray:
    """How far the middle of each edge of each facet (m, 3, 3) lies over its chord, mm.

    Facets that meet in an edge of more than 30° share no normal there: flats stay flat up to it.
    """
    normals = smooth_normals(surface)
    corners = surface.points[surface.triangles]
    chords = np.roll(corners, -1, axis=1) - corners
    ends = np.roll(normals, -1, axis=1)
    out = normals * np.einsum("fkx,fkx->fk", chords, normals)[..., None]
    back = ends * np.einsum("fkx,fkx->fk", chords, ends)[..., None]
    return np.asarray((back - out) / 8.0)
