"""How yarns turn from cell to cell, so that they can be carried on beyond the net at second order.

In a net of equal sides each family of yarns is carried parallel along the other one, and along itself it turns as
fast as the shear grows: with γ the shear, the geodesic curvature of the warp is ∂γ/∂u and that of the weft -∂γ/∂v
(P. L. Chebyshev, Sur la coupe des vêtements, 1878). So the gradient of the shear is all that is needed.
"""

from __future__ import annotations

import math

import numpy as np

from geomdrap.geodesic.compiled import inlined, kernel

JUMP = 3.0  # times the differences beside it: a larger one is no slope to go on with
BESIDE = 2  # cells: how far across its axis a slope is carried on
AROUND = 4  # cells: how far from a point the nearest cell with a gradient is looked for


@inlined
def lesser(a: float, b: float) -> float:
    """The smaller of two slopes of one sign, else 0 (minmod): a jump at an edge is no slope to go on with."""
    if math.isnan(a) or math.isnan(b):
        return b if math.isnan(a) else a
    return 0.0 if a * b <= 0.0 else a if abs(a) < abs(b) else b


@kernel
def limited(before: float, here: float, after: float) -> float:
    """A difference, or where it is a jump next to those before and after it, the lesser of them."""
    if math.isnan(here):
        return here
    most = JUMP * max(0.0 if math.isnan(before) else abs(before), 0.0 if math.isnan(after) else abs(after))
    if (math.isnan(before) and math.isnan(after)) or abs(here) <= most:
        return here
    return lesser(before, after)


@kernel
def shear_gradients(shear: np.ndarray) -> np.ndarray:
    """Growth of the cells' ``shear`` (nu - 1, nv - 1) from each to the next, per cell: (nu, nv, 2), NaN if unknown.

    ``[i, j, 0]`` is that from the middle of cell (i - 1, j) to that of (i, j), ``[i, j, 1]`` from (i, j - 1) to it:
    what is added up on two ways comes to the same. Jumps, as behind the tip of a cone, are left out.
    """
    nu, nv = shear.shape
    steps = np.full((nu + 2, nv + 2, 2), math.nan)
    steps[2:nu + 1, 1:nv + 1, 0] = shear[1:] - shear[:-1]
    steps[1:nu + 1, 2:nv + 1, 1] = shear[:, 1:] - shear[:, :-1]
    out = np.full((nu + 1, nv + 1, 2), math.nan)
    for i in range(1, nu + 1):
        for j in range(1, nv + 1):
            out[i - 1, j - 1, 0] = limited(steps[i - 1, j, 0], steps[i, j, 0], steps[i + 1, j, 0])
            out[i - 1, j - 1, 1] = limited(steps[i, j - 1, 1], steps[i, j, 1], steps[i, j + 1, 1])
    return out


@inlined
def slope_in(gradient: np.ndarray, i: int, j: int, axis: int) -> float:
    """Entry of ``shear_gradients``, NaN outside."""
    return gradient[i, j, axis] if 0 <= i < gradient.shape[0] and 0 <= j < gradient.shape[1] else math.nan


@kernel
def slope_beside(gradient: np.ndarray, i: int, j: int, axis: int) -> float:
    """Slope along an axis at (i, j) of ``shear_gradients``, or carried on to it across that axis, NaN if far.

    Across its axis a slope changes with the Gaussian curvature alone (γ_uv = -K cos γ): on a wall, not at all.
    """
    di, dj = axis, 1 - axis
    for away in range(BESIDE + 1):
        total, count = 0.0, 0
        for sense in (-1, 1):
            k, m = i + sense * away * di, j + sense * away * dj
            near = slope_in(gradient, k, m, axis)
            if math.isnan(near):
                continue
            next1 = slope_in(gradient, k + sense * di, m + sense * dj, axis)
            next2 = slope_in(gradient, k + 2 * sense * di, m + 2 * sense * dj, axis)
            change = lesser(near - next1, next1 - next2)
            total, count = total + near + (0.0 if math.isnan(change) else away * change), count + 1
        if count > 0:
            return total / count
    return math.nan


@kernel
def mean_of_ring(gradient: np.ndarray, i: int, j: int, axis: int) -> float:
    """Mean slope along an axis of the nearest ring around (i, j) where it is known, 0 if that is far."""
    for ring in range(AROUND + 1):
        total, count = 0.0, 0
        for k in range(max(i - ring, 0), min(i + ring + 1, gradient.shape[0])):
            for m in range(max(j - ring, 0), min(j + ring + 1, gradient.shape[1])):
                if max(abs(k - i), abs(m - j)) == ring and not math.isnan(gradient[k, m, axis]):
                    total, count = total + gradient[k, m, axis], count + 1
        if count > 0:
            return total / count
    return 0.0


@kernel
def slope_near(gradient: np.ndarray, i: int, j: int, axis: int) -> float:
    """``slope_beside``, or beyond the net the least of the three slopes before its rim, off its corners a mean.

    There are three of them: a jump between two cells, as behind the tip of a cone, gives two of one sign.
    """
    here = slope_beside(gradient, i, j, axis)
    if not math.isnan(here):
        return here
    for away in range(1, AROUND + 1):
        total, count = 0.0, 0
        for sense in (-1, 1):
            least = math.nan
            for n in range(3):
                step = sense * (away + n)
                k, m = (i + step, j) if axis == 0 else (i, j + step)
                found = slope_beside(gradient, k, m, axis)
                if n == 0 and math.isnan(found):
                    break
                least = found if n == 0 else lesser(least, found)
            if not math.isnan(least):
                total, count = total + least, count + 1
        if count > 0:
            return total / count
    return mean_of_ring(gradient, i, j, axis)


