"""The flat pattern: contours, yarn lines and locked zones in the plane of the fabric."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geomdrap.fields.contour import clip_to_rectangle, outlines, signed_area, simplify
from geomdrap.fields.cut_lines import shut_cuts
from geomdrap.fields.result import FlatPattern

if TYPE_CHECKING:
    from geomdrap.fields.trim import Trimmed
    from geomdrap.fishnet import Net

STRAIGHT = 1e-4  # mm by which a contour point may be left out of a straight line
SPECK = 1e-6  # cells: smaller openings are rounding, not openings


def flat_pattern(net: Net, trimmed: Trimmed, limit_angle: float) -> FlatPattern:
    """Flat pattern of a trimmed net."""
    mesh = trimmed.mesh
    cells = trimmed.at / net.pitch
    rings = [r * net.pitch for r in outlines(cells, trimmed.kind, mesh.neighbours, mesh.neighbour_edge)]
    if net.reach is not None:
        rings = [clip_to_rectangle(r, (float(net.reach[0]), float(net.reach[1]))) for r in rings]
    rings = [simplify(r, STRAIGHT) for r in rings if len(r) > 2]
    areas = [signed_area(r) for r in rings]
    least = SPECK * net.pitch**2
    outer = tuple(r for r, a in zip(rings, areas, strict=True) if a > least)
    inner = tuple(r for r, a in zip(rings, areas, strict=True) if a < -least)
    contours = (*outer, *inner)
    return FlatPattern(
        outer=outer,
        inner=inner,
        warp_lines=yarn_lines(contours, net.v, 1),
        weft_lines=yarn_lines(contours, net.u, 0),
        locked=locked_zones(net, limit_angle),
        cuts=shut_cuts(trimmed, net.pitch, net.reach) if net.surface.cuts else (),
    )


def yarn_lines(contours: tuple[np.ndarray, ...], levels: np.ndarray, axis: int) -> tuple[np.ndarray, ...]:
    """Stretches (2, 2) of the lines ``coordinate[axis] = level`` that lie inside the contours (even-odd rule)."""
    if not contours:
        return ()
    ends = [(c, np.roll(c, -1, axis=0)) for c in contours]
    a = np.concatenate([e[0] for e in ends])
    b = np.concatenate([e[1] for e in ends])
    lines = []
    for level in levels:
        over_a, over_b = a[:, axis] > level, b[:, axis] > level
        rows = np.flatnonzero(over_a != over_b)
        share = (level - a[rows, axis]) / (b[rows, axis] - a[rows, axis])
        cuts = np.sort(a[rows, 1 - axis] + share * (b[rows, 1 - axis] - a[rows, 1 - axis]))
        for low, high in zip(cuts[::2], cuts[1::2], strict=False):
            line = np.full((2, 2), float(level))
            line[:, 1 - axis] = low, high
            lines.append(line)
    return tuple(lines)


def locked_zones(net: Net, limit_angle: float) -> tuple[np.ndarray, ...]:
    """Outlines (k, 2) mm of the groups of cells whose shear exceeds the limit angle."""
    over = np.abs(np.nan_to_num(net.cell_shear)) > limit_angle
    if not over.any():
        return ()
    i, j = np.nonzero(over)
    low = np.column_stack([i, j]).astype(float)
    square = np.array([[0, 0], [1, 0], [1, 1], [0, 1]], float)
    corners = low[:, None] + square
    halves = np.concatenate([corners[:, [0, 1, 2]], corners[:, [0, 2, 3]]])
    n = len(low)
    number = np.full(over.shape, -1)
    number[i, j] = np.arange(n)
    padded = np.pad(number, 1, constant_values=-1)
    south, north = padded[1:-1, :-2][i, j], padded[1:-1, 2:][i, j]
    west, east = padded[:-2, 1:-1][i, j], padded[2:, 1:-1][i, j]
    # lower half: edges south, east, diagonal; upper half: diagonal, north, west
    up = np.arange(n) + n
    beside = np.concatenate(
        [
            np.column_stack([np.where(south >= 0, south + n, -1), np.where(east >= 0, east + n, -1), up]),
            np.column_stack([np.arange(n), north, west]),
        ]
    )
    edge = np.concatenate([np.tile([1, 2, 0], (n, 1)), np.tile([2, 0, 1], (n, 1))])
    kind = np.ones(2 * n, np.uint8)
    rings = outlines(halves, kind, beside.astype(np.int32), edge.astype(np.int8))
    origin = np.array([net.u[0], net.v[0]])
    return tuple(simplify(origin + r * net.pitch, STRAIGHT) for r in rings if signed_area(r) > 0.0)
