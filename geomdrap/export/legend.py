"""Words around the pictures: title and key figures above; scales, classes and warnings below."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geomdrap.export import palette
from geomdrap.export.glyphs import drawable
from geomdrap.export.report_json import is_incomplete

if TYPE_CHECKING:
    from geomdrap.fields import Drape

SCALES = 0.95
"""Height of the strip with colour bar and classes, inch."""
LINE = 0.20
"""Height of a line of warnings, inch."""
MOST_LINES = 8


def draw_header(figure: Any, result: Drape, margin: float) -> None:
    """Part, how it was draped, and the five figures that people ask for."""
    wide, high = figure.get_size_inches()
    net = result.net
    where = position(net.origin, net.surface.diagonal)
    name = drawable(textwrap.shorten(Path(net.surface.source).name, 40, placeholder="…") or "surface")
    figure.text(
        margin / wide, 1 - 0.22 / high, name, fontsize=18, fontweight="bold", color=palette.INK, va="top"
    )
    settings = [f"warp at {net.angle:g}°", f"origin ({where}) mm", f"pitch {net.pitch:.4g} mm"]
    line = ",  ".join([*settings, f"limit {result.limit_angle:g}°"])
    figure.text(margin / wide, 1 - 0.68 / high, line, fontsize=10.5, color=palette.INK, va="top")
    figures = key_figures(result)
    for k, (number, words, colour) in enumerate(figures):
        x = (wide - margin - 1.6 * (len(figures) - k)) / wide
        figure.text(x, 1 - 0.22 / high, number, fontsize=15, fontweight="bold", color=colour, va="top")
        figure.text(x, 1 - 0.68 / high, words, fontsize=8.5, color=palette.FAINT, va="top")


def key_figures(result: Drape) -> list[tuple[str, str, str]]:
    """Figure, its name, its colour."""
    statistics, area = result.statistics, result.area
    complete = not is_incomplete(result)
    return [
        (
            degrees(statistics.max),
            "largest shear",
            palette.HIGH if statistics.max > result.limit_angle else palette.INK,
        ),
        (degrees(statistics.p95), "95th percentile", palette.INK),
        (
            f"{100 * area.coverage:.1f} %",
            "draped" if complete else "draped: INCOMPLETE",
            palette.INK if complete else palette.ALARM,
        ),
        (grouped(area.part), "part, mm²", palette.INK),
        (grouped(area.fabric), "fabric, mm²", palette.INK),
    ]


def degrees(angle: float) -> str:
    """'52.4°', or a dash where there is no number."""
    return f"{angle:.1f}°" if np.isfinite(angle) else "–"


def grouped(area: float) -> str:
    """Area with thin spaces between the thousands; four figures where it is small."""
    return f"{area:,.0f}".replace(",", "\u2009") if area >= 1000 else f"{area:.4g}"


def position(point: Sequence[float] | np.ndarray, diagonal: float) -> str:
    """A point in mm to 1/10000 of the part's diagonal: 'x, y, z'."""
    decimals = int(np.clip(4 - np.ceil(np.log10(diagonal)), 0, 6))
    digits = [f"{round(float(x), decimals) + 0.0:.{decimals}f}" for x in point]
    return ", ".join(text.rstrip("0").rstrip(".") if decimals else text for text in digits)


def warning_lines(result: Drape) -> list[str]:
    """What a reader must not miss: bare patches with their reasons, then the warnings of the drape."""
    lines = []
    if is_incomplete(result):
        lines.append(f"INCOMPLETE: {100 * (1 - result.area.coverage):.1f} % of the part is not draped.")
        for region in sorted(result.bare, key=lambda region: -region.area)[:3]:
            where = position(region.center, result.net.surface.diagonal)
            lines.append(f"Bare: {grouped(region.area)} mm² about ({where}): {region.reason}")
        if len(result.bare) > 3:
            lines.append(f"… and {len(result.bare) - 3} smaller bare regions")
    for warning in result.warnings:
        lines += textwrap.wrap(warning, 190, subsequent_indent="    ")
    if len(lines) > MOST_LINES:
        lines = [
            *lines[: MOST_LINES - 1],
            f"… and {len(lines) - MOST_LINES + 1} more lines of warnings in the report",
        ]
    return lines


def footer_height(result: Drape) -> float:
    """Inches that scales and warnings take at the foot of the page."""
    lines = len(warning_lines(result))
    return SCALES + (0.35 + LINE * lines if lines else 0.05)


