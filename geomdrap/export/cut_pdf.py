"""cut.pdf: the pieces in true scale on pages of A4 or A3, to be printed, glued together and cut by hand."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import GeomdrapError
from geomdrap.export import palette
from geomdrap.export.cut_pieces import DEPTH, Piece, cut_pieces, style_name
from geomdrap.export.cut_tiles import MARGIN, OVERLAP, Tile, Tiling, tiling
from geomdrap.export.drawing import note_words
from geomdrap.export.glyphs import drawable
from geomdrap.export.whole import write_whole

if TYPE_CHECKING:
    from geomdrap.fields import Drape

Floats = NDArray[np.float64]

INCH = 25.4
POINT = 72.0 / INCH
"""Points of a millimetre, for widths of lines."""
CHECK = 100.0
"""Length of the bar on each page, mm."""
MARK = 5.0
"""Arms of the crosses by which pages are laid on each other, mm."""
ARROW = 6.0
"""Heads of the grain line, mm."""


def write(result: Drape, path: Path, paper: str = "A4") -> None:
    """Write the pages, an overview first. Raises GeomdrapError if there is no pattern or it cannot be written."""
    from matplotlib.backends.backend_pdf import PdfPages

    pieces = cut_pieces(result)
    if not pieces:
        raise GeomdrapError("there is no flat pattern to print; leave pdf out of --outputs")
    pages = tiling(pieces, paper)
    buffer = io.BytesIO()
    with PdfPages(buffer, metadata={"CreationDate": None, "Title": f"{style_name(pieces)}: flat pattern"}) as pdf:
        pdf.savefig(overview(result, pieces, pages, paper))
        for tile in pages.tiles:
            pdf.savefig(sheet(pieces, pages, tile))
    write_whole(path, buffer.getvalue())


def blank_page(page: Floats) -> tuple[Any, Any]:
    """A page with axes that count its millimetres from the lower left corner."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=tuple(page / INCH))
    axes = figure.add_axes((0, 0, 1, 1))
    axes.set(xlim=(0, page[0]), ylim=(0, page[1]))
    axes.set_axis_off()
    return figure, axes


def sheet(pieces: tuple[Piece, ...], pages: Tiling, tile: Tile) -> Any:
    """A page in true scale: the pieces in its frame, marks for its neighbours, its number and a check length."""
    from matplotlib.patches import Rectangle

    figure, axes = blank_page(pages.page)
    frame = Rectangle((MARGIN, MARGIN), *pages.shown, fill=False, ec=palette.FAINT, lw=0.1 * POINT, ls=(0, (6, 4)))
    axes.add_patch(frame)
    draw_pieces(axes, pieces, MARGIN - tile.lower, frame)
    draw_marks(axes, pages)
    name = f"{style_name(pieces)}   row {tile.row} of {pages.rows}, column {tile.column} of {pages.columns}"
    axes.text(pages.page[0] - MARGIN, 0.5 * MARGIN, name, fontsize=8, ha="right", va="center", color=palette.INK)
    x, y = MARGIN, 0.35 * MARGIN
    bar = np.array([[x, y + 2], [x, y], [x + CHECK, y], [x + CHECK, y + 2]])
    axes.plot(*bar.T, color=palette.INK, lw=0.3 * POINT, solid_joinstyle="miter", solid_capstyle="butt")
    axes.text(x + 2, y + 0.8, f"{CHECK:g} mm: print at 100 %", fontsize=6, va="bottom", color=palette.INK)
    return figure


def draw_pieces(axes: Any, pieces: Sequence[Piece], shift: Floats, frame: Any) -> None:
    """Contours, cut-outs, notches, axes and grain lines, moved by (2,) mm and cut off at the frame."""
    for piece in pieces:
        for polygon in (piece.outer, *piece.inner):
            closed = np.vstack([polygon, polygon[:1]]) + shift
            draw(axes, closed, frame, color="black", lw=0.35 * POINT, solid_joinstyle="round")
        for notch in piece.notches:
            tick = np.stack([notch.at, notch.at + DEPTH * notch.inward]) + shift
            draw(axes, tick, frame, color="black", lw=0.35 * POINT)
            write_in(axes, notch.at + 2.2 * DEPTH * notch.inward + shift, notch.mark.lower(), frame)
        for line in piece.cuts:
            draw(axes, line + shift, frame, color="black", lw=0.35 * POINT)
        for line in piece.axes:
            draw(axes, line + shift, frame, color=palette.FAINT, lw=0.15 * POINT, ls=(0, (8, 3, 1, 3)))
        for line in piece.seams:
            draw(axes, line + shift, frame, color=palette.SEAM, lw=0.25 * POINT, ls=(0, (4, 3)))
        draw_grain(axes, piece.grain + shift, frame, f"{piece.name}: " if piece.strip_of else "")
    seed = {"marker": "o", "ms": 3.0 * POINT, "mfc": "none", "mec": palette.INK, "mew": 0.2 * POINT}
    for place in sorted({tuple(piece.seed.tolist()) for piece in pieces if np.isfinite(piece.seed).all()}):
        draw(axes, np.array([place]) + shift, frame, **seed)


