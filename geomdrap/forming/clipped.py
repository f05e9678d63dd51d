"""Specimens cut from the cloth at an angle: cells along the yarns, clipped by the rectangle of the specimen.

Sides of cells stay on yarns, since triangles across the yarns would lock in shear (X. Yu et al., Composites A 37
(2006) 790). What the cut leaves of a cell keeps its share of the yarns of both families, in the pieces that are left
of its sides.
"""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import FormingError
from geomdrap.forming.sheet import Sheet

Array = NDArray[np.float64]
Point = tuple[float, float]

SNAP = 1e-6
"""Share of the pitch within which points are one."""
SLIVER = 0.02
"""What the cut leaves of a cell is dropped below this share of it: it would only be a small, stiff triangle."""


def strip(length: float, width: float, angle: float, pitch: float) -> Sheet:
    """A strip of ``width`` × ``length`` mm along x and y, the warp at ``angle`` degrees from its length.

    Warp runs at 90° − angle from +x, weft 90° further, so that pulling along y closes them: positive shear. The
    middle of the strip is the origin; fabric coordinates are measured from its lower left corner. ``pitch`` mm is the
    side of a cell. FormingError where the strip holds no whole cell.
    """
    if not (min(length, width, pitch) > 0.0 and 0.0 <= angle <= 90.0):
        raise FormingError(
            "a strip needs length, width and pitch above 0 mm and an angle from 0 to 90 degrees; got "
            f"{length:g}, {width:g}, {pitch:g} and {angle:g}"
        )
    turn = math.radians(90.0 - angle)
    axes = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    corners = np.array([[0.0, 0.0], [width, 0.0], [width, length], [0.0, length]]) @ axes.T
    low, high = np.floor(corners.min(axis=0) / pitch - 1e-9), np.ceil(corners.max(axis=0) / pitch + 1e-9)
    kept = [
        (polygon, side)
        for i, j in itertools.product(range(int(low[0]), int(high[0])), range(int(low[1]), int(high[1])))
        if (polygon := _clipped(i, j, pitch, corners)) is not None
        for side in [(i * pitch, j * pitch)]
    ]
    if not kept:
        raise FormingError(f"a pitch of {pitch:g} mm is too coarse for a strip of {length:g} × {width:g} mm")
    sheet = _joined(kept, pitch)
    place = sheet.fabric @ axes - [0.5 * width, 0.5 * length]
    return sheet.moved(np.column_stack([place, np.zeros(len(place))]))


def _clipped(i: int, j: int, pitch: float, corners: Array) -> list[Point] | None:
    """The cell i, j within the convex polygon ``corners``, counter-clockwise; None where next to nothing is left."""
    polygon = [((i + a) * pitch, (j + b) * pitch) for a, b in ((0, 0), (1, 0), (1, 1), (0, 1))]
    for a, b in zip(corners, np.roll(corners, -1, axis=0), strict=True):
        polygon = _cut(polygon, a, (b - a) / np.linalg.norm(b - a), SNAP * pitch)
    return polygon if len(polygon) > 2 and _area(polygon) > SLIVER * pitch * pitch else None


def _cut(polygon: list[Point], start: Array, along: Array, tolerance: float) -> list[Point]:
    """What of a convex polygon lies to the left of a line (Sutherland and Hodgman)."""
    left = [along[0] * (y - start[1]) - along[1] * (x - start[0]) for x, y in polygon]
    left = [0.0 if abs(d) < tolerance else d for d in left]
    kept: list[Point] = []
    for k, (p, d) in enumerate(zip(polygon, left, strict=True)):
        q, e = polygon[(k + 1) % len(polygon)], left[(k + 1) % len(polygon)]
        if d >= 0.0:
            kept.append(p)
        if d * e < 0.0:
            s = d / (d - e)
            kept.append((p[0] + s * (q[0] - p[0]), p[1] + s * (q[1] - p[1])))
    return kept


def _area(polygon: list[Point]) -> float:
    x, y = np.array(polygon).T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))


def _joined(cells: list[tuple[list[Point], Point]], pitch: float) -> Sheet:
    """The sheet of clipped cells, each with its lower corner; points that coincide are one node."""
    numbers: dict[tuple[int, int], int] = {}
    fabric: list[Point] = []
    triangles: list[tuple[int, int, int]] = []
    pieces: list[tuple[int, int, int, float]] = []
    for polygon, corner in cells:
        nodes = [_node(p, numbers, fabric, SNAP * pitch) for p in polygon]
        nodes = [n for n, before in zip(nodes, [nodes[-1], *nodes[:-1]], strict=True) if n != before]
        triangles += _fan(nodes, fabric, round(sum(corner) / pitch))
        pieces += _pieces(nodes, fabric, corner, pitch)
    flat, ends = np.array(fabric), np.array(pieces)
    return Sheet(
        fabric=flat,
        points=np.column_stack([flat, np.zeros(len(flat))]),
        triangles=np.array(triangles, dtype=np.int64),
        weight=np.ones(len(triangles)),
        pieces=ends[:, :2].astype(np.int64),
        family=ends[:, 2].astype(np.int64),
        width=ends[:, 3],
        cells=len(cells),
    )


def _node(p: Point, numbers: dict[tuple[int, int], int], fabric: list[Point], tolerance: float) -> int:
    """The number of the node at ``p``, a new one if none lies there."""
    grid = 4.0 * tolerance
    a, b = round(p[0] / grid), round(p[1] / grid)
    for key in itertools.product((a, a - 1, a + 1), (b, b - 1, b + 1)):
        if key in numbers:
            return numbers[key]
    numbers[a, b] = len(fabric)
    fabric.append(p)
    return numbers[a, b]


def _fan(nodes: list[int], fabric: list[Point], turn: int) -> list[tuple[int, int, int]]:
    """Triangles of a convex polygon: of the fans from each corner the one whose smallest triangle is largest.

    Where two do as well, which is so in a whole cell, cells take turns in a chequered pattern.
    """
    fans = []
    for k in range(len(nodes)):
        turned = nodes[k:] + nodes[:k]
        fan = [(turned[0], turned[m], turned[m + 1]) for m in range(1, len(nodes) - 1)]
        fans.append((min(_area([fabric[n] for n in t]) for t in fan), fan))
    best = max(size for size, _ in fans)
    able = [fan for size, fan in fans if size > best * (1.0 - 1e-9)]
    return able[turn % len(able)]


def _pieces(nodes: list[int], fabric: list[Point], corner: Point, pitch: float) -> list[tuple[int, int, int, float]]:
    """Pieces of yarn on the sides of a cell: ends, family, and the width that shares out the yarn of what is left."""
    found: list[list[tuple[int, int]]] = [[], []]
    for p, q in zip(nodes, nodes[1:] + nodes[:1], strict=True):
        for family in (0, 1):
            off = 1 - family  # warp runs along u: its v is that of a side of the cell
            level = {round((fabric[n][off] - corner[off]) / pitch / (4.0 * SNAP)) for n in (p, q)}
            if len(level) == 1 and level <= {0, round(0.25 / SNAP)}:
                found[family].append((p, q))
    area, pieces = _area([fabric[n] for n in nodes]), []
    for family, sides in enumerate(found):
        total = sum(math.dist(fabric[p], fabric[q]) for p, q in sides)
        pieces += [(p, q, family, area / total) for p, q in sides if total > SLIVER * pitch]
    return pieces
