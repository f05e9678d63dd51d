"""The few numbers of a net by which drapes are ranked, without the fields, the flat pattern and the checks.

They are those of ``evaluate``, to the last bit, because the same functions find them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.fields.evaluate import areas, statistics, unit_directions
from geomdrap.fields.result import Areas, ShearStatistics
from geomdrap.fields.trim import Trimmed, trim

if TYPE_CHECKING:
    from geomdrap.fishnet import Net


@dataclass(frozen=True)
class Figures:
    """Areas, shear statistics, and length and width (mm) of the least blank along warp and weft."""

    area: Areas
    statistics: ShearStatistics
    blank: tuple[float, float]


def figures(net: Net, limit_angle: float | None = None) -> Figures:
    """Areas, shear statistics and blank of a net, in less than half the time of ``evaluate``.

    ``limit_angle`` degrees; the fabric's own if None. Raises DrapeError for a limit angle out of range.
    """
    fabric = net.fabric if limit_angle is None else replace(net.fabric, limit_angle=limit_angle)
    trimmed = trim(net)
    warp, weft = unit_directions(trimmed)
    shear = np.degrees(np.arcsin(np.clip((warp * weft).sum(axis=1), -1.0, 1.0)))
    return Figures(areas(trimmed), statistics(net, trimmed, shear, fabric.limit_angle), least_blank(net, trimmed))


def least_blank(net: Net, trimmed: Trimmed) -> tuple[float, float]:
    """Length and width, mm, of the least rectangle along the yarns that the ply can be cut from."""
    corners = trimmed.at[trimmed.kind > 0].reshape(-1, 2)
    if len(corners) == 0:
        return 0.0, 0.0
    low, high = corners.min(axis=0), corners.max(axis=0)
    if net.reach is not None:
        low, high = np.maximum(low, np.negative(net.reach)), np.minimum(high, net.reach)
    return float(high[0] - low[0]), float(high[1] - low[1])
