"""Specimens cut from the cloth at an angle: cells along the yarns, clipped by the rectangle of the specimen.

Sides of cells stay on yarns, since triangles across the yarns would lock in shear (X. Yu et al., Composites A 37
(2006) 790). Clamps cut cells, and hold the nodes on the cut. A free border that runs through a cell leaves it whole,
with the share of resin and yarn that lies within: a corner cut off would be free to turn its yarns by itself, which
yarns that cross many others are not. Nodes of such cells lie a little outside of the border.
"""

from __future__ import annotations

import itertools
import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import FormingError
from geomdrap.forming.sheet import Sheet

Array = NDArray[np.float64]
Point = tuple[float, float]
Box = tuple[float, float, float, float]
"""Of a cell: u from, to, v from, to."""

SNAP = 1e-6
"""Share of the pitch within which points are one."""
SLIVER = 0.02
"""What the cut leaves of a cell is dropped below this share of it: it would only be a small, stiff triangle."""


def strip(length: float, width: float, angle: float, pitch: float) -> Sheet:
    """A strip of ``width`` × ``length`` mm along x and y, the warp at ``angle`` degrees from its length.

    Warp runs at 90° − angle from +x, weft 90° further, so that pulling along y closes them: positive shear. The
    middle of the strip is the origin; fabric coordinates are measured from its lower left corner. ``pitch`` mm is
    about the side of a cell: a yarn of each family runs through every corner, since those that meet a clamp cannot
    turn and the others can. FormingError where the strip holds no cell.
    """
    if not (min(length, width, pitch) > 0.0 and 0.0 <= angle <= 90.0):
        raise FormingError(
            "a strip needs length, width and pitch above 0 mm and an angle from 0 to 90 degrees; got "
            f"{length:g}, {width:g}, {pitch:g} and {angle:g}"
        )
    turn = math.radians(90.0 - angle)
    axes = np.array([[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]])
    corners = np.array([[0.0, 0.0], [width, 0.0], [width, length], [0.0, length]]) @ axes.T
    u, v = (_lines(corners[:, k], pitch) for k in (0, 1))
    boxes = [(*a, *b) for a, b in itertools.product(itertools.pairwise(u), itertools.pairwise(v))]
    cells = [cell for box in boxes if (cell := _cell(box, corners, SNAP * pitch)) is not None]
    if not cells:
        raise FormingError(f"a pitch of {pitch:g} mm is too coarse for a strip of {length:g} × {width:g} mm")
    sheet = _joined(cells, pitch)
    place = sheet.fabric @ axes - [0.5 * width, 0.5 * length]
    return sheet.moved(np.column_stack([place, np.zeros(len(place))]))


def _lines(corners: Array, pitch: float) -> list[float]:
    """Coordinates of the yarns of a family: through all ``corners`` (4,), and about ``pitch`` apart between them."""
    through = [float(c) for c in np.sort(corners)]
    lines = through[:1]
    for end in through[1:]:
        if end - lines[-1] > 0.05 * pitch:
            count = max(1, round((end - lines[-1]) / pitch))
            lines += np.linspace(lines[-1], end, count + 1)[1:].tolist()
    return lines


@dataclass(frozen=True)
class _Cell:
    """What is meshed of the cell ``box``: a polygon, and the share of it that is cloth."""

    box: Box
    polygon: list[Point]
    weight: float


def _cell(box: Box, corners: Array, tolerance: float) -> _Cell | None:
    """The cell ``box`` of the strip with ``corners`` (4, 2); None where next to nothing of it is cloth."""
    u0, u1, v0, v1 = box
    whole = [(u0, v0), (u1, v0), (u1, v1), (u0, v1)]
    cloth = _within(whole, corners, (0, 1, 2, 3), tolerance)
    if len(cloth) < 3 or _area(cloth) <= SLIVER * (u1 - u0) * (v1 - v0):
        return None
    if all(min(math.dist(p, q) for q in whole) < 4.0 * tolerance for p in cloth):
        return _Cell(box, cloth, 1.0)  # the border runs along sides or through opposite corners
    held = _within(whole, corners, (0, 2), tolerance)
    return _Cell(box, held, _area(cloth) / _area(held))


def _within(polygon: list[Point], corners: Array, sides: tuple[int, ...], tolerance: float) -> list[Point]:
    """What of a convex polygon lies within the given sides of the strip: 0 and 2 are clamps, 1 and 3 free."""
    for side in sides:
        a, b = corners[side], corners[(side + 1) % 4]
        polygon = _cut(polygon, a, (b - a) / np.linalg.norm(b - a), tolerance)
    return polygon


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


def _joined(cells: list[_Cell], pitch: float) -> Sheet:
    """The sheet of the cells; points that coincide are one node."""
    numbers: dict[tuple[int, int], int] = {}
    fabric: list[Point] = []
    triangles: list[tuple[int, int, int]] = []
    pieces: list[tuple[int, int, int, float]] = []
    weights: list[float] = []
    for cell in cells:
        box, nodes = cell.box, [_node(p, numbers, fabric, SNAP * pitch) for p in cell.polygon]
        nodes = [n for n, before in zip(nodes, [nodes[-1], *nodes[:-1]], strict=True) if n != before]
        triangles += _fan(nodes, fabric, round(box[0] / (box[1] - box[0])) + round(box[2] / (box[3] - box[2])))
        weights += [cell.weight] * (len(triangles) - len(weights))
        pieces += _pieces(nodes, fabric, cell, SNAP * pitch)
    flat, ends = np.array(fabric), np.array(pieces)
    return Sheet(
        fabric=flat,
        points=np.column_stack([flat, np.zeros(len(flat))]),
        triangles=np.array(triangles, dtype=np.int64),
        weight=np.array(weights),
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


def _pieces(
    nodes: list[int], fabric: list[Point], cell: _Cell, tolerance: float
) -> list[tuple[int, int, int, float]]:
    """Pieces of yarn on the sides of a cell: ends, family, and the width that shares out the yarn of its cloth."""
    box = cell.box
    found: list[list[tuple[int, int]]] = [[], []]
    for p, q in zip(nodes, nodes[1:] + nodes[:1], strict=True):
        for family in (0, 1):
            off = 1 - family  # warp runs along u: its v is that of a side of the cell
            if any(
                all(abs(fabric[n][off] - side) < 4.0 * tolerance for n in (p, q))
                for side in box[2 * off : 2 * off + 2]
            ):
                found[family].append((p, q))
    area, pieces = cell.weight * _area([fabric[n] for n in nodes]), []
    for family, sides in enumerate(found):
        total = sum(math.dist(fabric[p], fabric[q]) for p, q in sides)
        shortest = SLIVER * (box[1] - box[0] if family == 0 else box[3] - box[2])
        pieces += [(p, q, family, area / total) for p, q in sides if total > shortest]
    return pieces
