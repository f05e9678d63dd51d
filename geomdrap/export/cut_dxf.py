"""cut.dxf: the pieces for the cutting table, in the numbered layers of ASTM D6673 (AAMA), true scale, mm."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geomdrap.export.cut_pieces import DEPTH, Piece, cut_pieces, style_name
from geomdrap.export.drawing import note_words, rounded
from geomdrap.export.dxf import METRIC, fixed_metadata
from geomdrap.export.whole import write_whole

if TYPE_CHECKING:
    from geomdrap.fields import Drape

BOUNDARY, TURNS, CURVES, NOTCHES, GRAIN, INTERNAL, CUTOUTS, TEXT = "1", "2", "3", "4", "7", "8", "11", "15"
COLOURS = {BOUNDARY: 7, TURNS: 1, CURVES: 3, NOTCHES: 6, GRAIN: 5, INTERNAL: 8, CUTOUTS: 6, TEXT: 8}
TURN = np.cos(np.radians(20.0))
"""Cosine of the angle by which a contour turns at a corner; where it turns by less the point is on a curve."""
LETTERS = 1.0 / 60.0
"""Height of letters, as a share of the piece's longer side."""


def write(result: Drape, path: Path) -> None:
    """Write the pieces as DXF R12, a block for each; the same bytes for the same drape. Raises GeomdrapError."""
    write_whole(path, dxf_text(result))


def dxf_text(result: Drape) -> str:
    """The text of the file."""
    from ezdxf.document import Drawing

    pieces = cut_pieces(result)
    with fixed_metadata():
        document = Drawing.new("R12")  # ezdxf.new warns that R12 has no place for units: the text says METRIC
        document.header["$MEASUREMENT"] = METRIC
        for name, colour in COLOURS.items():
            document.layers.add(name, color=colour)
        space = document.modelspace()
        add_words(space, BOUNDARY, style_words(pieces), corner_below(pieces), letter_height(pieces))
        for piece in pieces:
            draw_piece(document.blocks.new(piece.name), piece, result)
            space.add_blockref(piece.name, (0, 0), dxfattribs={"layer": BOUNDARY})
        stream = io.StringIO()
        document.write(stream)
    return stream.getvalue()


def style_words(pieces: tuple[Piece, ...]) -> list[str]:
    """System text that stands once in the file."""
    return [
        "ASTM/D6673",
        f"Style Name: {style_name(pieces)}",
        "Sample Size: 1",
        "Units: METRIC",
    ]


def draw_piece(block: Any, piece: Piece, result: Drape) -> None:
    """The lines, points and texts of a piece in its block."""
    for layer, polygons in ((BOUNDARY, (piece.outer,)), (CUTOUTS, piece.inner)):
        for polygon in polygons:
            block.add_polyline2d(rounded(polygon).tolist(), close=True, dxfattribs={"layer": layer})
            add_points(block, polygon)
    inside = ((GRAIN, (piece.grain,)), (INTERNAL, (*piece.axes, *piece.seams)), (CUTOUTS, piece.cuts))
    for layer, lines in inside:
        for line in lines:
            start, end = rounded(line).tolist()
            block.add_line(start, end, dxfattribs={"layer": layer})
    for notch in piece.notches:
        x, y = rounded(notch.at[None])[0].tolist()
        angle = float(np.degrees(np.arctan2(notch.inward[1], notch.inward[0])) % 360.0)
        attributes = {"layer": NOTCHES, "angle": round(angle, 6)}
        block.add_point((x, y, DEPTH), dxfattribs=attributes)  # by the standard the depth stands for z
    named, notes = [f"Piece Name: {piece.name}", "Size: 1", "Quantity: 1"], note_words(result)
    start, height = place_of_words(piece, len(named) + len(notes))
    add_words(block, BOUNDARY, named, start, height)
    add_words(block, TEXT, notes, start - np.array([0.0, 1.8 * height * len(named)]), height)


def place_of_words(piece: Piece, lines: int) -> tuple[np.ndarray, float]:
    """Where the words on a piece start (2,), and the height of their letters, mm.

    Below the grain line; on a strip of a roll, which they could overhang, half as high as it is, in its middle.
    """
    height = letter_height((piece,))
    if not piece.strip_of:
        return piece.grain[0] - np.array([0.0, 2.0 * height]), height
    low, high = piece.outer[:, 1].min(), piece.outer[:, 1].max()
    height = min(height, 0.5 * (high - low) / (1.8 * lines))
    return np.array([piece.grain[0, 0], 0.5 * (low + high) + 0.9 * height * (lines - 1)]), height


def add_points(block: Any, polygon: np.ndarray) -> None:
    """Mark the points of a contour as corners or as on a curve."""
    before, after = polygon - np.roll(polygon, 1, axis=0), np.roll(polygon, -1, axis=0) - polygon
    size = np.linalg.norm(before, axis=1) * np.linalg.norm(after, axis=1)
    straight = (before * after).sum(axis=1) > TURN * size
    for (x, y), on_curve in zip(rounded(polygon).tolist(), straight.tolist(), strict=True):
        block.add_point((x, y), dxfattribs={"layer": CURVES if on_curve else TURNS})


def add_words(layout: Any, layer: str, words: list[str], at: np.ndarray, height: float) -> None:
    """Lines of text, one below the other."""
    for k, line in enumerate(words):
        x, y = rounded((np.asarray(at) - [0.0, 1.8 * height * k])[None])[0].tolist()
        layout.add_text(line, height=round(height, 6), dxfattribs={"layer": layer, "insert": (x, y)})


def letter_height(pieces: tuple[Piece, ...]) -> float:
    """Height of letters for pieces, mm."""
    if not pieces:
        return 5.0
    points = np.vstack([piece.outer for piece in pieces])
    return float(LETTERS * (points.max(axis=0) - points.min(axis=0)).max())


def corner_below(pieces: tuple[Piece, ...]) -> np.ndarray:
    """A place (2,) below the pieces, at their left."""
    if not pieces:
        return np.zeros(2)
    points = np.vstack([piece.outer for piece in pieces])
    return np.asarray(points.min(axis=0) - [0.0, 3.0 * letter_height(pieces)])
