"""Readings of simulated tests, at given displacements, as a fit holds them against measured ones."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from geomdrap.forming.cloth import Cloth
from geomdrap.forming.coupon import Coupon, bias_extension, biaxial, picture_frame, uniaxial
from geomdrap.forming.held import Held

Array = NDArray[np.float64]

CELLS = 10
"""Cells across in the runs of a fit: four times faster than the usual mesh, and forces within a percent of it."""
BEYOND = 1.0 + 1e-9
"""Runs go so far beyond the last reading, since rounding must not leave it outside of them."""


def predict(
    test: str, cloth: Cloth, settings: Mapping[str, Any], displacement: Array, columns: tuple[str, ...]
) -> dict[str, Array]:
    """Columns (n,) of a simulated test at ``displacement`` (n,) mm; NaN beyond where it stopped."""
    from scipy.interpolate import CubicSpline

    furthest = float(np.max(displacement)) * BEYOND
    pulled = _simulated(test, cloth, settings, furthest).result
    given = {**pulled.forces, "shear": pulled.shear}
    if len(pulled.displacement) < 2:
        return nothing(displacement, columns)
    return {
        c: np.asarray(CubicSpline(pulled.displacement, given[c], extrapolate=False)(displacement)) for c in columns
    }


def nothing(displacement: Array, columns: tuple[str, ...]) -> dict[str, Array]:
    """Columns (n,) of a run that gave nothing: NaN."""
    return {c: np.full(len(displacement), np.nan) for c in columns}


def held_run(held: Held, cloth: Cloth, displacement: Array, columns: tuple[str, ...]) -> dict[str, Array]:
    """Columns of a run with masses and steps held; NaN for a cloth that is out of all proportion."""
    if not held.takes(cloth):
        return nothing(displacement, columns)
    return predict(held.test, cloth, held.settings, displacement, columns)


def usual(test: str) -> dict[str, Any]:
    """Settings of the runs of a fit, where they are not those of a single run."""
    return {"cells": CELLS} if test in ("uniaxial", "bias-extension") else {}


def _simulated(test: str, cloth: Cloth, settings: Mapping[str, Any], furthest: float) -> Coupon:
    if test == "picture-frame":
        side = settings.get("side", 100.0)
        last = 90.0 - 2.0 * np.rad2deg(np.arccos(min(0.5 * furthest / side + np.sqrt(0.5), 1.0 - 1e-9)))
        asked = {**settings, "shear": np.linspace(last / 40.0, last, 40).tolist(), "steps": 800}
        return picture_frame(cloth, **asked)
    asked = {**settings, "displacement": furthest}
    if test == "biaxial":
        return biaxial(cloth, **asked)
    asked = {**usual(test), **asked}
    return uniaxial(cloth, **asked) if test == "uniaxial" else bias_extension(cloth, **asked)
