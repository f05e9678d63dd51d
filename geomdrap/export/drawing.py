"""The flat pattern as a drawing of layers in mm: what flat.dxf and flat.svg both write.

u points to the right and v up, the origin (0, 0) is the seed of the net; notes stand beside the pattern,
so that nothing but the pattern lies inside its contours.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from geomdrap.export.report_json import is_incomplete
from geomdrap.fields.contour import TOUCH
from geomdrap.fields.flat import yarn_lines

if TYPE_CHECKING:
    from geomdrap.fields import Drape, FlatPattern
    from geomdrap.fields.strips import Roll, RollStrip

Floats = NDArray[np.float64]

DECIMALS = 6
"""Of every coordinate, mm."""

CHARACTER = 0.8
"""Width of a character relative to its height, generous, for the room that notes need."""


@dataclass(frozen=True)
class Polyline:
    """Points (k, 2) in mm; closed without repeating the first."""

    points: Floats
    closed: bool = False


@dataclass(frozen=True)
class Text:
    """A line of text with its lower left corner and the height of its capitals, mm."""

    words: str
    at: tuple[float, float]
    height: float


@dataclass(frozen=True)
class Layer:
    """Polylines and texts under one name; colour as 0xRRGGBB, `aci` its AutoCAD number."""

    name: str
    colour: int
    aci: int
    polylines: tuple[Polyline, ...] = ()
    texts: tuple[Text, ...] = ()


@dataclass(frozen=True)
class Drawing:
    """Layers in the order in which they are drawn; corners (2,) of all that they hold, mm."""

    layers: tuple[Layer, ...]
    lower: Floats
    upper: Floats


def flat_drawing(result: Drape) -> Drawing:
    """Contours, rosette, yarns, locked zones and notes of a drape's flat pattern."""
    flat = result.flat
    lower, upper = pattern_corners(flat)
    layers = (
        Layer("LOCKED_ZONES", 0xC8322B, 1, closed_lines(flat.locked)),
        Layer("WARP_LINES", 0x3B75AF, 5, open_lines(flat.warp_lines)),
        Layer("WEFT_LINES", 0x4C9A6A, 3, open_lines(flat.weft_lines)),
        Layer("INNER_CONTOURS", 0x8A3FA0, 6, closed_lines(flat.inner)),
        Layer("OUTER_CONTOUR", 0x000000, 7, closed_lines(flat.outer)),
        *([Layer("CUTS", 0xC8322B, 1, open_lines(flat.cuts))] if flat.cuts else []),
        *seam_layers(result),
        rosette(lower, upper),
        notes(result, lower, upper),
    )
    return Drawing(layers, *corners(layers))


def seam_layers(result: Drape) -> Iterator[Layer]:
    """The seams between strips of a roll, and the edges of the strips where these overlap; none without a roll."""
    if result.roll is None:
        return
    yield Layer("SEAMS", 0x138A36, 94, open_lines(tuple(line for seam in result.roll.seams for line in seam.pieces)))
    if result.roll.overlap > 0.0:
        lines = [line for pair in pairwise(result.roll.strips) for line in overlap_edges(*pair)]
        yield Layer("STRIP_EDGES", 0x7CC08F, 84, open_lines(tuple(lines)))


def overlap_edges(lower: RollStrip, upper: RollStrip) -> Iterator[Floats]:
    """Stretches (2, 2) mm where two strips end past the seam between them, a hair inside of each."""
    yield from yarn_lines(upper.contours, np.array([upper.v[0] + TOUCH]), 1)
    yield from yarn_lines(lower.contours, np.array([lower.v[1] - TOUCH]), 1)


def pattern_corners(flat: FlatPattern) -> tuple[Floats, Floats]:
    """Lower left and upper right corner (2,) of contours and origin, mm; 100 × 100 where there are none."""
    if not flat.outer:
        return np.zeros(2), np.full(2, 100.0)
    points = np.vstack([np.zeros((1, 2)), *flat.outer])
    return points.min(axis=0), points.max(axis=0)


def closed_lines(polygons: tuple[Floats, ...]) -> tuple[Polyline, ...]:
    """Polygons (k, 2) as closed polylines."""
    return tuple(Polyline(rounded(polygon), closed=True) for polygon in polygons)


def open_lines(lines: tuple[Floats, ...]) -> tuple[Polyline, ...]:
    """Lines (k, 2) as open polylines."""
    return tuple(Polyline(rounded(line)) for line in lines)


def rounded(points: Floats) -> Floats:
    """Points to six decimals, without negative zeros: the same text on any machine."""
    return np.asarray(np.round(np.asarray(points, dtype=float)[:, :2], DECIMALS) + 0.0)


