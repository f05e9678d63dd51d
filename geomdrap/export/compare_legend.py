"""Key figures and colour bars of a comparison."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from geomdrap.export import palette
from geomdrap.export.compare_scale import SIGNED_COLOURS, CompareScale, signed_values, size_colours

if TYPE_CHECKING:
    from geomdrap.criticism import Comparison
    from geomdrap.criticism.compare_scores import Score

ENOUGH = 0.95
"""Share of the points with a prediction below which it is shown in alarm."""
QUIET = 1.5
"""Times the noise, or chi² per degree of freedom, up to which a number is not shown in alarm."""


def key_figures(comparison: Comparison) -> list[tuple[str, str, str]]:
    """Figure, its words, its colour; without the outliers, as they are set apart in the pictures."""
    scores = comparison.scores
    kind = "position, rms" if comparison.measurement.labelled else "off the part, rms"
    out = [_figure(scores.position, f"{kind}", " mm")]
    kinds = ((scores.shear, "shear, rms"), (scores.warp, "warp direction, rms"), (scores.weft, "weft direction, rms"))
    out += [_figure(score, words, "°") for score, words in kinds if score is not None]
    if scores.chi2_per_dof is not None:
        ratio = np.sqrt(scores.chi2_per_dof)
        colour = palette.INK if scores.chi2_per_dof < QUIET else palette.HIGH
        out.append((f"{ratio:.3g} ×", f"the noise, over all\n(χ² per value {scores.chi2_per_dof:.3g})", colour))
    used, n = int(comparison.used.sum()), len(comparison.measurement)
    words = f"points compared\n{n - used} without prediction" + (
        f", {len(set(o.row for o in comparison.outliers))} set apart" if comparison.outliers else ""
    )
    colour = palette.INK if used >= ENOUGH * n else palette.ALARM
    return [*out[:4], (f"{used} of {n}", words, colour)]


def _figure(score: Score | None, words: str, unit: str) -> tuple[str, str, str]:
    if score is None:
        return "–", words, palette.FAINT
    noise = "noise not known" if score.noise is None else f"noise alone: {score.noise:.2g}{unit}"
    loud = score.noise is not None and score.robust_rms > QUIET * score.noise
    return f"{score.robust_rms:.3g}{unit}", f"{words}\n{noise}", palette.HIGH if loud else palette.INK


def draw_size_bar(figure: Any, box: tuple[float, float, float, float], scale: CompareScale) -> None:
    """Colours of the residual vectors, mm; ``box`` in inches."""
    title = f"Length of the residual, mm (drawn × {scale.factor:g}; longer ones take the last colour)"
    _bar(figure, box, (0.0, scale.size), size_colours(), title)


def draw_dot_bar(
    figure: Any, box: tuple[float, float, float, float], comparison: Comparison, scale: CompareScale
) -> None:
    """Colours of the dots; ``box`` in inches."""
    from matplotlib import colormaps

    _, name, unit = signed_values(comparison)
    turn = " (counter-clockwise)" if "direction" in name else ""
    marks = ["×: stands out, set apart"] if comparison.outliers else []
    marks += ["○: no prediction"] if not comparison.used.all() else []
    title = f"{name}{turn}, {unit.strip()}" + "".join(f"      {mark}" for mark in marks)
    _bar(figure, box, (-scale.signed, scale.signed), colormaps[SIGNED_COLOURS], title)


def _bar(
    figure: Any, box: tuple[float, float, float, float], limits: tuple[float, float], colours: Any, title: str
) -> None:
    wide, high = figure.get_size_inches()
    left, bottom, width, height = box
    axes = figure.add_axes((left / wide, bottom / high, width / wide, height / high))
    table = np.asarray(colours(np.linspace(0.0, 1.0, 256)))[None, :, :3]
    axes.imshow(table, extent=(*limits, 0, 1), aspect="auto")
    axes.set_yticks([])
    axes.set_xticks(np.linspace(*limits, 5))
    axes.tick_params(labelsize=8.5, colors=palette.INK, length=3)
    axes.set_title(title, fontsize=9, color=palette.INK, loc="left", pad=4)
