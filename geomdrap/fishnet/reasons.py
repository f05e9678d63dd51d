"""Why nodes that nothing reached are absent: they take the reason of those before them."""

from __future__ import annotations

import numpy as np

from geomdrap.fishnet.grid import STATUS, Grid
from geomdrap.fishnet.march import IS_BEHIND_FOLD, IS_FOLDED, UNREACHED
from geomdrap.fishnet.place import PRESENT
from geomdrap.geodesic.compiled import inlined, kernel, tight


@kernel
def say_why(grid: Grid) -> None:
    """Give the nodes around the net that nothing reached the reason of those before them; folds come last."""
    spread(grid, False)
    spread(grid, True)


@inlined
def reason_to_carry(status: int, folds: bool) -> int:
    """The reason that a node beside one with this status takes, UNREACHED for none."""
    if status in (UNREACHED, PRESENT):
        return UNREACHED
    if status in (IS_FOLDED, IS_BEHIND_FOLD):
        return IS_BEHIND_FOLD if folds else UNREACHED
    return status


@kernel
def spread(grid: Grid, folds: bool) -> None:
    """Carry reasons outward in rounds, the greatest where several come together, until no node takes one any more."""
    i0, i1 = max(grid.box[0] - 1, 0), min(grid.box[1] + 1, grid.face.shape[0] - 1)
    j0, j1 = max(grid.box[2] - 1, 0), min(grid.box[3] + 1, grid.face.shape[1] - 1)
    size = (i1 - i0 + 1) * (j1 - j0 + 1)
    front, reached = np.empty((size, 2), np.int32), np.empty((size, 2), np.int32)
    coming = np.zeros((i1 - i0 + 1, j1 - j0 + 1), np.uint8)
    spread_in(grid, folds, (i0, i1, j0, j1), front, reached, coming)


@tight
def spread_in(
    grid: Grid,
    folds: bool,
    window: tuple[int, int, int, int],
    front: np.ndarray,
    reached: np.ndarray,
    coming: np.ndarray,
) -> None:
    """``spread`` within a window i0, i1, j0, j1; ``front`` and ``reached`` (n, 2) are room, ``coming`` is zero."""
    i0, i1, j0, j1 = window
    count = 0
    for i in range(i0, i1 + 1):
        for j in range(j0, j1 + 1):
            if reason_to_carry(grid.marks[i, j, STATUS], folds) != UNREACHED:
                front[count, 0], front[count, 1] = i, j
                count += 1
    while count > 0:
        new = 0
        for n in range(count):
            why = reason_to_carry(grid.marks[front[n, 0], front[n, 1], STATUS], folds)
            for di, dj in ((1, 0), (0, 1), (-1, 0), (0, -1)):
                i, j = front[n, 0] + di, front[n, 1] + dj
                if i0 <= i <= i1 and j0 <= j <= j1 and grid.marks[i, j, STATUS] == UNREACHED:
                    if coming[i - i0, j - j0] == 0:
                        reached[new, 0], reached[new, 1] = i, j
                        new += 1
                    coming[i - i0, j - j0] = max(coming[i - i0, j - j0], why)
        for n in range(new):
            i, j = reached[n, 0], reached[n, 1]
            grid.marks[i, j, STATUS] = coming[i - i0, j - j0]
            front[n, 0], front[n, 1] = i, j
        count = new