def rosette(lower: Floats, upper: Floats) -> Layer:
    """Arrows along the warp (long, full head) and the weft (shorter, open head) at the origin."""
    short, long = np.sort(upper - lower)
    length = float(np.clip(0.35 * short, 0.04 * long, 0.12 * long))
    head = 0.14 * length
    warp = np.array(
        [[0, 0], [length, 0], [length - head, 0.35 * head], [length - head, -0.35 * head], [length, 0]]
    )
    weft_length = 0.7 * length
    shaft = np.array([[0, 0], [0, weft_length]])
    tip = np.array([[-0.35 * head, weft_length - head], [0, weft_length], [0.35 * head, weft_length - head]])
    height = 0.16 * length
    texts = (
        Text("WARP", (length + 0.5 * height, -0.5 * height), height),
        Text("WEFT", (-0.5 * 4 * CHARACTER * height, weft_length + 0.5 * height), height),
    )
    return Layer("ROSETTE", 0xD9730D, 30, open_lines((warp, shaft, tip)), tuple(map(rounded_text, texts)))


def rounded_text(text: Text) -> Text:
    """The text with its place and height to six decimals."""
    x, y = (round(value, DECIMALS) + 0.0 for value in text.at)
    return Text(text.words, (x, y), round(text.height, DECIMALS))


def notes(result: Drape, lower: Floats, upper: Floats) -> Layer:
    """What is drawn and how, with a check length: below a wide pattern, to the right of a tall one."""
    words = note_words(result)
    width, height = upper - lower
    size = max(width, height) / 80.0
    block = max(len(line) for line in words) * CHARACTER * size
    beside = height > width or block > width
    left, top = (upper[0] + 3 * size, upper[1]) if beside else (lower[0], lower[1] - 3 * size)
    texts = [Text(line, (left, top - size - 1.8 * size * k), size) for k, line in enumerate(words)]
    bar = check_length(width if not beside else max(block, width))
    y = top - 1.8 * size * (len(words) + 1)
    line = np.array([[left, y + size], [left, y], [left + bar, y], [left + bar, y + size]])
    texts.append(Text(f"CHECK LENGTH {bar:g} mm", (left + 0.5 * size, y - 1.5 * size), size))
    return Layer("NOTES", 0x555555, 8, open_lines((line,)), tuple(map(rounded_text, texts)))


def note_words(result: Drape) -> list[str]:
    """The lines of the notes, in plain ASCII but for the part's name: plotters' fonts know no more."""
    net, area, statistics = result.net, result.area, result.statistics
    words = [
        f"{Path(net.surface.source).name}: flat pattern, mm, true scale 1:1",
        f"warp at {net.angle:g} deg, origin {', '.join(f'{x + 0.0:.3f}' for x in net.origin)} mm",
        f"seen from the side of the normal {', '.join(f'{x + 0.0:.3f}' for x in net.normal0)} at the origin",
        f"pitch {net.pitch:.6g} mm, limit angle {result.limit_angle:g} deg",
        f"part {area.part:.1f} mm2, fabric {area.fabric:.1f} mm2",
        f"shear max {statistics.max:.2f} deg, 95th percentile {statistics.p95:.2f} deg",
        f"coverage {100 * area.coverage:.2f} %" + (": INCOMPLETE" if is_incomplete(result) else ""),
    ]
    if any(len(polygon) for polygon in result.flat.locked):
        words.append(f"LOCKED_ZONES: shear over {result.limit_angle:g} deg")
    if result.roll is not None:
        words.append(roll_words(result.roll))
    return words


def roll_words(roll: Roll) -> str:
    """How many strips of the roll, and how they overlap."""
    strips = "one strip, no seam" if len(roll.strips) == 1 else f"{len(roll.strips)} strips"
    overlap = f", overlap {roll.overlap:g} mm" if roll.overlap > 0.0 and roll.seams else ""
    return f"roll {roll.width:g} mm wide: {strips}{overlap}"


def check_length(room: float) -> float:
    """100 mm where that fits; 1000 mm on very large patterns, the longest round length on small ones."""
    if room >= 100.0:
        return 1000.0 if room >= 4000.0 else 100.0
    return round_length(room)


def round_length(limit: float) -> float:
    """The greatest of … 1, 2, 5, 10, 20, 50 … that is not over the limit (> 0)."""
    decade = 10.0 ** np.floor(np.log10(limit))
    return float(max(step * decade for step in (1.0, 2.0, 5.0) if step * decade <= limit * (1 + 1e-9)))


def corners(layers: tuple[Layer, ...]) -> tuple[Floats, Floats]:
    """Lower left and upper right corner (2,) of all lines and of the room for the texts, mm."""
    points = [line.points for layer in layers for line in layer.polylines if len(line.points)]
    for text in (text for layer in layers for text in layer.texts):
        x, y = text.at
        width = len(text.words) * CHARACTER * text.height
        points.append(np.array([[x, y - 0.3 * text.height], [x + width, y + text.height]]))
    together = np.vstack(points)
    return rounded(together.min(axis=0)[None])[0], rounded(together.max(axis=0)[None])[0]
