"""Fibre directions that point out of the part: no yarn of a draped ply does."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from geomdrap.measurement.measurement import Measurement
    from geomdrap.surface import Surface

UPRIGHT = float(np.sqrt(0.5))
"""Share of a direction along the normal from which on it is nearer to the normal than to the surface."""


def without_upright(surface: Surface, measurement: Measurement) -> Measurement:
    """The measurement without directions more than 45 degrees off the surface, and a warning of how many these are.

    By an edge of the part the facets beyond it count too, of which one must have the direction in it.
    """
    if measurement.warp is None and measurement.weft is None:
        return measurement
    face = surface.nearest(measurement.points).face
    beside = np.column_stack([face, surface.neighbours[face]])
    normals = np.where(beside[..., None] >= 0, surface.normals[beside], surface.normals[face][:, None])
    kept, said = {"warp": measurement.warp, "weft": measurement.weft}, list(measurement.warnings)
    for family, directions in kept.items():
        if directions is None:
            continue
        height = np.abs(np.einsum("nk,nfk->nf", directions, normals)).min(axis=1)
        upright = np.isfinite(height) & (height > UPRIGHT)
        if upright.any():
            left = np.where(upright[:, None], np.nan, directions)
            kept[family] = left if np.isfinite(left).any() else None
            said.append(_words(measurement, family, directions, upright))
    return replace(measurement, warp=kept["warp"], weft=kept["weft"], warnings=tuple(said))


def _words(measurement: Measurement, family: str, directions: np.ndarray, upright: np.ndarray) -> str:
    known = int(np.isfinite(directions).all(axis=1).sum())
    first = int(measurement.row[np.flatnonzero(upright)[0]])
    return (
        f"{measurement.source}: {int(upright.sum())} of {known} {family} directions (first in line {first}) point "
        f"out of the part, more than 45 degrees off its surface, and are left out: check {family}_x, {family}_y, "
        f"{family}_z and the frame that they are in"
    )
