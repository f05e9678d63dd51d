"""Small diagrams of the residual against shear, distance, curvature and rim, with the band of the noise."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from geomdrap.export import palette
from geomdrap.export.layout import Box
from geomdrap.export.picture import place

if TYPE_CHECKING:
    from geomdrap.criticism import Comparison
    from geomdrap.criticism.compare_scores import Score
    from geomdrap.criticism.compare_trends import Trend

AROUND = (0.62, 0.52, 0.15, 0.62)
NOISE = "#9aa5b1"
UNITS = {"position": "mm", "shear": "°", "warp": "°", "weft": "°"}
CLEAR, POSSIBLE = 0.01, 0.1
"""Probabilities below which a correlation is called one, and may be one."""
SLIGHT = 0.25
"""Rank correlations below this are not worth a word, however sure."""


def draw_trend(figure: Any, box: Box, comparison: Comparison, trend: Trend, top: float) -> None:
    """Single residuals, their root mean square in bins, and what noise alone would give."""
    from geomdrap.criticism.compare_trends import AGAINST

    axes = place(figure, box.inset(*AROUND))
    size = _sizes(comparison, trend.kind)
    kept = comparison.trusted & np.isfinite(size)
    axes.plot(getattr(comparison.places, trend.against)[kept], size[kept], ".", ms=2.5, color="#c3cad2", zorder=1)
    score = getattr(comparison.scores, trend.kind)
    _noise_band(axes, trend, score, comparison.coordinates if trend.kind == "position" else 1)
    filled = trend.n > 0
    axes.plot(trend.middle[filled], trend.rms[filled], "o-", ms=4.5, lw=1.8, color=palette.HIGH, zorder=4)
    axes.set(ylim=(0.0, top), xlim=_limits(trend))
    axes.set_xlabel(AGAINST[trend.against], fontsize=8, color=palette.INK)
    axes.tick_params(labelsize=7.5, colors=palette.INK, length=3)
    axes.locator_params(nbins=5)
    for name, side in axes.spines.items():
        side.set_visible(name in ("left", "bottom"))
        side.set_color(palette.BARE_STRIPE)
    axes.set_ylabel(f"{trend.kind} [{UNITS[trend.kind]}]", fontsize=8, color=palette.INK)
    axes.set_title(verdict(trend), fontsize=8.5, loc="left", color=palette.INK, pad=5)


def verdict(trend: Trend) -> str:
    """What the correlation says, in words."""
    if trend.rho is None or trend.p is None:
        return "too few points to tell"
    numbers = f"ρ = {round(trend.rho, 2) + 0.0:+.2f}, p = {trend.p:.2g}"
    verb = "grow" if trend.rho > 0 else "fall"
    if trend.p > POSSIBLE:
        return f"no trend beyond chance ({numbers})"
    if abs(trend.rho) < SLIGHT:
        return f"hardly goes with it ({numbers})"
    return f"{verb}s with it ({numbers})" if trend.p < CLEAR else f"may {verb} with it ({numbers})"


def _noise_band(axes: Any, trend: Trend, score: Score | None, width: int) -> None:
    """Root mean square that noise alone would give in the bins, with twice its standard error."""
    if score is None or score.noise is None:
        return
    error = 2.0 / np.sqrt(2.0 * width * np.maximum(trend.n, 1))
    low, high = score.noise * np.maximum(1.0 - error, 0.0), score.noise * (1.0 + error)
    axes.stairs(high, trend.edges, baseline=low, fill=True, color=NOISE, alpha=0.55, zorder=2)
    axes.axhline(score.noise, color=NOISE, lw=1.0, zorder=3)


def _sizes(comparison: Comparison, kind: str) -> np.ndarray:
    """Sizes (n,) of the residuals of one kind."""
    known = {"shear": comparison.shear, "warp": comparison.warp_turn, "weft": comparison.weft_turn}
    values = known.get(kind)
    return comparison.size if values is None else np.abs(values)


def _limits(trend: Trend) -> tuple[float, float]:
    room = 0.03 * float(trend.edges[-1] - trend.edges[0])
    return float(trend.edges[0]) - room, float(trend.edges[-1]) + room


def top_of(comparison: Comparison, kind: str) -> float:
    """Top of the diagrams of one kind: holds the bins and nearly all single values."""
    size = _sizes(comparison, kind)
    known = size[comparison.trusted & np.isfinite(size)]
    bins = [trend.rms.max() for trend in comparison.trends if trend.kind == kind]
    return 1.08 * float(max(np.quantile(known, 0.99), *bins)) or 1.0
