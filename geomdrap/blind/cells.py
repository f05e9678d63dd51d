"""Chord-length cells: from B and D, the point C of the sheet at given straight-line distances from both.

All four quadrants grow together, diagonal by diagonal, so that each step solves many cells at once.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from geomdrap.blind.lines import solve2
from geomdrap.blind.sheet import Sheet
from geomdrap.blind.terms import Array

ITERATIONS = 30
SMALLEST_SINE = 0.1  # between warp and weft where a cell still counts: shear below 84°


def grow(
    sheet: Sheet,
    holds: Callable[[Array], NDArray[np.bool_]],
    axes: tuple[Array, Array],
    sides: tuple[Array, Array],
) -> Array:
    """Fill quadrants with cells; plan points (q, m + 1, m + 1, 2), NaN where the ply does not get.

    axes: plan points (q, m + 1, 2) along the warp and weft half-axes of each quadrant.
    sides: warp sides (q, m, m + 1), weft sides (q, m + 1, m): lengths in mm of the side that ends in node
    (i + 1, j), and in (i, j + 1).
    """
    q, m = axes[0].shape[0], axes[0].shape[1] - 1
    plan = np.full((q, m + 1, m + 1, 2), np.nan)
    for axis, target in zip(axes, (plan[:, :, 0], plan[:, 0, :]), strict=True):
        target[...] = _until_it_leaves(axis, holds)
    for diagonal in range(2, 2 * m + 1):
        i = np.arange(max(1, diagonal - m), min(m, diagonal - 1) + 1)
        j = diagonal - i
        quadrant, at = np.nonzero(np.isfinite(plan[:, i - 1, j, 0] + plan[:, i, j - 1, 0] + plan[:, i - 1, j - 1, 0]))
        if at.size == 0:
            continue
        i, j = i[at], j[at]
        corner, left, below = plan[quadrant, i - 1, j - 1], plan[quadrant, i - 1, j], plan[quadrant, i, j - 1]
        warp, weft = sides[0][quadrant, i - 1, j], sides[1][quadrant, i, j - 1]
        found = _fourth(sheet, corner, left, below, warp, weft)
        found[~holds(found)] = np.nan
        plan[quadrant, i, j] = found
    return plan


def _until_it_leaves(axis: Array, holds: Callable[[Array], NDArray[np.bool_]]) -> Array:
    """The axis (q, m + 1, 2) up to the last node before it leaves the tool."""
    inside = np.logical_and.accumulate(holds(axis), axis=1)
    return np.where(inside[..., None], axis, np.nan)


def _fourth(sheet: Sheet, corner: Array, left: Array, below: Array, warp: Array, weft: Array) -> Array:
    """Newton for the fourth corners C (n, 2): |C − left| = warp side, |C − below| = weft side."""
    a, b, d = (sheet(plan)[0] for plan in (corner, left, below))
    xy = left + below - corner
    for _ in range(ITERATIONS):
        p, px, py = sheet(xy)
        from_left, from_below = p - b, p - d
        gaps = (np.sum(from_left**2, 1) - warp**2, np.sum(from_below**2, 1) - weft**2)
        rows = np.stack([from_left, from_below], axis=1)
        by_x, by_y = (np.einsum("nrc,nc->nr", rows, t) for t in (px, py))
        step = solve2(by_x, by_y, 0.5 * np.stack(gaps, axis=1))
        xy = xy - np.clip(step, -0.5 * np.max(warp), 0.5 * np.max(warp))
        if not np.nanmax(np.abs(step), initial=0.0) > 1e-9 * np.max(warp):
            break
    p = sheet(xy)[0]
    good = np.abs(np.linalg.norm(p - b, axis=1) - warp) < 1e-6 * warp
    good &= np.abs(np.linalg.norm(p - d, axis=1) - weft) < 1e-6 * weft
    good &= _sine(d - a, b - a, p - b, p - d) ** 2 < 1.0 - SMALLEST_SINE**2
    good &= np.sum((p - a) * (0.5 * (b + d) - a), axis=1) > 0.0  # not folded back onto the first corner
    return np.where(good[:, None], xy, np.nan)


def _sine(warp: Array, weft: Array, warp_far: Array, weft_far: Array) -> Array:
    """sin γ of cells: the mean over the corner at the seed's side and the one across; (n,)."""
    return np.clip(0.5 * (_cosine(warp, weft) + _cosine(warp_far, weft_far)), -0.999, 0.999)


def _cosine(a: Array, b: Array) -> Array:
    return np.sum(a * b, 1) / np.sqrt(np.sum(a * a, 1) * np.sum(b * b, 1))