def draw_footer(figure: Any, result: Drape, top: float, margin: float) -> None:
    """Colour bar of the views, classes of the flat map, warnings."""
    wide, _ = figure.get_size_inches()
    bottom = footer_height(result) - SCALES
    draw_colour_bar(figure, result, top, (margin + 0.15, bottom + 0.42, 0.38 * wide, 0.17))
    draw_classes(figure, result, margin + 0.15 + 0.45 * wide, bottom)
    draw_warnings(figure, warning_lines(result), margin)


def draw_colour_bar(figure: Any, result: Drape, top: float, box: tuple[float, float, float, float]) -> None:
    """Continuous scale of |shear|, deg, with the limit angle marked on it."""
    wide, high = figure.get_size_inches()
    left, bottom, width, height = box
    axes = figure.add_axes((left / wide, bottom / high, width / wide, height / high))
    axes.imshow(palette.continuous_table()[None], extent=(0, top, 0, 1), aspect="auto")
    axes.set_yticks([])
    axes.tick_params(labelsize=8.5, colors=palette.INK, length=3)
    step = 10.0 if top > 45.0 else 5.0 if top > 5.0 else 1.0
    ticks = [*np.arange(0.0, top - 0.4 * step, step), top]
    axes.set_xticks(ticks)
    labels = [f"{t:g}°" for t in ticks]
    if result.statistics.max > top:
        labels[-1] = f"≥ {top:g}°"
    axes.set_xticklabels(labels)
    title = "Shear angle on the part (size, without sign)"
    axes.set_title(title, fontsize=9, color=palette.INK, loc="left", pad=4)
    if result.limit_angle < top:
        axes.axvline(result.limit_angle, color=palette.LIMIT_LINE, lw=3)
        words = f"cyan line: the limit, {result.limit_angle:g}°"
        axes.text(top, 1.25, words, fontsize=9, color=palette.INK, ha="right", va="bottom")


def draw_classes(figure: Any, result: Drape, left: float, bottom: float) -> None:
    """Blue, yellow, red and bare, each with its range and its share of the draped area."""
    from matplotlib.patches import Rectangle

    wide, high = figure.get_size_inches()
    limit, shares = result.limit_angle, result.statistics
    over, half = shares.over_limit, shares.over_half_limit
    entries = [
        (palette.LOW, f"under {0.5 * limit:g}°", share_words(1 - half), ""),
        (palette.MIDDLE, f"{0.5 * limit:g}° to {limit:g}°", share_words(half - over), ""),
        (palette.HIGH, f"over {limit:g}°, the limit", share_words(over), ""),
        (palette.BARE, "bare", f"{100 * max(0.0, 1 - result.area.coverage):.1f} % of the part", "/////"),
    ]
    title = "Flat pattern: classes of the limit angle, share of the draped area"
    figure.text(left / wide, (bottom + 0.78) / high, title, fontsize=9, color=palette.INK, va="center")
    for k, (colour, words, share, hatch) in enumerate(entries):
        x, y = left + k * 1.98, bottom + 0.36
        patch = Rectangle(
            (x / wide, y / high),
            0.3 / wide,
            0.23 / high,
            facecolor=colour,
            edgecolor=palette.BARE_STRIPE,
            hatch=hatch,
            lw=0.5,
            transform=figure.transFigure,
        )
        figure.add_artist(patch)
        figure.text((x + 0.38) / wide, (y + 0.165) / high, words, fontsize=9, color=palette.INK, va="center")
        figure.text(
            (x + 0.38) / wide, (y - 0.005) / high, share, fontsize=8.5, color=palette.FAINT, va="center"
        )


def share_words(share: float) -> str:
    """Share 0 to 1 in per cent, a dash where there is none."""
    return f"{100 * share:.1f} %" if np.isfinite(share) else "–"


def draw_warnings(figure: Any, lines: list[str], margin: float) -> None:
    """The warnings in a box over the width of the page."""
    from matplotlib.patches import FancyBboxPatch

    if not lines:
        return
    wide, high = figure.get_size_inches()
    height = LINE * len(lines) + 0.14
    box = FancyBboxPatch(
        (margin / wide, 0.14 / high),
        1 - 2 * margin / wide,
        height / high,
        boxstyle="square,pad=0",
        facecolor="#fff4e5",
        edgecolor="#e0a458",
        lw=1,
        transform=figure.transFigure,
    )
    figure.add_artist(box)
    for k, line in enumerate(lines):
        y = 0.14 + height - 0.07 - LINE * (k + 0.5)
        alarm = line.startswith("INCOMPLETE")
        figure.text(
            (margin + 0.15) / wide,
            y / high,
            drawable(line),
            fontsize=9,
            va="center",
            color=palette.ALARM if alarm else palette.INK,
            fontweight="bold" if alarm else "normal",
        )
