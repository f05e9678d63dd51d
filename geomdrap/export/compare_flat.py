"""The flat fabric with residuals on it: how far marks lie along warp and weft from where they should."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from geomdrap.export import palette
from geomdrap.export.compare_scale import CompareScale, signed_values, size_colours, thinned
from geomdrap.export.compare_view import MOST_DOTS, MOST_VECTORS, SHAFT, dot_size, fabric_places, scatter_dots
from geomdrap.export.flat_map import draw_rosette
from geomdrap.export.layout import Box
from geomdrap.export.picture import AROUND_MAP, caption, place

if TYPE_CHECKING:
    from geomdrap.criticism import Comparison


def draw_flat(figure: Any, box: Box, comparison: Comparison, scale: CompareScale, title: str) -> None:
    """Marks at their fabric coordinates with their residuals along warp and weft.

    Without fabric coordinates of their own there is no such residual: then dots with the signed one.
    """
    axes = place(figure, box.inset(*AROUND_MAP))
    _frame(axes, comparison)
    where = fabric_places(comparison)
    if comparison.measurement.labelled:
        _vectors(axes, comparison, where, scale)
    else:
        values, _, _ = signed_values(comparison)
        drawn = thinned(where, np.flatnonzero(comparison.trusted & np.isfinite(values)), MOST_DOTS)
        scatter_dots(axes, where[drawn], values[drawn], scale, dot_size(len(drawn)))
    _marks(axes, where, comparison)
    caption(figure, box, title)


def _frame(axes: Any, comparison: Comparison) -> None:
    """Axes in mm of fabric, the net as a grey ground, the rosette."""
    from matplotlib.colors import ListedColormap

    net, matched = comparison.net, comparison.matched
    box = (net.u[0], net.u[-1], net.v[0], net.v[-1])
    ground = np.ma.masked_equal(net.cell_valid.T, False)
    colours = ListedColormap(["#eef0f2"])
    axes.imshow(ground, extent=box, origin="lower", interpolation="nearest", cmap=colours, zorder=1)
    known = np.isfinite(matched.u)
    lower = np.array([min(box[0], matched.u[known].min()), min(box[2], matched.v[known].min())])
    upper = np.array([max(box[1], matched.u[known].max()), max(box[3], matched.v[known].max())])
    room = 0.05 * float((upper - lower).max())
    axes.set_aspect("equal", adjustable="box", anchor="C")
    axes.set(xlim=(lower[0] - room, upper[0] + room), ylim=(lower[1] - room, upper[1] + room))
    axes.set_xlabel("u, along the warp [mm]", fontsize=8.5, color=palette.INK)
    axes.set_ylabel("v, along the weft [mm]", fontsize=8.5, color=palette.INK)
    axes.tick_params(labelsize=8, colors=palette.INK, length=3)
    axes.locator_params(nbins=6, min_n_ticks=2)
    for side in axes.spines.values():
        side.set_color(palette.BARE_STRIPE)
    arrow = 0.12 * float((upper - lower).min())
    draw_rosette(axes, (0.0, 0.0), (arrow, 0.0), (0.0, arrow))


def _vectors(axes: Any, comparison: Comparison, where: np.ndarray, scale: CompareScale) -> None:
    rows = thinned(where, np.flatnonzero(comparison.trusted), MOST_VECTORS)
    rows = rows[np.argsort(comparison.size[rows], kind="stable")]
    axes.quiver(
        *where[rows].T,
        *(scale.factor * comparison.parts[rows, :2]).T,
        comparison.size[rows],
        cmap=size_colours(),
        clim=(0.0, scale.size),
        angles="xy",
        scale_units="xy",
        scale=1.0,
        width=1.5 * SHAFT,
        headwidth=4.5,
        headlength=5.0,
        zorder=5,
    )


def _marks(axes: Any, where: np.ndarray, comparison: Comparison) -> None:
    """Outliers as crosses, points without a prediction as grey circles."""
    rows = sorted({outlier.row for outlier in comparison.outliers})
    axes.plot(*where[rows].T, "x", ms=6, mew=1.6, color=palette.LIMIT_LINE, zorder=6)
    lost = ~comparison.used & np.isfinite(where).all(axis=1)
    axes.plot(*where[lost].T, "o", ms=3.5, mfc="none", mec=palette.FAINT, mew=0.8, zorder=4)
