"""The flat pattern as pieces for the cutting table: contour, cut-outs, grain line, notches, axes of the yarns."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from geomdrap.fields.contour import signed_area, winding
from geomdrap.fields.flat import yarn_lines

if TYPE_CHECKING:
    from geomdrap.fields import Drape

Floats = NDArray[np.float64]

DEPTH = 4.0
"""Of a notch, mm."""
APART = 8.0
"""Between the two notches of a double one, along the contour, mm."""
GRAIN = 0.6
"""Length of the grain line, as a share of the longest yarn that it can lie on."""
LEVELS = 41
"""Yarns that are tried for the grain line."""
OFF_LEVEL = 1e-6
"""Share of the size by which they avoid corners of the contour."""


@dataclass(frozen=True)
class Notch:
    """A place (2,) mm on the contour, the unit direction (2,) into the piece, and which end of an axis it marks."""

    at: Floats
    inward: Floats
    mark: str


@dataclass(frozen=True)
class Piece:
    """A piece of fabric in mm, u to the right along the warp, v up; the origin is the seed.

    ``outer`` (k, 2) counter-clockwise, ``inner`` clockwise; ``grain`` (2, 2) along the warp; ``axes``: the stretches
    (2, 2) of the warp and weft through the origin that lie on the piece.
    """

    name: str
    outer: Floats
    inner: tuple[Floats, ...]
    grain: Floats
    notches: tuple[Notch, ...]
    axes: tuple[Floats, ...]


def cut_pieces(result: Drape) -> tuple[Piece, ...]:
    """The pieces of a drape's flat pattern, the largest first."""
    flat = result.flat
    stem = piece_name(result.net.surface.source)
    ordered = sorted(flat.outer, key=lambda polygon: -signed_area(polygon))
    pieces = []
    for number, outer in enumerate(ordered, start=1):
        inner = tuple(hole for hole in flat.inner if winding(outer, hole.mean(axis=0)) or winding(outer, hole[0]))
        contours = (outer, *inner)
        zero = np.zeros(1)
        pieces.append(
            Piece(
                name=stem if len(ordered) == 1 else f"{stem}-{number}",
                outer=outer,
                inner=inner,
                grain=grain_line(contours),
                notches=notches(outer),
                axes=(*yarn_lines(contours, zero, 1), *yarn_lines(contours, zero, 0)),
            )
        )
    return tuple(pieces)


def piece_name(source: str) -> str:
    """The part's name in capitals, digits, minus and underscore: all that cutters' software is sure to read."""
    stem = Path(source).stem.upper()
    return "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "_" for c in stem) or "PIECE"


def grain_line(contours: tuple[Floats, ...]) -> Floats:
    """A line (2, 2) along the warp in the middle of the longest stretch of warp that lies on the piece."""
    low, high = contours[0][:, 1].min(), contours[0][:, 1].max()
    levels = low + (high - low) * ((np.arange(LEVELS) + 0.5) / LEVELS + OFF_LEVEL)
    lines = yarn_lines(contours, levels, 1)
    longest = max(lines, key=lambda line: line[1, 0] - line[0, 0])
    middle, half = longest.mean(axis=0), 0.5 * GRAIN * (longest[1] - longest[0])
    return np.stack([middle - half, middle + half])


def notches(outer: Floats) -> tuple[Notch, ...]:
    """Where the axes of the yarns leave the piece for good; two where the warp does so towards +u.

    Laid on the tool, these lie on the lines through the seed; the double notch tells the ends of the warp apart.
    """
    found: list[Notch] = []
    for axis, name in ((1, "WARP"), (0, "WEFT")):
        crossings = axis_crossings(outer, axis)
        if not crossings:
            continue
        ends = (min(crossings), max(crossings))
        for (_, side, share), sign in zip(ends, "-+", strict=True):
            found.append(notch_at(outer, side, share, f"{name} {sign}"))
            if (name, sign) == ("WARP", "+"):
                found.append(notch_at(outer, *further(outer, side, share, APART), f"{name} {sign}"))
    return tuple(found)


def axis_crossings(outer: Floats, axis: int) -> list[tuple[float, int, float]]:
    """Crossings of the contour with coordinate[axis] = 0: place along the axis, side, share of the side passed."""
    ends = np.roll(outer, -1, axis=0)
    sides = np.flatnonzero((outer[:, axis] > 0.0) != (ends[:, axis] > 0.0))
    share = outer[sides, axis] / (outer[sides, axis] - ends[sides, axis])
    along = outer[sides, 1 - axis] + share * (ends[sides, 1 - axis] - outer[sides, 1 - axis])
    return list(zip(along.tolist(), sides.tolist(), share.tolist(), strict=True))


def notch_at(outer: Floats, side: int, share: float, mark: str) -> Notch:
    """A notch on a side of the contour, square to it, into the piece: to the left of a counter-clockwise contour."""
    start, end = outer[side], outer[(side + 1) % len(outer)]
    along = (end - start) / np.linalg.norm(end - start)
    return Notch(start + share * (end - start), np.array([-along[1], along[0]]), mark)


def further(outer: Floats, side: int, share: float, distance: float) -> tuple[int, float]:
    """Side and share of it that lie a distance further along the contour (round and round, if it is that short)."""
    lengths = np.linalg.norm(np.roll(outer, -1, axis=0) - outer, axis=1)
    left = (distance + share * lengths[side]) % lengths.sum()
    while left > lengths[side]:
        left -= lengths[side]
        side = (side + 1) % len(outer)
    return side, float(left / lengths[side])
