"""Rolling-ball closing of a tool: what a ply rests on that cannot bend tighter than the ball.

Dilation by the ball gives where its centre can go, h(c); erosion of that by the ball gives the closing (J. Serra,
Image Analysis and Mathematical Morphology, 1982). In a valley the ball rests on both walls, and h has a kink there:
on a grid alone the closing would err by the first power of the spacing. So a grid says only which stretches of the
tool the ball may touch; where it touches them, and where its centre is best, is searched between the grid's points.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from geomdrap.blind.sheet import Sheet, splined
from geomdrap.blind.terms import Array, Term
from geomdrap.blind.tools import Tool

SPACING = 2.0  # mm, of the grid
TOUCHES = 2  # Newton's steps to where the ball touches the tool
HALVINGS = 6  # of the spacing, in the search for the best centre
LIFTED = 1e-3  # mm: where the grid closes less, the ply is on the tool

Index = NDArray[np.intp]


@lru_cache(maxsize=2)  # a set lays several plies on the same sheet
def closed(tool: Tool, radius: float, spacing: float = SPACING) -> Sheet:
    """The closing of ``tool`` by a ball of ``radius`` mm that rolls on its upper side, as a cubic spline."""
    from scipy.interpolate import RectBivariateSpline

    m = int(radius / spacing) + 1
    x, y = (spacing * np.arange(-n, n + 1) for n in (int(half / spacing) + 4 + 2 * m for half in tool.half))
    at = np.stack(np.meshgrid(x, y, indexing="ij"), axis=-1)
    z = tool.height(at[..., 0], at[..., 1])
    ball = _ball(radius, spacing)
    centre, touched = _dilated(z, ball, m)
    eroded, best = _dilated(-centre, ball, m)
    inner = slice(2 * m, -2 * m)
    out = np.maximum(-eroded, z[inner, inner])
    lifted = np.argwhere(out - z[inner, inner] > LIFTED)
    if len(lifted):
        k, rows = tuple(lifted.T), centre.shape[1]
        c = np.stack(np.divmod(best[k], rows), axis=-1)
        near = _beside(touched, c)
        touch = at.reshape(-1, 2)[near]
        lower = _lowest(tool.term, radius, spacing, at[inner, inner][k], at[m:-m, m:-m][tuple(c.T)], touch)
        out[k] = np.maximum(lower, z[inner, inner][k])
    return splined(RectBivariateSpline(x[inner], y[inner], out, kx=3, ky=3))


def _ball(radius: float, spacing: float) -> list[tuple[int, int, float]]:
    """The upper half of the ball over the grid: (i, j, height) for each grid point under it."""
    n = int(radius / spacing)
    i, j = np.mgrid[-n : n + 1, -n : n + 1]
    under = radius**2 - spacing**2 * (i * i + j * j)
    ok = under >= 0.0
    return list(zip(i[ok].tolist(), j[ok].tolist(), np.sqrt(under[ok]).tolist(), strict=True))


def _dilated(z: Array, ball: list[tuple[int, int, float]], m: int) -> tuple[Array, Index]:
    """Dilation of the height grid ``z`` by the ball, ``m`` points smaller on each side, and the points that make it.

    The latter as numbers in ``z`` made flat.
    """
    rows, columns = (n - 2 * m for n in z.shape)
    number = np.arange(z.size).reshape(z.shape)
    best, by = np.full((rows, columns), -np.inf), np.zeros((rows, columns), dtype=np.intp)
    for i, j, height in ball:
        part = np.s_[m + i : m + i + rows, m + j : m + j + columns]
        raised = z[part] + height
        higher = raised > best
        np.copyto(best, raised, where=higher)
        np.copyto(by, number[part], where=higher)
    return best, by


def _beside(touched: Index, c: Index) -> Index:
    """Tool points (k, 9) that balls at the grid centres c (k, 2) and at their eight neighbours touch."""
    rows, columns = touched.shape
    steps = [(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1)]
    near = [touched[np.clip(c[:, 0] + i, 0, rows - 1), np.clip(c[:, 1] + j, 0, columns - 1)] for i, j in steps]
    return np.stack(near, axis=1)


def _lowest(term: Term, radius: float, spacing: float, p: Array, c: Array, touch: Array) -> Array:
    """The least of h(c) − √(R² − |p − c|²) at points p (k, 2), by halving steps from the grid centres c (k, 2)."""
    steps = np.array([(i, j) for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)], dtype=float)

    def under(c: Array) -> Array:
        room = radius**2 - ((p - c) ** 2).sum(axis=1)
        return np.where(room > 0.0, _height(term, radius, c, touch) - np.sqrt(np.maximum(room, 0.0)), np.inf)

    best = under(c)
    for n in range(HALVINGS):
        size = 0.5 ** (n + 1) * spacing
        for _ in range(2):
            trials = np.array([under(c + size * step) for step in steps])
            lower = trials.min(axis=0) < best
            c = np.where(lower[:, None], c + size * steps[trials.argmin(axis=0)], c)
            best = np.minimum(best, trials.min(axis=0))
    return best


def _height(term: Term, radius: float, c: Array, touch: Array) -> Array:
    """Height of the centre over c (k, 2): the most of z(q) + √(R² − |q − c|²) near ``touch`` (k, t, 2)."""
    q, c = touch.reshape(-1, 2), np.repeat(c, touch.shape[1], axis=0)
    best = np.full(len(q), -np.inf)
    for _ in range(TOUCHES + 1):
        z, zx, zy, zxx, zxy, zyy = term(q[:, 0], q[:, 1])
        d = q - c
        room = radius**2 - (d**2).sum(axis=1)
        root = np.sqrt(np.maximum(room, 1e-6 * radius**2))
        best = np.maximum(best, np.where(room > 0.0, z + root, -np.inf))
        gx, gy = zx - d[:, 0] / root, zy - d[:, 1] / root
        hxx = zxx - 1.0 / root - d[:, 0] ** 2 / root**3
        hyy = zyy - 1.0 / root - d[:, 1] ** 2 / root**3
        hxy = zxy - d[:, 0] * d[:, 1] / root**3
        det = hxx * hyy - hxy * hxy
        maximal = (det > 0.0) & (hxx < 0.0)
        move = np.stack([hxy * gy - hyy * gx, hxy * gx - hxx * gy], axis=1) / np.where(maximal, det, np.inf)[:, None]
        q = q + move
    return np.max(best.reshape(touch.shape[:2]), axis=1)
