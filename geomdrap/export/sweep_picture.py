"""sweep.png: how the criteria go with the heading, and which origins on the part are good."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geomdrap.export import palette
from geomdrap.export.glyphs import drawable
from geomdrap.export.layout import Box
from geomdrap.export.picture import DOTS
from geomdrap.export.sweep_angle_plot import draw_angles, shown_criteria
from geomdrap.export.sweep_origin_map import draw_origins
from geomdrap.export.whole import write_whole

if TYPE_CHECKING:
    from geomdrap.sweep import Row, Sweep

MARGIN = 0.35
HEADER = 0.85
PLOT = (7.4, 1.75)
"""Width and height of the diagram of a criterion, inch."""
MAP = 6.6
"""Width of the map, inch."""


def write(sweep: Sweep, path: Path, way: Sequence[Row] = ()) -> None:
    """Write the picture of a sweep as a PNG, with the ``way`` of a search if there was one; no date or path in it.

    Raises GeomdrapError if it cannot be written.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    buffer = io.BytesIO()
    FigureCanvasAgg(draw(sweep, way)).print_png(buffer, metadata={"Software": None})
    write_whole(path, buffer.getvalue())


def draw(sweep: Sweep, way: Sequence[Row] = ()) -> Any:
    """The picture as a matplotlib Figure: a header, diagrams over the heading, a map of the origins."""
    from matplotlib.figure import Figure

    several_angles = len({row.angle for row in sweep.rows}) > 1
    several_origins = len({row.asked for row in sweep.rows}) > 1
    names = shown_criteria(sweep) if several_angles else ()
    left = PLOT[0] if names else 0.0
    right = MAP if several_origins or not names else 0.0
    height = max(PLOT[1] * len(names) + 0.35, 5.6 if right else 0.0)
    figure = Figure(figsize=(left + right + 2 * MARGIN, height + HEADER + MARGIN), dpi=DOTS, facecolor=palette.PAPER)
    _draw_header(figure, sweep)
    if names:
        draw_angles(figure, Box(MARGIN, MARGIN, left, height), sweep, names)
    if right:
        draw_origins(figure, Box(MARGIN + left, MARGIN, right, height), sweep, way)
    return figure


def _draw_header(figure: Any, sweep: Sweep) -> None:
    """Part, number of cases, the best of them."""
    wide, high = figure.get_size_inches()
    best, name = sweep.best, drawable(Path(sweep.job.surface.source).name)
    failures = sum(row.reason is not None for row in sweep.rows)
    said = f", {failures} failed" if failures else ""
    where = ", ".join(f"{round(x, 1) + 0.0:g}" for x in best.origin)
    figure.text(MARGIN / wide, 1 - 0.2 / high, name, fontsize=16, fontweight="bold", color=palette.INK, va="top")
    words = f"{len(sweep.rows)} cases{said}, ranked by {sweep.objective}.  Best: warp at {best.angle:g}°"
    line = f"{words}, origin ({where}) mm"
    figure.text(MARGIN / wide, 1 - 0.6 / high, line, fontsize=10, color=palette.INK, va="top")
