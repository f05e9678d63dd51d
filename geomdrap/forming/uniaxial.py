"""Strips pulled along their length: the uniaxial test at any angle of the yarns, bias extension at 45°."""

from __future__ import annotations

import math

import numpy as np

from geomdrap.errors import FormingError
from geomdrap.forming.clipped import strip
from geomdrap.forming.cloth import Cloth
from geomdrap.forming.specimen import Specimen


def strip_specimen(
    cloth: Cloth, length: float = 150.0, width: float = 30.0, angle: float = 45.0, cells: int = 20
) -> Specimen:
    """A strip ``length`` × ``width`` mm between clamps, the warp at ``angle`` deg from its length.

    ``cells``: half diagonals of cells across the width at 45°; at other angles the pitch is the same within a tenth,
    so that at 0° whole cells fit in. Its one force is ``force``.
    """
    if cells < 2:
        raise FormingError(f"a strip needs at least 2 cells across; got {cells}")
    sheet = strip(length, width, angle, _pitch(width, angle, cells))
    y = sheet.points[:, 1]
    below, above = (np.flatnonzero(np.abs(y - level) < 1e-6 * length) for level in (-0.5 * length, 0.5 * length))
    flow, weights = np.zeros_like(sheet.points), np.zeros_like(sheet.points)
    flow[:, 1] = y / length + 0.5
    flow[below, 1], flow[above, 1] = 0.0, 1.0
    weights[above, 1] = 1.0
    return Specimen(sheet, cloth, np.concatenate([below, above]), flow, {"force": weights})


def _pitch(width: float, angle: float, cells: int) -> float:
    diagonal = math.sqrt(2.0) * width / cells
    return diagonal if angle % 90.0 != 0.0 else width / max(1, round(width / diagonal))


def kinematic_lock(length: float, width: float, angle: float) -> float:
    """Displacement, mm, at which the yarns that run from clamp to border are straight and a pin-jointed net locks.

    For clamps that hold the width, and an angle of 0 to 45 deg between warp and length; 0 where a yarn runs from
    clamp to clamp.
    """
    t = math.radians(angle)
    if math.tan(t) * length <= width:
        return 0.0
    yarn = length * math.cos(t) - width * math.sin(t) + length * math.sin(t) - width * math.cos(t)
    across = width * math.cos(2.0 * t)
    return math.sqrt(yarn * yarn - across * across) + width * math.sin(2.0 * t) - length
