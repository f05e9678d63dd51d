"""Lines of the grid of marks whose labels are off by one mark: beside one another none of them stands out.

Found are single lines of which most marks are off. Two lines beside one another that are off, and a line labelled as
the next one, are not.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.measurement.marks import mark_spacing

if TYPE_CHECKING:
    from geomdrap.fishnet import Net
    from geomdrap.measurement.measurement import Measurement

FEWEST = 4
"""Marks of a line, and lines of a grid, from which on a line is judged."""
BETTER = 0.4
"""Of the spacing: a line is off those beside it by less with the right labels, and all other lines with their own."""
OFF = 0.7
"""Of the spacing: a line that is off the lines beside it by less is no mark off."""


def wrong_lines(net: Net, measurement: Measurement) -> dict[int, tuple[tuple[int, int], float]]:
    """By row: the marks (along warp, weft) by which its label must be moved, as most of its line, and mm it is off.

    Off the marks of the lines beside it; off the prediction where there are none.
    """
    if measurement.u is None or measurement.v is None:
        return {}
    steps = mark_spacing(measurement.u), mark_spacing(measurement.v)
    if steps[0] is None or steps[1] is None:
        return {}
    size = np.array([steps[0], steps[1]])
    labels = np.column_stack([measurement.u, measurement.v])
    grid = np.round(labels / size).astype(int)
    present = _residual(net, measurement.points, labels)
    out: dict[int, tuple[tuple[int, int], float]] = {}
    for along in (0, 1):
        shifts = [np.eye(2, dtype=int)[along] * way for way in (-1, 1)]
        moved = [_residual(net, measurement.points, labels + shift * size) for shift in shifts]
        trend = _beside(grid, 1 - along, present)
        for rows, best in _off_by_one(grid[:, 1 - along], present, moved, trend, float(size[along])):
            shift = (int(shifts[best][0]), int(shifts[best][1]))
            off = _beyond(present, trend)
            out.update({row: (shift, float(off[row])) for row in np.flatnonzero(rows & np.isfinite(off)).tolist()})
    return out


def _beyond(residual: np.ndarray, trend: np.ndarray) -> np.ndarray:
    """Length (n,) mm of residuals (n, 3) off the ``trend`` of the lines beside, or as they are where that is NaN."""
    return np.asarray(np.linalg.norm(residual - np.where(np.isfinite(trend), trend, 0.0), axis=1))


def _off_by_one(
    line: np.ndarray, present: np.ndarray, moved: list[np.ndarray], trend: np.ndarray, step: float
) -> Iterator[tuple[np.ndarray, int]]:
    """Rows (n,) bool of lines that are a mark off, and which of the ``moved`` residuals (n, 3) they go with.

    Marks of such a line that are nearer as they are, as those before a mark that was skipped, are none of them.
    ``line`` (n,) numbers the lines; ``trend`` (n, 3) is the residual of the lines beside.
    """
    levels = np.unique(line).tolist()
    usual = float(np.median([_typical((present - trend)[line == k]) for k in levels]))
    if len(levels) < FEWEST or not usual < BETTER * step:
        return
    for k in levels:
        rows = line == k
        left = [_typical((one - trend)[rows]) for one in moved]
        best = int(np.argmin(left))
        # the part must say so too: beside a line that is off, a right one at the rim is off it as well
        nearer = _typical(moved[best][rows]) < _typical(present[rows])
        if nearer and _typical((present - trend)[rows]) > OFF * step and left[best] < BETTER * step:
            now, then = _beyond(present, trend), _beyond(moved[best], trend)
            off = rows & np.where(np.isfinite(then), then < now, now > OFF * step)
            if off.sum() >= FEWEST:
                yield off, best


def _residual(net: Net, points: np.ndarray, labels: np.ndarray) -> np.ndarray:
    """What points (n, 3) are off by from where labels (n, 2) are predicted; NaN where they are not."""
    return np.asarray(points - net.interpolate(labels[:, 0], labels[:, 1])[0])


def _beside(grid: np.ndarray, across: int, residual: np.ndarray) -> np.ndarray:
    """Mean residual (n, 3) of the marks on either side of each, one line further; NaN where there are none.

    ``grid`` (n, 2) whole numbers of the marks; ``across`` the axis along which the next line lies.
    """
    row = {tuple(mark): k for k, mark in enumerate(grid.tolist()) if np.isfinite(residual[k]).all()}
    step = [1 - across, across]
    out = np.full(residual.shape, np.nan)
    for k, (i, j) in enumerate(grid.tolist()):
        near = [row.get((i + way * step[0], j + way * step[1])) for way in (-1, 1)]
        there = [residual[n] for n in near if n is not None]
        out[k] = np.mean(there, axis=0) if there else np.nan
    return out


def _typical(vectors: np.ndarray) -> float:
    """Median length of the vectors (n, 3) that are known; infinite for too few of them."""
    length = np.linalg.norm(vectors, axis=1)
    known = length[np.isfinite(length)]
    return float(np.median(known)) if len(known) >= FEWEST else float("inf")
