"""The flat pattern as pieces for the cutting table: contour, cut-outs, grain line, notches, axes of the yarns."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
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
APART_STRIPS = 20.0
"""Between strips of a roll, mm."""
OFF_SEAM = 0.6
"""Share of the height of a strip in which its grain line lies: at a seam its name would be on the next strip."""
NO_LEVELS = np.zeros(0)
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
    (2, 2) of the warp and weft through the origin that lie on the piece; ``seams`` the same of the middles of its
    overlaps; ``cuts`` lines (2, 2) to cut within it. ``seed`` (2,) is where the origin lies, NaN where on another
    piece: strips of a roll are moved apart. ``strip_of``: name of the pattern that the piece is cut from in strips,
    else empty.
    """

    name: str
    outer: Floats
    inner: tuple[Floats, ...]
    grain: Floats
    notches: tuple[Notch, ...]
    axes: tuple[Floats, ...]
    seams: tuple[Floats, ...]
    seed: Floats
    strip_of: str = ""
    cuts: tuple[Floats, ...] = ()


def cut_pieces(result: Drape) -> tuple[Piece, ...]:
    """The pieces of a drape's flat pattern, the largest first; those of a roll strip by strip, moved apart."""
    flat, stem = result.flat, piece_name(result.net.surface.source)
    roll = result.roll
    if roll is None or len(roll.strips) < 2:
        return tuple(with_cuts(piece, flat.cuts) for piece in pieces_of((*flat.outer, *flat.inner), stem))
    levels = np.array([seam.v for seam in roll.seams])
    pieces = []
    for number, strip in enumerate(roll.strips, start=1):
        inside = levels[(levels > strip.v[0]) & (levels < strip.v[1])]
        shift = np.array([0.0, (number - 1) * (roll.overlap + APART_STRIPS)])
        own = pieces_of(strip.contours, f"{stem}-STRIP{number}", inside, OFF_SEAM)
        pieces += [replace(moved(with_cuts(piece, flat.cuts), shift), strip_of=stem) for piece in own]
    return tuple(pieces)


def style_name(pieces: Sequence[Piece]) -> str:
    """The name of the pattern that the pieces are of."""
    return (pieces[0].strip_of or pieces[0].name) if pieces else "EMPTY"


def pieces_of(
    contours: Sequence[Floats], stem: str, seams: Floats = NO_LEVELS, grain_within: float = 1.0
) -> tuple[Piece, ...]:
    """The pieces that contours (k, 2) enclose, the largest first.

    ``seams`` are levels (n,) to mark, mm along v; for ``grain_within`` see ``grain_line``.
    """
    ordered = sorted((ring for ring in contours if signed_area(ring) > 0.0), key=lambda ring: -signed_area(ring))
    holes = [ring for ring in contours if signed_area(ring) < 0.0]
    pieces = []
    for number, outer in enumerate(ordered, start=1):
        inner = tuple(hole for hole in holes if winding(outer, hole.mean(axis=0)) or winding(outer, hole[0]))
        own = (outer, *inner)
        zero = np.zeros(1)
        pieces.append(
            Piece(
                name=stem if len(ordered) == 1 else f"{stem}-{number}",
                outer=outer,
                inner=inner,
                grain=grain_line(own, grain_within),
                notches=notches(outer),
                axes=(*yarn_lines(own, zero, 1), *yarn_lines(own, zero, 0)),
                seams=yarn_lines(own, seams, 1),
                seed=np.zeros(2),
            )
        )
    return tuple(pieces)


def with_cuts(piece: Piece, lines: Sequence[Floats]) -> Piece:
    """The piece with those of the lines (2, 2) that lie on it."""
    return replace(piece, cuts=tuple(line for line in lines if winding(piece.outer, line.mean(axis=0)) != 0))


def moved(piece: Piece, shift: Floats) -> Piece:
    """The piece of a strip moved by (2,) mm; the seed goes with the strips whose piece it lies on."""
    on = winding(piece.outer, piece.seed) != 0
    return replace(
        piece,
        outer=piece.outer + shift,
        inner=tuple(ring + shift for ring in piece.inner),
        grain=piece.grain + shift,
        notches=tuple(replace(notch, at=notch.at + shift) for notch in piece.notches),
        axes=tuple(line + shift for line in piece.axes),
        seams=tuple(line + shift for line in piece.seams),
        cuts=tuple(line + shift for line in piece.cuts),
        seed=piece.seed + shift if on else np.full(2, np.nan),
    )


def piece_name(source: str) -> str:
    """The part's name in capitals, digits, minus and underscore: all that cutters' software is sure to read."""
    stem = Path(source).stem.upper()
    return "".join(c if c.isascii() and (c.isalnum() or c in "-_") else "_" for c in stem) or "PIECE"


def grain_line(contours: tuple[Floats, ...], inner: float = 1.0) -> Floats:
    """A line (2, 2) along the warp in the middle of the longest stretch of warp that lies on the piece.

    Only warps in the ``inner`` share of the piece's height are looked at.
    """
    low, high = contours[0][:, 1].min(), contours[0][:, 1].max()
    rim = 0.5 * (1.0 - inner) * (high - low)
    low, high = low + rim, high - rim
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
