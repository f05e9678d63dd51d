"""Colours: continuous and safe for the colour-blind on the part, three classes on the flat map."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

INK = "#1f2933"
FAINT = "#7b8794"
PAPER = "#ffffff"
ALARM = "#b42318"

LOW = "#3b75af"
"""Under half the limit angle."""
MIDDLE = "#f2c14e"
"""From half the limit to the limit."""
HIGH = "#c8322b"
"""Beyond the limit."""
BARE = "#d5d9de"
BARE_STRIPE = "#a9b1ba"

WARP = "#111111"
WEFT = "#5b2a86"

LIMIT_LINE = "#00d5e8"
"""The limit angle on the continuous map and its scale."""

SEAM = "#138a36"
"""Seams between strips of a roll, on both maps; no colour of theirs is a green."""

CONTINUOUS = "magma", 0.98, 0.16
"""Light where there is no shear, so that a part with little of it shows its form; dark is beyond."""


def rgb(colour: str) -> tuple[float, float, float]:
    """'#rrggbb' as three numbers 0 to 1."""
    return int(colour[1:3], 16) / 255, int(colour[3:5], 16) / 255, int(colour[5:7], 16) / 255


def continuous_table() -> NDArray[np.float32]:
    """The continuous map as a table (256, 3), 0 to 1."""
    from matplotlib import colormaps

    name, first, last = CONTINUOUS
    return np.asarray(colormaps[name](np.linspace(first, last, 256)))[:, :3].astype(np.float32)


def diverging_table() -> NDArray[np.float32]:
    """The map of signed shear as a table (256, 3), 0 to 1: blue, pale where there is none, red."""
    from matplotlib import colormaps

    return np.asarray(colormaps["RdYlBu_r"](np.linspace(0.02, 0.98, 256)))[:, :3].astype(np.float32)


def top_of_scale(largest: float, limit: float) -> float:
    """End of the continuous scale, deg: a multiple of 5 that holds the largest shear.

    Not under 5 (noise must not look like shear) and not beyond 1.5 × limit (one bad cell must not
    wash out the rest).
    """
    ceiling = max(5.0, 5.0 * np.ceil(1.5 * limit / 5.0))
    return float(np.clip(5.0 * np.ceil(largest / 5.0 - 1e-9), 5.0, ceiling)) if np.isfinite(largest) else 5.0


def class_of(shear: NDArray[np.float64], limit: float) -> NDArray[np.float64]:
    """0 under half the limit, 1 up to the limit, 2 beyond; NaN stays NaN. Degrees, any shape."""
    size = np.abs(shear)
    return np.where(np.isnan(size), np.nan, (size > 0.5 * limit) * 1.0 + (size > limit) * 1.0)