@inlined
def gradient_near(gradient: np.ndarray, p: float, q: float) -> tuple[float, float]:
    """The gradient (2,) of the shear at or nearest to (p, q), of ``shear_gradients``."""
    i, j = int(math.floor(p)), int(math.floor(q))
    return (
        slope_near(gradient, int(math.floor(p + 0.5)), j, 0),
        slope_near(gradient, i, int(math.floor(q + 0.5)), 1),
    )


@inlined
def slope_kept(gradient: np.ndarray, known: np.ndarray, i: int, j: int, axis: int) -> float:
    """``slope_near``, found once for each place of the net and kept in ``known``, NaN where it is not."""
    if not (0 <= i < known.shape[0] and 0 <= j < known.shape[1]):
        return slope_near(gradient, i, j, axis)
    if math.isnan(known[i, j, axis]):
        known[i, j, axis] = slope_near(gradient, i, j, axis)
    return known[i, j, axis]


@kernel
def turn_by(vector: np.ndarray, normal: np.ndarray, angle_rad: float, out: np.ndarray) -> None:
    """Turn a vector (3,) across a unit normal counter-clockwise about it."""
    c, s = math.cos(angle_rad), math.sin(angle_rad)
    x = c * vector[0] + s * (normal[1] * vector[2] - normal[2] * vector[1])
    y = c * vector[1] + s * (normal[2] * vector[0] - normal[0] * vector[2])
    out[2] = c * vector[2] + s * (normal[0] * vector[1] - normal[1] * vector[0])
    out[0], out[1] = x, y


@kernel
def one_sided(valid: np.ndarray, i: int, j: int, di: int, dj: int) -> int:
    """1 where a yarn along (di, dj) ends at node (i, j) of the net, -1 where it begins there, else 0."""
    behind = ahead = False
    for side in range(2):
        k, m = i - (1 - di) * side, j - (1 - dj) * side  # the cells ahead of the node, on both sides of the yarn
        if 0 <= k < valid.shape[0] and 0 <= m < valid.shape[1]:
            ahead = ahead or valid[k, m]
        k, m = k - di, m - dj
        if 0 <= k < valid.shape[0] and 0 <= m < valid.shape[1]:
            behind = behind or valid[k, m]
    return int(behind) - int(ahead)


@kernel
def complete_ends(yarns: np.ndarray, valid: np.ndarray, gradient: np.ndarray) -> np.ndarray:
    """Yarn directions (2, nu, nv, 3) with those at the ends of yarns brought from half a cell before the node to it.

    Inside the net a node's direction is the mean of how the yarn arrives and goes on; at its end, only the one is
    known, which is the direction in the middle of the last side.
    """
    out = yarns.copy()
    normal, vector = np.empty(3), np.empty(3)
    for i in range(yarns.shape[1]):
        for j in range(yarns.shape[2]):
            ends_u, ends_v = one_sided(valid, i, j, 1, 0), one_sided(valid, i, j, 0, 1)
            warp, weft = yarns[0, i, j], yarns[1, i, j]
            if (ends_u == 0 and ends_v == 0) or math.isnan(warp[0]) or math.isnan(weft[0]):
                continue
            normal[0] = warp[1] * weft[2] - warp[2] * weft[1]
            normal[1] = warp[2] * weft[0] - warp[0] * weft[2]
            normal[2] = warp[0] * weft[1] - warp[1] * weft[0]
            normal /= math.sqrt((normal**2).sum())
            along_u, along_v = gradient_near(gradient, i - 0.5 * ends_u, j - 0.5 * ends_v)
            turn_by(warp, normal, 0.5 * ends_u * along_u, vector)
            out[0, i, j] = vector
            turn_by(weft, normal, -0.5 * ends_v * along_v, vector)
            out[1, i, j] = vector
    return out


@kernel
def bend_cells(at: np.ndarray, yarns: np.ndarray, gradient: np.ndarray) -> None:
    """Correct coordinates (n, 2) found between straight cell sides for the bending of the yarns in the surface.

    A yarn that turns by κ per cell lies κ s (1 - s) / 2 of a cell beside the chord at the share s of a side.
    """
    known = np.full(gradient.shape, np.nan)  # many vertices ask for the same slopes
    for v in range(len(at)):
        if math.isnan(at[v, 0]):
            continue
        i = min(max(int(math.floor(at[v, 0])), 0), gradient.shape[0] - 2)
        j = min(max(int(math.floor(at[v, 1])), 0), gradient.shape[1] - 2)
        s, t = at[v, 0] - i, at[v, 1] - j
        k, m = min(int(s + 0.5), 1), min(int(t + 0.5), 1)
        cosine = 0.0
        for c in range(3):
            cosine += yarns[0, i + k, j + m, c] * yarns[1, i + k, j + m, c]
        sine = math.sqrt(1.0 - cosine * cosine)
        along_u = slope_kept(gradient, known, int(math.floor(at[v, 0] + 0.5)), int(math.floor(at[v, 1])), 0)
        along_v = slope_kept(gradient, known, int(math.floor(at[v, 0])), int(math.floor(at[v, 1] + 0.5)), 1)
        left = -0.5 * s * (1.0 - s) * along_u  # of the chord of the warp; of the weft's, the other sign
        right = -0.5 * t * (1.0 - t) * along_v
        # across the warp is (weft - cosine warp) / sine, across the weft (cosine weft - warp) / sine
        dp, dq = (-left * cosine + right) / sine, (left - right * cosine) / sine
        if abs(dp) < 0.5 and abs(dq) < 0.5:
            at[v, 0], at[v, 1] = at[v, 0] - dp, at[v, 1] - dq