def write_in(axes: Any, at: Floats, words: str, frame: Any) -> None:
    """Small letters about a place (2,), cut off at the frame."""
    text = axes.text(*at, words, fontsize=6, ha="center", va="center", color=palette.INK, clip_on=True)
    text.set_clip_path(frame)


def draw(axes: Any, points: Floats, frame: Any, **style: Any) -> None:
    """A line that ends at the frame."""
    (line,) = axes.plot(*points.T, **style)
    line.set_clip_path(frame)


def draw_grain(axes: Any, grain: Floats, frame: Any, name: str) -> None:
    """The grain line with a head at its end towards +u, and what it is, after the name of a strip."""
    (left, y), (right, _) = grain
    head = np.array([[right - ARROW, y + 0.35 * ARROW], [right, y], [right - ARROW, y - 0.35 * ARROW]])
    for points in (grain, head):
        draw(axes, points, frame, color=palette.LOW, lw=0.25 * POINT)
    text = f"{name}warp (grain line)"
    words = axes.text(0.5 * (left + right), y + 1.5, text, fontsize=9, color=palette.LOW, ha="center")
    words.set_clip_on(True)
    words.set_clip_path(frame)


def draw_marks(axes: Any, pages: Tiling) -> None:
    """Crosses in the middle of the overlap at the four corners: they lie on those of the neighbouring pages."""
    inset = MARGIN + 0.5 * OVERLAP
    for x in (inset, pages.page[0] - inset):
        for y in (inset, pages.page[1] - inset):
            axes.plot([x - MARK, x + MARK], [y, y], color=palette.ALARM, lw=0.1 * POINT)
            axes.plot([x, x], [y - MARK, y + MARK], color=palette.ALARM, lw=0.1 * POINT)


def overview(result: Drape, pieces: tuple[Piece, ...], pages: Tiling, paper: str) -> Any:
    """The first page: the whole pattern, not in scale, with the pages on it, and what it is."""
    from matplotlib.patches import Rectangle

    figure, axes = blank_page(pages.page)
    width, height = pages.page
    many = f"{len(pages.tiles)} page{'s' if len(pages.tiles) > 1 else ''} {paper}"
    words = [
        f"{Path(result.net.surface.source).name}: flat pattern in true scale on {many} (this overview is not)",
        f"pages overlap by {OVERLAP:g} mm: lay the red crosses on each other",
        "double notch: the end of the warp towards +u; circle: the seed",
        *(["dashed green line: seam, the middle of the overlap"] if any(piece.seams for piece in pieces) else []),
        *(line for line in note_words(result)[1:] if not line.startswith("LOCKED")),
    ]
    for k, line in enumerate(words):
        bold = "bold" if k == 0 else "normal"
        y, shown = height - MARGIN - 5.0 * (k + 1), drawable(line)
        axes.text(MARGIN, y, shown, fontsize=8.5, fontweight=bold, color=palette.INK)
    room = np.array([width - 2 * MARGIN, height - 2 * MARGIN - 5.0 * (len(words) + 2)])
    scale, start = float((room / pages.covered).min()), pages.start
    for tile in pages.tiles:
        corner = MARGIN + scale * (tile.lower - start)
        box = Rectangle(tuple(corner), *(scale * pages.shown), fill=False, ec=palette.FAINT, lw=0.1 * POINT)
        axes.add_patch(box)
        middle = corner + 0.5 * scale * pages.shown
        axes.text(*middle, f"{tile.row}-{tile.column}", fontsize=8, ha="center", va="center", color=palette.FAINT)
    for piece in pieces:
        for polygon in (piece.outer, *piece.inner):
            closed = MARGIN + scale * (np.vstack([polygon, polygon[:1]]) - start)
            axes.plot(*closed.T, color="black", lw=0.3 * POINT)
        axes.plot(*(MARGIN + scale * (piece.grain - start)).T, color=palette.LOW, lw=0.25 * POINT)
    return figure
