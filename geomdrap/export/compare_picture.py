"""compare.png: residuals on the part and on the flat fabric, what they go with, and where they are worst."""

from __future__ import annotations

import io
import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geomdrap.export import palette
from geomdrap.export.compare_flat import draw_flat
from geomdrap.export.compare_legend import draw_dot_bar, draw_size_bar, key_figures
from geomdrap.export.compare_scale import CompareScale, scale_of, signed_values
from geomdrap.export.compare_trend_plot import draw_trend, top_of
from geomdrap.export.compare_view import choose_camera, draw_dots, draw_vectors, plain_skin
from geomdrap.export.glyphs import drawable
from geomdrap.export.layout import Box
from geomdrap.export.legend import position
from geomdrap.export.picture import DOTS, MARGIN, WIDTH
from geomdrap.export.whole import write_whole

if TYPE_CHECKING:
    from geomdrap.criticism import Comparison

NOISE_ONLY = 1.15
"""Times what noise alone would give: below, residual vectors are said to be noise, unless neighbours are alike."""
HEADER = 1.1
PANELS = 4.7
BARS = 0.8
TRENDS = 2.5
LINE = 0.21
"""Heights of the parts of the page, inch."""


def write(comparison: Comparison, path: Path) -> None:
    """Write compare.png; no date or path in it. Raises GeomdrapError if it cannot be written."""
    draw(comparison, path)


def draw(comparison: Comparison, path: Path) -> None:
    """Draw a comparison as a page for an engineer, and write it as PNG."""
    save(figure_of(comparison), path)


def draw_before_after(first: Comparison, second: Comparison, path: Path) -> None:
    """Draw two comparisons of one measurement one above the other, on one scale of colours and lengths."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(WIDTH, pair_height()), dpi=DOTS, facecolor=palette.PAPER)
    draw_pair(figure, first, second)
    save(figure, path)


def pair_height() -> float:
    """Height of two comparisons one above the other, inch."""
    return 2 * (HEADER + PANELS) + BARS


def draw_pair(figure: Any, first: Comparison, second: Comparison) -> None:
    """Draw two comparisons at the foot of a page."""
    scale = scale_of([first, second])
    camera = choose_camera(first)
    for k, (words, comparison) in enumerate((("before", first), ("after", second))):
        bottom = BARS + (1 - k) * (HEADER + PANELS)
        _heading(figure, comparison, bottom + PANELS, f"{words.capitalize()}: ")
        _panels(figure, comparison, bottom, scale, camera)
    _bars(figure, second, 0.0, scale)


def save(figure: Any, path: Path) -> None:
    """Write a matplotlib figure as PNG, in one piece."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    buffer = io.BytesIO()
    FigureCanvasAgg(figure).print_png(buffer, metadata={"Software": None}, pil_kwargs={"compress_level": 4})
    write_whole(path, buffer.getvalue())


def figure_of(comparison: Comparison) -> Any:
    """The page: key figures, three panels, diagrams, worst regions and warnings."""
    from matplotlib.figure import Figure

    lines = _lines(comparison)
    kinds = list(dict.fromkeys(trend.kind for trend in comparison.trends))
    foot = LINE * len(lines) + 0.25
    height = HEADER + PANELS + BARS + TRENDS * len(kinds) + foot
    figure = Figure(figsize=(WIDTH, height), dpi=DOTS, facecolor=palette.PAPER)
    scale = scale_of([comparison])
    _heading(figure, comparison, height - HEADER, "")
    _panels(figure, comparison, height - HEADER - PANELS, scale, choose_camera(comparison))
    _bars(figure, comparison, height - HEADER - PANELS - BARS, scale)
    for row, kind in enumerate(kinds):
        _trends(figure, comparison, kind, foot + TRENDS * (len(kinds) - 1 - row))
    _write_lines(figure, lines, foot - 0.12)
    return figure


def _heading(figure: Any, comparison: Comparison, bottom: float, prefix: str) -> None:
    """Part and measurement, how it was draped, key figures; ``bottom`` inch from the foot of the page."""
    wide, high = figure.get_size_inches()
    net, top = comparison.net, (bottom + HEADER - 0.2) / high
    title = f"{prefix}{Path(net.surface.source).name} against {comparison.measurement.source}"
    title = drawable(textwrap.shorten(title, 62, placeholder="…"))
    figure.text(MARGIN / wide, top, title, fontsize=17, fontweight="bold", color=palette.INK, va="top")
    where = position(net.origin, net.surface.diagonal)
    line = f"warp at {net.angle:g}°,  origin ({where}) mm,  pitch {net.pitch:.4g} mm"
    figure.text(MARGIN / wide, top - 0.46 / high, line, fontsize=10.5, color=palette.INK, va="top")
    figures = key_figures(comparison)
    for k, (number, words, colour) in enumerate(figures):
        x = (wide - MARGIN - 2.0 * (len(figures) - k)) / wide
        figure.text(x, top, number, fontsize=14, fontweight="bold", color=colour, va="top")
        figure.text(x, top - 0.36 / high, words, fontsize=8.5, color=palette.FAINT, va="top", linespacing=1.3)


