"""Which yarns to draw so that a net reads as a net, and as smooth lines in space."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from geomdrap.fishnet import Net

Floats = NDArray[np.float64]

STEPS = (1, 2, 5, 10, 20, 50, 100, 200, 500, 1000)


@dataclass(frozen=True)
class Yarns:
    """Every `every`-th yarn of each family as polylines (k, 3), mm, with NaN rows at gaps."""

    warp: tuple[Floats, ...]
    weft: tuple[Floats, ...]
    every: int


def every_so_many(net: Net, least_spacing: float) -> int:
    """1, 2, 5, 10 … so that the yarns drawn lie at least `least_spacing` mm apart."""
    return next((step for step in STEPS if step * net.pitch >= least_spacing), STEPS[-1])


def choose_yarns(net: Net, least_spacing: float) -> Yarns:
    """The yarns through the origin and every so-many-th from there, smoothed between the nodes."""
    every = every_so_many(net, least_spacing)
    rows = drawn_numbers(net.u, every)
    columns = drawn_numbers(net.v, every)
    warp = tuple(smooth(net.points[:, j]) for j in columns)
    weft = tuple(smooth(net.points[i, :]) for i in rows)
    return Yarns(warp, weft, every)


def drawn_numbers(coordinate: Floats, every: int) -> list[int]:
    """Numbers of every so-many-th entry of u or v (n,), counted from the one at 0."""
    middle = int(np.argmin(np.abs(coordinate)))
    return list(range(middle % every, len(coordinate), every))


def smooth(nodes: Floats, parts: int = 4) -> Floats:
    """Cubic through the nodes (k, 3), `parts` pieces between two: (parts·(k−1)+1, 3).

    A chord between nodes cuts through a curved tool by pitch²/8R; the cubic stays on it to fourth order.
    At the ends of a yarn and beside gaps (NaN) the missing neighbour is mirrored.
    """
    if len(nodes) < 2:
        return nodes
    start, end = nodes[:-1], nodes[1:]
    before = np.vstack([2 * nodes[:1] - nodes[1:2], nodes[:-2]])
    after = np.vstack([nodes[2:], 2 * nodes[-1:] - nodes[-2:-1]])
    before = np.where(np.isnan(before), 2 * start - end, before)
    after = np.where(np.isnan(after), 2 * end - start, after)
    t = (np.arange(parts) / parts)[None, :, None]
    a, b, c, d = before[:, None], start[:, None], end[:, None], after[:, None]
    curve = 0.5 * (2 * b + (c - a) * t + (2 * a - 5 * b + 4 * c - d) * t**2 + (3 * (b - c) + d - a) * t**3)
    return np.vstack([curve.reshape(-1, 3), nodes[-1:]])
