"""Generators: straightest chords on a sheet, leaving a point in a direction, turning as they are told.

A polygon with chords t is straightest where t_next lies in the plane of t and the normal n between them: the
geodesic's own condition, with chords in place of derivatives. It is exact on spheres and cylinders.
"""

from __future__ import annotations

import numpy as np

from geomdrap.blind.sheet import Sheet, normals
from geomdrap.blind.terms import Array


def generators(sheet: Sheet, start: Array, headings: Array, sides: Array, turns: Array) -> Array:
    """Give the plan points (k, m + 1, 2) of k polygons that leave ``start`` (2,).

    headings (k, 3): directions at the start, tangent to the sheet. sides (k, m): chord lengths, mm.
    turns (k, m): the sine of the angle by which each chord turns to the left of the one before, in the sheet.
    A chord that finds no end is NaN, and so is all behind it.
    """
    k, m = sides.shape
    plan = np.full((k, m + 1, 2), np.nan)
    plan[:, 0] = start
    direction = headings / np.linalg.norm(headings, axis=1, keepdims=True)
    for step in range(m):
        n = normals(sheet, plan[:, step])
        left = np.cross(n, direction)
        left /= np.linalg.norm(left, axis=1, keepdims=True)
        plan[:, step + 1] = _ends(sheet, plan[:, step], direction, left, sides[:, step], turns[:, step])
        chord = sheet(plan[:, step + 1])[0] - sheet(plan[:, step])[0]
        direction = chord / np.linalg.norm(chord, axis=1, keepdims=True)
    return plan


def _ends(sheet: Sheet, plan: Array, direction: Array, left: Array, side: Array, turn: Array) -> Array:
    """Newton for the ends: |P − A| = side and (P − A)·left = side · turn; (k, 2)."""
    a, along_x, along_y = sheet(plan)
    xy = plan + side[:, None] * _plan_direction(along_x, along_y, direction)
    for _ in range(12):
        p, px, py = sheet(xy)
        d = p - a
        error = np.stack([0.5 * (np.sum(d * d, 1) - side**2), np.sum(d * left, 1) - side * turn], axis=1)
        rows = np.stack([d, left], axis=1)
        step = solve2(np.einsum("krc,kc->kr", rows, px), np.einsum("krc,kc->kr", rows, py), error)
        xy = xy - step
        if not np.nanmax(np.abs(step), initial=0.0) > 1e-10 * np.max(side):
            break
    return xy


def _plan_direction(along_x: Array, along_y: Array, direction: Array) -> Array:
    """The direction (k, 3) in terms of the two tangents, least squares; (k, 2)."""
    g11, g12, g22 = (np.sum(a * b, 1) for a, b in ((along_x, along_x), (along_x, along_y), (along_y, along_y)))
    right = np.stack([np.sum(along_x * direction, 1), np.sum(along_y * direction, 1)], axis=1)
    return solve2(np.stack([g11, g12], axis=1), np.stack([g12, g22], axis=1), right)


def solve2(first: Array, second: Array, right: Array) -> Array:
    """Solve k systems of 2 equations with the columns ``first``, ``second`` (k, 2) for ``right`` (k, 2); (k, 2)."""
    det = first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0]
    det = np.where(np.abs(det) > 1e-300, det, np.nan)
    a = (right[:, 0] * second[:, 1] - right[:, 1] * second[:, 0]) / det
    b = (first[:, 0] * right[:, 1] - first[:, 1] * right[:, 0]) / det
    return np.stack([a, b], axis=1)
