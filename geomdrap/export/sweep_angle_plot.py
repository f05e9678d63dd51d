"""Diagrams of the criteria over the heading: a line per origin, that of the best case drawn bold."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from geomdrap.export import palette
from geomdrap.export.layout import Box
from geomdrap.export.picture import place

if TYPE_CHECKING:
    from geomdrap.sweep import Row, Sweep

AROUND = (0.75, 0.12, 0.2, 0.3)
AXIS = 0.35
"""Room for the words under the lowest diagram, inch."""
ALWAYS = ("p95-shear", "max-shear", "coverage", "blank-area")
LARGE = 1e5
"""Parts from this area on, mm², have their areas drawn in m²."""
OTHERS = "#b7c0ca"


def shown_criteria(sweep: Sweep) -> tuple[str, ...]:
    """Names of the criteria that are drawn: those of the objective first."""
    return tuple(dict.fromkeys((*(name for name, _ in sweep.objective.weights), *ALWAYS)))


def draw_angles(figure: Any, box: Box, sweep: Sweep, names: tuple[str, ...]) -> None:
    """One diagram per criterion, one above the other, over the same headings."""
    height = (box.height - AXIS) / len(names)
    best = sweep.best
    for n, name in enumerate(names):
        bottom = box.bottom + box.height - (n + 1) * height
        axes = place(figure, Box(box.left, bottom, box.width, height).inset(*AROUND))
        _draw_criterion(axes, sweep, name)
        axes.axvline(best.angle, color=palette.HIGH, lw=0.8, ls=(0, (3, 3)), zorder=1)
        if n < len(names) - 1:
            axes.set_xticklabels([])
    axes.set_xlabel("heading of the warp at the origin [°]", fontsize=9, color=palette.INK)


def _draw_criterion(axes: Any, sweep: Sweep, name: str) -> None:
    from geomdrap.sweep import CRITERIA

    criterion, best = CRITERIA[name], sweep.best
    unit, scale = ("m²", 1e-6) if criterion.unit == "mm²" and best.part_area >= LARGE else (criterion.unit, 1.0)
    by_origin: dict[object, list[Row]] = {}
    for row in sorted((row for row in sweep.rows if row.reason is None), key=lambda row: row.angle):
        by_origin.setdefault(row.asked, []).append(row)
    for asked, rows in by_origin.items():
        chosen = asked == best.asked
        style = (
            {"color": palette.INK, "lw": 2.0, "zorder": 3} if chosen else {"color": OTHERS, "lw": 0.9, "zorder": 2}
        )
        axes.plot(
            [row.angle for row in rows], [scale * criterion.of(row) for row in rows], marker="o", ms=2.5, **style
        )
    axes.plot(best.angle, scale * criterion.of(best), "o", ms=8, mfc="none", mec=palette.HIGH, mew=2.0, zorder=4)
    _fit(axes, scale * np.array([criterion.of(row) for rows in by_origin.values() for row in rows]))
    word = "bold: origin of the best case, " if len(by_origin) > 1 else ""
    title = f"{criterion.words} [{unit}]     {word}best case {scale * criterion.of(best):.4g}"
    axes.set_title(title, fontsize=9, loc="left", color=palette.INK, pad=4)
    axes.tick_params(labelsize=8, colors=palette.INK, length=3)
    axes.grid(axis="y", color="#e4e8ec", lw=0.7)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)


def _fit(axes: Any, values: np.ndarray) -> None:
    """Limits that hold all values; rounding must not look like a result."""
    low, high = float(values.min()), float(values.max())
    room = max(0.08 * (high - low), 0.01 * abs(high), 1e-3)
    axes.set_ylim(low - room if low > room else -0.2 * room, high + room)
