"""Where the seams of a pattern lie that is higher than the roll of fabric is wide.

As few strips as will do leave some room, by which the seams can slide. A seam is a weak and stiff line, worst where
the fabric must shear, so each costs its length, and where the fabric shears up to the limit angle that counts twice.
Of all positions with the least sum the one with even strips is taken, and no strip is narrower than a quarter of the
roll, which always leaves a choice.
"""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np

from geomdrap.errors import DrapeError

MOST = 100
"""Strips; more are a slip in the unit."""
STEPS = 96
"""Positions that are tried for each seam, about."""
NARROWEST = 0.25
"""Of the roll's width: narrower strips are hard to lay."""
EVEN = 1e-3
"""mm of seam that a strip of the roll's width is worth where strips differ: it decides between equals."""


def strips_needed(height: float, width: float, overlap: float) -> int:
    """Least number of strips ``width`` mm wide that overlap by ``overlap`` mm and together are ``height`` mm high.

    Raises DrapeError for more strips than can be meant.
    """
    needed = max(1, math.ceil((height - overlap) / (width - overlap) - 1e-9))
    if needed > MOST:
        raise DrapeError(
            f"the flat pattern, {height:.4g} mm along the weft, takes {needed} strips of a roll {width:g} mm wide, "
            f"more than the {MOST} that can be laid: --roll-width is in mm"
        )
    return needed


def place_seams(
    low: float, high: float, width: float, overlap: float, cost: Callable[[float], float]
) -> np.ndarray:
    """Levels v (n - 1,) mm, rising, of the seams between the fewest strips that cover ``low`` to ``high``.

    A seam is the middle of its overlap. ``cost`` gives what a seam at a level costs, in mm of its length. The sum is
    least over all ways to set the seams on evenly spaced positions, one of which makes the strips even.
    """
    n = strips_needed(high - low, width, overlap)
    if n == 1:
        return np.zeros(0)
    slack = max(n * (width - overlap) + overlap - (high - low), 0.0)
    steps = n * math.ceil(STEPS / n)
    offsets = slack * np.arange(steps + 1) / steps
    lowest = high - np.arange(n - 1, 0, -1) * (width - overlap) - 0.5 * overlap
    levels = lowest[:, None] + offsets
    costs = np.array([[cost(v) for v in row] for row in levels])
    return levels[np.arange(n - 1), _cheapest(levels, costs, low, high, width, overlap)]


def _cheapest(
    levels: np.ndarray, costs: np.ndarray, low: float, high: float, width: float, overlap: float
) -> np.ndarray:
    """Numbers (n - 1,) of the levels (n - 1, m) with the least sum, seam by seam (dynamic programming)."""
    last = len(levels) - 1
    best = costs[0] + _strip_cost(levels[0] + 0.5 * overlap - low, width)
    came_from = np.zeros(levels.shape, int)
    for k in range(1, last + 1):
        through = best[:, None] + _strip_cost(levels[k] - levels[k - 1][:, None] + overlap, width)
        came_from[k] = through.argmin(axis=0)
        best = through.min(axis=0) + costs[k]
    best = best + _strip_cost(high - levels[last] + 0.5 * overlap, width)
    chosen = np.zeros(last + 1, int)
    chosen[last] = best.argmin()
    for k in range(last, 0, -1):
        chosen[k - 1] = came_from[k, chosen[k]]
    return chosen


def _strip_cost(height: np.ndarray, width: float) -> np.ndarray:
    """What strips of a height cost: next to nothing, less together if even; more than anything if not possible."""
    possible = (height <= width * (1.0 + 1e-9)) & (height >= NARROWEST * width)
    return np.where(possible, EVEN * height**2 / width, np.inf)
