"""improve.png: how the error falls as effects are added, and the residuals before and after on one scale."""

from __future__ import annotations

import textwrap
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geomdrap.criticism.before_after import before_and_after
from geomdrap.criticism.story import error_sentence, verdict_sentence
from geomdrap.export import palette
from geomdrap.export.compare_picture import draw_pair, save
from geomdrap.export.picture import DOTS, MARGIN, WIDTH

if TYPE_CHECKING:
    from geomdrap.criticism.improve import Improvement

WATERFALL = 3.6
"""Height of the upper part of the page, inch."""


def write(improvement: Improvement, path: Path) -> None:
    """Write improve.png; no date or path in it. Raises GeomdrapError if it cannot be written."""
    save(figure_of(improvement), path)


def figure_of(improvement: Improvement) -> Any:
    """The page: verdict, waterfall of the error, residuals before and after."""
    from matplotlib.figure import Figure

    from geomdrap.export.compare_picture import pair_height

    height = WATERFALL + pair_height()
    figure = Figure(figsize=(WIDTH, height), dpi=DOTS, facecolor=palette.PAPER)
    draw_pair(figure, *before_and_after(improvement.diagnosis))
    _words(figure, improvement)
    _waterfall(figure, improvement)
    return figure


def _words(figure: Any, improvement: Improvement) -> None:
    wide, high = figure.get_size_inches()
    diagnosis = improvement.diagnosis
    y = high - 0.2
    for line in textwrap.wrap(verdict_sentence(diagnosis), 46):
        figure.text(MARGIN / wide, y / high, line, fontsize=14, fontweight="bold", color=palette.INK, va="top")
        y -= 0.34
    for sentence in (error_sentence(diagnosis), *improvement.notes, *diagnosis.hints):
        for line in textwrap.wrap(sentence[0].upper() + sentence[1:], 84):
            figure.text(MARGIN / wide, (y - 0.1) / high, line, fontsize=9.5, color=palette.INK, va="top")
            y -= 0.22


def _waterfall(figure: Any, improvement: Improvement) -> None:
    _, high = figure.get_size_inches()
    steps, floor = improvement.diagnosis.steps, improvement.diagnosis.noise_floor
    axes = figure.add_axes((0.5, (high - WATERFALL + 0.75) / high, 0.46, (WATERFALL - 1.15) / high))
    names = ["as meant" if s.added is None else f"+ {s.added}" for s in steps]
    for k, step in enumerate(steps):
        axes.bar(k - 0.19, step.error, 0.36, color=palette.INK, label="fitted" if k == 0 else None)
        axes.bar(k + 0.19, step.cv_error, 0.36, color=palette.BARE_STRIPE, label="held out" if k == 0 else None)
        axes.text(k + 0.19, step.cv_error, f"{step.cv_error:.2f}", ha="center", va="bottom", fontsize=8.5)
        axes.text(k - 0.19, step.error, f"{step.error:.2f}", ha="center", va="bottom", fontsize=8.5)
    axes.axhline(floor, color=palette.LIMIT_LINE, lw=1.4, label=f"noise and scatter alone: {floor:.2f}")
    axes.set_xticks(range(len(steps)), names, fontsize=9.5, color=palette.INK)
    axes.set_ylabel("error over the noise", fontsize=9, color=palette.INK)
    axes.tick_params(labelsize=8.5, colors=palette.INK, length=3)
    axes.legend(frameon=False, fontsize=9)
    for name, side in axes.spines.items():
        side.set_visible(name in ("left", "bottom"))
