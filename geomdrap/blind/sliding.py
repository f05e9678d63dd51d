"""Yarns that slip at the crossings: weft sides as long as the shear beside them makes them.

Weft sides of length side/cos(γ)^s make the net's equations hyperbolic: what the warp does in one row depends on the
row below, at a place further out where the shear is positive. A cell that looks at its own shear alone cannot know
that place, and blows up whatever disturbs it. So a whole row of cells is solved at once, all its sides together: each
weft side takes the mean shear of the four corners that it touches, two of them in cells of the row on either side,
which is implicit, second order, and stable for sides of any length (J. Crank and P. Nicolson, 1947).

Rows begin at the weft generator and end beyond the rim, on the tool continued: what lies beyond the rim is what a
larger blank would do, and decides the net within.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from geomdrap.blind.sheet import Sheet
from geomdrap.blind.terms import Array

ROUNDS = 25
BAND = 3  # unknowns on either side that an equation knows of
MOST_SINE = 0.995  # of the shear of a side; beyond, the row ends
CLOSED = 1e-8  # of a side: what may be left of an equation


def grow_sliding(
    sheet: Sheet,
    reaches: Callable[[Array], NDArray[np.bool_]],
    axes: tuple[Array, Array],
    sides: tuple[Array, Array],
    slip: float,
) -> Array:
    """Fill quadrants row by row; plan points (q, m + 1, m + 1, 2), NaN where the ply does not get.

    ``axes`` and ``sides`` as for ``cells.grow``; ``reaches`` tells which plan points the continued tool still holds.
    """
    q, m = axes[0].shape[0], axes[0].shape[1] - 1
    plan = np.full((q, m + 1, m + 1, 2), np.nan)
    plan[:, :, 0], plan[:, 0, :] = axes
    for quad, warp, weft in zip(plan, *sides, strict=True):
        quad[_first_out(reaches(quad[:, 0])) :, 0] = np.nan
        for j in range(1, _first_out(reaches(quad[0]))):
            below = quad[: _first_out(np.isfinite(quad[:, j - 1, 0])), j - 1]
            guess = below + (below - quad[: len(below), j - 2] if j > 1 else quad[0, 1] - quad[0, 0])
            guess = np.where(np.isfinite(guess), guess, below + quad[0, j] - quad[0, j - 1])
            guess[0] = quad[0, j]
            row = _row(sheet, below, guess, warp[: len(below) - 1, j], weft[1 : len(below), j - 1], slip)
            end = _first_out(reaches(row))
            quad[1:end, j] = row[1:end]
    return plan


def _first_out(inside: NDArray[np.bool_]) -> int:
    """Index of the first that is out; their number where none is."""
    return int(np.logical_and.accumulate(inside).sum())


def _row(sheet: Sheet, below: Array, guess: Array, warp: Array, weft: Array, slip: float) -> Array:
    """Plan points (n + 1, 2) of the row above ``below``, of which the first is known; NaN from where none is found.

    ``warp`` (n,) and ``weft`` (n,): sides in mm that end in nodes 1 to n. A row that does not close is tried again
    without its outer end.
    """
    out = np.full(below.shape, np.nan)
    out[0] = guess[0]
    n = len(warp)
    while n > 0:
        row = guess[: n + 1].copy()
        closed = _solve(sheet, sheet(below[: n + 1])[0], row, warp[:n], weft[:n], slip)
        if closed.all():
            out[1 : n + 1] = row[1:]
            return out
        n = min(_first_out(closed), n - 1)
    return out


def _solve(sheet: Sheet, q: Array, row: Array, warp: Array, weft: Array, slip: float) -> NDArray[np.bool_]:
    """Newton for the nodes after the first of a row, in place; which of them (n,) close their cells well.

    q (n + 1, 3) are the points of the row below.
    """
    from scipy.linalg import LinAlgError, solve_banded

    size = float(np.max(warp))
    for _ in range(ROUNDS):
        p, px, py = sheet(row)
        error, blocks, sine = _equations(p, q, warp, weft, slip)
        tangents = np.stack([px, py], axis=2)
        matrix = _banded(blocks, tangents)
        if not (np.isfinite(matrix).all() and np.isfinite(error).all()):
            break
        try:
            step = solve_banded((BAND, BAND), matrix, error.ravel(), check_finite=False).reshape(-1, 2)
        except LinAlgError:
            break
        if not np.isfinite(step).all():
            break
        row[1:] -= np.clip(step, -0.5 * size, 0.5 * size)
        if np.abs(step).max() < 1e-10 * size:
            break
    closed: NDArray[np.bool_] = np.abs(error).max(axis=1) < CLOSED * size**2
    return closed & (np.abs(sine) < MOST_SINE)


def _equations(p: Array, q: Array, warp: Array, weft: Array, slip: float) -> tuple[Array, Array, Array]:
    """Errors (n, 2) of the warp and weft sides, mm²; their slopes (n, 2, 3, 3) with the nodes before, at and after;
    and the sine (n,) of the shear on the weft sides.
    """
    n = len(warp)
    along, up = np.diff(p, axis=0), (p - q)[1:]
    ahead, before = _unit(along), _unit(np.diff(q, axis=0))
    upward, size = _unit(up), np.linalg.norm(up, axis=1)
    inner = (np.arange(n) < n - 1)[:, None]
    count = np.where(inner, 4.0, 2.0)
    beside = ahead + before
    beside[:-1] += ahead[1:] + before[1:]
    beside = beside / count
    sine = np.clip(np.sum(upward * beside, axis=1), -MOST_SINE, MOST_SINE)
    longer = (1.0 - sine**2) ** -slip
    errors = np.stack([0.5 * (np.sum(along**2, 1) - warp**2), 0.5 * (size**2 - weft**2 * longer)], axis=1)
    turn = (beside - sine[:, None] * upward) / size[:, None]
    left = _across(upward, ahead, along) / count
    right = np.zeros_like(left)
    right[:-1] = _across(upward[:-1], ahead[1:], along[1:]) / 4.0
    growth = (weft**2 * slip * sine * longer / (1.0 - sine**2))[:, None]
    blocks = np.zeros((n, 2, 3, 3))
    blocks[:, 0, 0], blocks[:, 0, 1] = -along, along
    blocks[:, 1, 0] = growth * left
    blocks[:, 1, 1] = up - growth * (turn + left - right)
    blocks[:, 1, 2] = -growth * right
    return errors, blocks, sine


def _across(upward: Array, ahead: Array, along: Array) -> Array:
    """How the cosine between two unit vectors changes as the piece ``along`` of the second does; (n, 3)."""
    return (upward - np.sum(upward * ahead, 1)[:, None] * ahead) / np.linalg.norm(along, axis=1)[:, None]


def _banded(blocks: Array, tangents: Array) -> Array:
    """The matrix of ``scipy.linalg.solve_banded`` in plan coordinates of the nodes after the first.

    blocks (n, 2, 3, 3): equations by node before, at, after, by space; tangents (n + 1, 3, 2) of all nodes.
    """
    n = len(blocks)
    band = np.zeros((2 * BAND + 1, 2 * n))
    for beside in (-1, 0, 1):
        rows = np.arange(n)
        rows = rows[(rows + beside >= 0) & (rows + beside < n)]
        slopes = np.einsum("nes,nsd->ned", blocks[rows, :, beside + 1], tangents[1:][rows + beside])
        for e in (0, 1):
            for d in (0, 1):
                row, column = 2 * rows + e, 2 * (rows + beside) + d
                band[BAND + row - column, column] = slopes[:, e, d]
    return band


def _unit(vectors: Array) -> Array:
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)
