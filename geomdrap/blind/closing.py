"""Rolling-ball closing of a tool, on a fine grid: what a ply rests on that cannot bend tighter than the ball."""

from __future__ import annotations

import numpy as np

from geomdrap.blind.sheet import Sheet, splined
from geomdrap.blind.terms import Array
from geomdrap.blind.tools import Tool

SPACING = 2.0  # mm, of the grid


def closed(tool: Tool, radius: float, spacing: float = SPACING) -> Sheet:
    """The closing of ``tool`` by a ball of ``radius`` mm that rolls on its upper side, as a cubic spline.

    Dilation by the ball gives where its centre can go; erosion of that by the ball gives the closing (Serra).
    The gap below the closing is smoothed over one spacing, for the ball touches the grid at its points only.
    """
    from scipy.interpolate import RectBivariateSpline
    from scipy.ndimage import gaussian_filter

    m = int(radius / spacing) + 1
    x, y = (spacing * np.arange(-n, n + 1) for n in (int(half / spacing) + 4 + 2 * m for half in tool.half))
    z = tool.height(*np.meshgrid(x, y, indexing="ij"))
    inner = slice(2 * m, -2 * m)
    ball = _ball(radius, spacing)
    gap = -_dilated(-_dilated(z, ball, m), ball, m) - z[inner, inner]
    lifted = z[inner, inner] + gaussian_filter(gap, 1.0)
    return splined(RectBivariateSpline(x[inner], y[inner], lifted, kx=3, ky=3))


def _ball(radius: float, spacing: float) -> list[tuple[int, int, float]]:
    """The upper half of the ball over the grid: (i, j, height) for each grid point under it."""
    n = int(radius / spacing)
    i, j = np.mgrid[-n : n + 1, -n : n + 1]
    under = radius**2 - spacing**2 * (i * i + j * j)
    ok = under >= 0.0
    return list(zip(i[ok].tolist(), j[ok].tolist(), np.sqrt(under[ok]).tolist(), strict=True))


def _dilated(z: Array, ball: list[tuple[int, int, float]], m: int) -> Array:
    """Dilation of the height grid ``z`` by the ball; the result is ``m`` points smaller on each side."""
    rows, columns = (n - 2 * m for n in z.shape)
    best = np.full((rows, columns), -np.inf)
    for i, j, height in ball:
        np.maximum(best, z[m + i : m + i + rows, m + j : m + j + columns] + height, out=best)
    return best
