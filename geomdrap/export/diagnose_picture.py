"""diagnose.png: what is wrong, what the effect found would do, and what it leaves; and how the others fare."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geomdrap.criticism import story
from geomdrap.criticism.before_after import before_and_after, difference, likeness, placed
from geomdrap.export import palette
from geomdrap.export.compare_flat import draw_flat
from geomdrap.export.compare_legend import draw_dot_bar, draw_size_bar
from geomdrap.export.compare_picture import save
from geomdrap.export.compare_scale import scale_of, signed_values
from geomdrap.export.compare_view import choose_camera, draw_dots, plain_skin
from geomdrap.export.layout import Box
from geomdrap.export.picture import DOTS, MARGIN, WIDTH

if TYPE_CHECKING:
    from geomdrap.criticism.diagnosis import Diagnosis

PANELS = 4.4
BARS = 0.8
ROW = 0.26
HEADLINE, LINE = 0.36, 0.22
"""Heights of the parts of the page, inch."""


def write(diagnosis: Diagnosis, path: Path) -> None:
    """Write diagnose.png; no date or path in it. Raises GeomdrapError if it cannot be written."""
    save(figure_of(diagnosis), path)


def figure_of(diagnosis: Diagnosis) -> Any:
    """The page: verdict, three columns (residual, signature, rest) on the fabric and on the part, all effects."""
    from matplotlib.figure import Figure

    table = ROW * len(diagnosis.tried) + 1.0
    headlines, lines = _words(diagnosis)
    header = 0.3 + HEADLINE * len(headlines) + LINE * len(lines)
    height = header + 2 * PANELS + BARS + table
    figure = Figure(figsize=(WIDTH, height), dpi=DOTS, facecolor=palette.PAPER)
    _heading(figure, headlines, lines)
    first, last = placed(diagnosis), before_and_after(diagnosis)[1]
    signature = difference(first, last)
    scale = scale_of([first])
    names = "+".join(e.name for e in diagnosis.effects if e.name != "placement")
    titles = (
        "Residual, placement fitted",
        f"Signature of {names} (likeness {likeness(first, signature):.2f})" if names else "No effect was found",
        "What is left",
    )
    width = (WIDTH - 2 * MARGIN) / 3
    camera, skin = choose_camera(first), plain_skin(first)
    for k, (title, comparison) in enumerate(zip(titles, (first, signature, last), strict=True)):
        box = Box(MARGIN + k * width, table + BARS + PANELS, width, PANELS)
        draw_flat(figure, box, comparison, scale, title)
        below = Box(MARGIN + k * width, table + BARS, width, PANELS)
        name = signed_values(comparison)[1] if k != 1 else "The same, as the model has it"
        draw_dots(figure, below, comparison, skin, title=name, camera=camera, scale=scale)
    draw_size_bar(figure, (MARGIN + 0.6, table + 0.32, 5.2, 0.16), scale)
    draw_dot_bar(figure, (WIDTH - MARGIN - 5.0, table + 0.32, 4.4, 0.16), first, scale)
    _effects(figure, diagnosis, table)
    return figure


def _words(diagnosis: Diagnosis) -> tuple[list[str], list[str]]:
    """The verdict, and what is said of it, in lines: warnings first, as the verdict is no better than the table."""
    more = [
        *(f"Warning: {warning}" for warning in diagnosis.warnings),
        story.error_sentence(diagnosis),
        story.placement_sentence(diagnosis),
        story.rival_sentence(diagnosis),
        *diagnosis.hints,
        *story.unseen_sentences(diagnosis),
    ]
    lines = [text for s in more if s for text in textwrap.wrap(s[0].upper() + s[1:], 190)]
    return textwrap.wrap(story.verdict_sentence(diagnosis), 92), lines


def _heading(figure: Any, headlines: list[str], lines: list[str]) -> None:
    wide, high = figure.get_size_inches()
    y = high - 0.2
    for line in headlines:
        figure.text(MARGIN / wide, y / high, line, fontsize=15, fontweight="bold", color=palette.INK, va="top")
        y -= HEADLINE
    for line in lines:
        figure.text(MARGIN / wide, y / high, line, fontsize=9.5, color=palette.INK, va="top")
        y -= LINE


def _effects(figure: Any, diagnosis: Diagnosis, height: float) -> None:
    """A bar per effect: the share of the misfit that it explains."""
    wide, high = figure.get_size_inches()
    tried = diagnosis.tried[::-1]
    shares = [100.0 * max(t.evidence.share, 0.0) for t in tried]
    axes = figure.add_axes((2.6 / wide, 0.55 / high, 6.2 / wide, (height - 0.95) / high))
    colours = [palette.INK if t.selected else palette.BARE_STRIPE for t in tried]
    axes.barh(range(len(tried)), shares, color=colours, height=0.62)
    axes.set_yticks(range(len(tried)), [t.name for t in tried], fontsize=9, color=palette.INK)
    axes.set_xlim(0.0, 100.0)
    axes.set_xlabel("share of what the model before it leaves above noise and scatter, %", fontsize=8.5)
    axes.tick_params(labelsize=8.5, colors=palette.INK, length=3)
    for name, side in axes.spines.items():
        side.set_visible(name in ("left", "bottom"))
    axes.text(101.5, len(tried), "held out, and fitted (± 95 %)", fontsize=8.5, va="center", color=palette.INK)
    for k, t in enumerate(tried):
        note = f"held out {story.held_out(t)}   {story.fitted_words(t)}"
        axes.text(101.5, k, note, fontsize=8.5, va="center", color=palette.INK if t.selected else palette.FAINT)
