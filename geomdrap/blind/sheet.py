"""The sheets a ply can lie on: the tool itself, a surface parallel to it, or its rolling-ball closing.

All are given over the tool's plan (x, y): a sheet maps plan points to points in space and two tangents.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from geomdrap.blind.terms import Array, Term

APART = 1e-3  # mm

Sheet = Callable[[Array], tuple[Array, Array, Array]]
"""(n, 2) plan points mm -> (n, 3) points mm, (n, 3) tangents along x, (n, 3) tangents along y."""


def bare(term: Term) -> Sheet:
    """The height field itself."""

    def sheet(xy: Array) -> tuple[Array, Array, Array]:
        z, zx, zy, *_ = term(xy[:, 0], xy[:, 1])
        one, zero = np.ones_like(z), np.zeros_like(z)
        along_x, along_y = (np.stack(t, axis=1) for t in ((one, zero, zx), (zero, one, zy)))
        return np.column_stack([xy, z]), along_x, along_y

    return sheet


def parallel(term: Term, offset: float) -> Sheet:
    """The surface at the distance ``offset`` mm above the height field, along its normals.

    A point is p + t n; its tangents are p_x + t n_x with n_x = (N_x − n (n · N_x))/|N|, N = (−z_x, −z_y, 1).
    """

    def sheet(xy: Array) -> tuple[Array, Array, Array]:
        z, zx, zy, zxx, zxy, zyy = term(xy[:, 0], xy[:, 1])
        one, zero = np.ones_like(z), np.zeros_like(z)
        size = np.sqrt(1.0 + zx * zx + zy * zy)
        n = np.stack([-zx, -zy, one], axis=1) / size[:, None]

        def turned(first: Array, second: Array) -> Array:
            change = np.stack([-first, -second, zero], axis=1)
            return (change - n * np.sum(n * change, axis=1)[:, None]) / size[:, None]

        along_x = np.stack([one, zero, zx], axis=1) + offset * turned(zxx, zxy)
        along_y = np.stack([zero, one, zy], axis=1) + offset * turned(zxy, zyy)
        return np.column_stack([xy, z]) + offset * n, along_x, along_y

    return sheet


def splined(spline: Any) -> Sheet:
    """The height field of a bivariate spline of scipy (``ev(x, y, dx, dy)``)."""

    def sheet(xy: Array) -> tuple[Array, Array, Array]:
        x, y = xy[:, 0], xy[:, 1]
        z, zx, zy = spline.ev(x, y), spline.ev(x, y, dx=1), spline.ev(x, y, dy=1)
        one, zero = np.ones_like(z), np.zeros_like(z)
        along_x, along_y = (np.stack(t, axis=1) for t in ((one, zero, zx), (zero, one, zy)))
        return np.column_stack([xy, z]), along_x, along_y

    return sheet


def normals(sheet: Sheet, xy: Array) -> Array:
    """Unit normals (n, 3), upward, at the plan points ``xy`` (n, 2)."""
    _, along_x, along_y = sheet(xy)
    n = np.cross(along_x, along_y)
    return n / np.linalg.norm(n, axis=1, keepdims=True)


def turnings(sheet: Sheet, xy: Array) -> Array:
    """How the unit normals turn, (n, 3, 3) per mm along the sheet, by differences over ``APART``."""
    _, px, py = sheet(xy)
    xx, xy_, yy = (np.sum(a * b, axis=1)[:, None] for a, b in ((px, px), (px, py), (py, py)))
    area = xx * yy - xy_ * xy_
    duals = (yy * px - xy_ * py) / area, (xx * py - xy_ * px) / area
    turning = np.zeros((len(xy), 3, 3))
    for step, dual in zip(APART * np.eye(2), duals, strict=True):
        change = (normals(sheet, xy + step) - normals(sheet, xy - step)) / (2.0 * APART)
        turning += change[:, :, None] * dual[:, None, :]
    return turning
