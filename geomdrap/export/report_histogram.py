"""How much of the draped area shears how far, as a small drawing in SVG for report.html."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from geomdrap.export import palette
from geomdrap.export.ply_corners import piece_shear

if TYPE_CHECKING:
    from geomdrap.fields import Drape

BARS = 30
WIDTH, HEIGHT, FOOT = 360.0, 96.0, 18.0
HEAD = 14.0
"""Room above the bars for the words at the limit."""


def histogram(result: Drape) -> str:
    """Bars of the share of the draped area between equal steps of shear, in the colours of the limit classes."""
    limit = result.limit_angle
    top = palette.top_of_scale(result.statistics.max, limit)
    share = area_shares(result, top)
    if not share.any():
        return ""
    step, most = WIDTH / BARS, float(share.max())
    bars = []
    for k, part in enumerate(share.tolist()):
        high = (HEIGHT - HEAD) * part / most
        colour = ("low", "middle", "high")[int(palette.class_of(np.array([(k + 0.5) * top / BARS]), limit)[0])]
        words = f"{k * top / BARS:.3g}° to {(k + 1) * top / BARS:.3g}°: {100 * part:.1f} %"
        bars.append(
            f'<rect x="{k * step + 0.5:.2f}" y="{HEIGHT - high:.2f}" width="{step - 1:.2f}" height="{high:.2f}" '
            f'style="fill:var(--{colour})"><title>{words}</title></rect>'
        )
    place = WIDTH * limit / top
    line = f'<line class="limit" x1="{place:.1f}" x2="{place:.1f}" y1="0" y2="{HEIGHT}"/>' if place < WIDTH else ""
    marks = "".join(
        f'<text x="{WIDTH * x:.0f}" y="{HEIGHT + 13}" text-anchor="{anchor}">{x * top:g}°</text>'
        for x, anchor in ((0.0, "start"), (0.5, "middle"), (1.0, "end"))
    )
    return (
        f'<svg class="histogram" viewBox="0 0 {WIDTH:g} {HEIGHT + FOOT:g}" role="img" '
        f'aria-label="Share of the draped area by shear">{"".join(bars)}'
        f'<line x1="0" x2="{WIDTH:g}" y1="{HEIGHT:g}" y2="{HEIGHT:g}"/>{line}{marks}</svg>'
    )


def area_shares(result: Drape, top: float) -> np.ndarray:
    """Shares (BARS,) of the draped area by the size of its shear, 0 to ``top`` degrees and beyond."""
    trimmed = result.trimmed
    weight = trimmed.area * trimmed.share
    on = weight > 0.0
    size = np.abs(piece_shear(result)[on])
    bar = np.minimum((size / top * BARS).astype(int), BARS - 1)
    total = np.bincount(bar, weight[on], BARS)
    return np.asarray(total / total.sum() if len(size) else total)
