"""The flat pattern laid from strips of a roll of fabric, which is as long as need be and limited along the weft."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import DrapeError
from geomdrap.fields.band import across, band
from geomdrap.fields.seam_line import FabricFacets, fabric_facets, polylines, stretches_along
from geomdrap.fields.seams import place_seams
from geomdrap.fields.strips import Roll, RollStrip, Seam

if TYPE_CHECKING:
    from geomdrap.fields.result import Drape, FlatPattern


def lay_on_roll(result: Drape, width: float, overlap: float = 0.0) -> Roll:
    """Lay the flat pattern of a drape from the fewest strips of a roll ``width`` mm wide.

    Neighbouring strips both reach half the ``overlap`` mm past their seam. Where the seams lie: see ``seams``.
    Raises DrapeError for a roll that is narrower than the pitch, an overlap that leaves less than that of it, and a
    pattern that crosses itself.
    """
    check_roll(width, overlap, result.net.pitch)
    flat = result.flat
    if not flat.outer:
        return Roll(width, overlap, (), ())
    v = np.concatenate([ring[:, 1] for ring in flat.outer])
    low, high = float(v.min()), float(v.max())
    facets = fabric_facets(result)
    half = np.inf if result.net.reach is None else float(result.net.reach[0])

    def cost(level: float) -> float:
        line = stretches_along(facets, level, half)
        weight = 1.0 + np.abs(line.shear) / result.limit_angle
        return float((weight * (line.u[:, 1] - line.u[:, 0])).sum())

    levels = place_seams(low, high, width, overlap, cost).tolist()
    edges = [low, *levels, high]
    past = 0.5 * overlap
    strips = [
        strip_of(flat, edges[k], edges[k + 1], (past if k > 0 else 0.0, past if k < len(levels) else 0.0))
        for k in range(len(edges) - 1)
    ]
    return Roll(
        width, overlap, tuple(strips), tuple(seam_at(flat, facets, v, half, result.net.pitch) for v in levels)
    )


def check_roll(width: float, overlap: float, pitch: float) -> None:
    """Raise DrapeError unless a roll, less the overlap, is at least one pitch wide."""
    if not (np.isfinite(width) and width > 0.0):
        raise DrapeError(f"the width of a roll must be a positive number of mm, not {width:g}")
    if not 0.0 <= overlap < np.inf:
        raise DrapeError(f"the overlap of seams must be 0 mm or more, not {overlap:g}")
    if width < pitch:
        raise DrapeError(
            f"a roll {width:g} mm wide is narrower than the pitch of {pitch:g} mm: give the width of the roll in mm, "
            "or a smaller pitch"
        )
    if width - overlap < pitch:
        raise DrapeError(
            f"an overlap of {overlap:g} mm leaves less of a roll {width:g} mm wide than the pitch of {pitch:g} mm: "
            "give a smaller overlap"
        )


def strip_of(flat: FlatPattern, low: float, high: float, past: tuple[float, float]) -> RollStrip:
    """The strip between two levels, mm, and how far it reaches ``past`` the lower and the upper, mm."""
    contours = band((*flat.outer, *flat.inner), low, high, past)
    u = np.concatenate([ring[:, 0] for ring in contours]) if contours else np.zeros(1)
    return RollStrip((low - past[0], high + past[1]), (float(u.min()), float(u.max())), contours)


def seam_at(flat: FlatPattern, facets: FabricFacets, level: float, half: float, pitch: float) -> Seam:
    """The seam at a level, mm, in the flat pattern and on the part."""
    line = stretches_along(facets, level, half)
    pieces = tuple(np.column_stack([u, [level] * 2]) for u in across((*flat.outer, *flat.inner), level))
    if not len(line.u):
        return Seam(level, pieces, (), 0.0, np.full(3, np.nan))
    size = np.abs(line.shear)
    worst = int(size.argmax())
    return Seam(level, pieces, polylines(line, pitch), float(size[worst]), line.points[worst].mean(axis=0))