def _panels(figure: Any, comparison: Comparison, bottom: float, scale: CompareScale, camera: Any) -> None:
    """Vectors on the part, vectors on the flat fabric, dots on the part."""
    width = (WIDTH - 2 * MARGIN) / 3
    boxes = [Box(MARGIN + k * width, bottom, width, PANELS) for k in range(3)]
    skin = plain_skin(comparison)
    labelled = comparison.measurement.labelled
    _, name, _ = signed_values(comparison)
    views = {"camera": camera, "scale": scale}
    title = "Predicted to measured place" if labelled else "Off the part, along its normal"
    if _noise_only(comparison):
        shear = comparison.structure.shear
        title += ": noise only, unlike the shear" if shear is not None and shear.alike else ": noise only"
    draw_vectors(figure, boxes[0], comparison, skin, title=title, **views)
    along = f"along warp and weft, vectors × {scale.factor:g}"
    rest = "the same as on the right"
    draw_flat(figure, boxes[1], comparison, scale, f"On the flat fabric: {along if labelled else rest}")
    draw_dots(figure, boxes[2], comparison, skin, title=name, **views)


def _noise_only(comparison: Comparison) -> bool:
    """Whether the residuals of positions are as large as their noise, and neighbours no more alike than by chance."""
    score, likeness = comparison.scores.position, comparison.structure.position
    small = score is not None and score.noise is not None and score.rms < NOISE_ONLY * score.noise
    return small and not (likeness is not None and likeness.alike)


def _bars(figure: Any, comparison: Comparison, bottom: float, scale: CompareScale) -> None:
    draw_size_bar(figure, (MARGIN + 0.6, bottom + 0.32, 5.2, 0.16), scale)
    draw_dot_bar(figure, (WIDTH - MARGIN - 5.0, bottom + 0.32, 4.4, 0.16), comparison, scale)


def _trends(figure: Any, comparison: Comparison, kind: str, bottom: float) -> None:
    """A row of diagrams of one kind of residual, and what is in them."""
    wide, high = figure.get_size_inches()
    name = {"warp": "warp direction", "weft": "weft direction"}.get(kind, kind)
    words = f"What the {name} residual goes with: red, root mean square in bins; grey band, noise alone"
    y = (bottom + TRENDS - 0.02) / high
    figure.text((MARGIN + 0.15) / wide, y, words, fontsize=9.5, fontweight="bold", color=palette.INK, va="top")
    trends = [trend for trend in comparison.trends if trend.kind == kind]
    width, top = (WIDTH - 2 * MARGIN) / 4, top_of(comparison, kind)
    for k, trend in enumerate(trends):
        draw_trend(figure, Box(MARGIN + k * width, bottom, width, TRENDS), comparison, trend, top)


def _lines(comparison: Comparison) -> list[tuple[str, bool]]:
    """Worst regions, then warnings (True): the words at the foot of the page."""
    from geomdrap.criticism.compare_regions import region_words, unmeasured, worst_regions

    lines = [("Worst:  " + text, False) for text in (region_words(r) for r in worst_regions(comparison))]
    if not lines:
        noises = (comparison.noise_xyz, comparison.noise_shear, comparison.noise_warp, comparison.noise_weft)
        known = any(noise.sigma is not None for noise in noises)
        of = "the noise" if known else "what is usual here; the noise is not known"
        lines = [(f"No region where the residual stands out of {of}.", False)]
    share, _ = unmeasured(comparison)
    if share > 0.02:
        lines.append((f"{100 * share:.0f} % of the part's area has no measured point nearby.", False))
    for warning in comparison.warnings[:4]:
        lines += [(text, True) for text in textwrap.wrap("Warning: " + warning, 190, subsequent_indent="    ")]
    return lines


def _write_lines(figure: Any, lines: list[tuple[str, bool]], top: float) -> None:
    wide, high = figure.get_size_inches()
    for k, (text, alarm) in enumerate(lines):
        y = (top - LINE * k) / high
        colour = palette.ALARM if alarm else palette.INK
        figure.text((MARGIN + 0.15) / wide, y, text, fontsize=9, color=colour, va="top")
