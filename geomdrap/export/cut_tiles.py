"""How a pattern is cut up into pages of paper, in true scale, so that they can be glued together."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geomdrap.export.cut_pieces import Piece
from geomdrap.fields.contour import clip_to_rectangle

Floats = NDArray[np.float64]

PAPERS = {"A4": (210.0, 297.0), "A3": (297.0, 420.0)}
"""Sizes upright, mm (ISO 216)."""
MARGIN = 12.0
"""White around what is printed, mm: printers do not reach the edge."""
OVERLAP = 10.0
"""What neighbouring pages both show, mm, for the glue."""


@dataclass(frozen=True)
class Tile:
    """A page: row (from the top) and column (from the left), both from 1; lower left corner (2,) in the fabric."""

    row: int
    column: int
    lower: Floats


@dataclass(frozen=True)
class Tiling:
    """All pages: their size and that of what they show (2,) mm, numbers of rows and columns, and those needed.

    ``start`` (2,): lower left corner in the fabric of the pages together; ``covered`` (2,) mm: their size.
    """

    page: Floats
    shown: Floats
    start: Floats
    covered: Floats
    rows: int
    columns: int
    tiles: tuple[Tile, ...]


def tiling(pieces: tuple[Piece, ...], paper: str) -> Tiling:
    """The pages that pieces need on a paper, upright or across, whichever is fewer; empty ones are left out."""
    size = np.array(PAPERS[paper])
    upright, across = (lay_out(pieces, page) for page in (size, size[::-1]))
    return across if len(across.tiles) < len(upright.tiles) else upright


def lay_out(pieces: tuple[Piece, ...], page: Floats) -> Tiling:
    """Pages of one size over the pieces, in rows from the top."""
    shown = page - 2 * MARGIN
    step = shown - OVERLAP
    points = np.vstack([piece.outer for piece in pieces])
    lower, upper = points.min(axis=0), points.max(axis=0)
    columns, rows = (max(1, int(np.ceil(n - 1e-9))) for n in (upper - lower - OVERLAP) / step)
    covered = np.array([columns, rows]) * step + OVERLAP
    start = 0.5 * (lower + upper - covered)
    tiles = []
    for row in range(rows):
        for column in range(columns):
            corner = start + [column, rows - 1 - row] * step
            if any(touches(piece.outer, corner, shown) for piece in pieces):
                tiles.append(Tile(row + 1, column + 1, corner))
    return Tiling(page, shown, start, covered, rows, columns, tuple(tiles))


def touches(polygon: Floats, lower: Floats, size: Floats) -> bool:
    """Whether a polygon reaches into a rectangle."""
    half = 0.5 * size
    return len(clip_to_rectangle(polygon - (lower + half), (float(half[0]), float(half[1])))) > 0
