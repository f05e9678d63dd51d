"""The flat pattern as a map: cells in the three classes of the limit angle, contours, yarns, rosette."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from geomdrap.export import palette

if TYPE_CHECKING:
    from geomdrap.fields import Drape, FlatPattern
    from geomdrap.fields.strips import Seam

Floats = NDArray[np.float64]

RIM = 2
"""Cells by which colours are carried on over the rim of the net, up to the contour of the pattern."""


def pattern_extent(flat: FlatPattern) -> tuple[Floats, Floats]:
    """Lower left and upper right corner (2,) of the outer contours, mm; of the origin if there are none."""
    points = np.vstack([np.zeros((0, 2)), *flat.outer]) if flat.outer else np.zeros((1, 2))
    return points.min(axis=0), points.max(axis=0)


def draw_flat_map(axes: Any, result: Drape, every: int, arrow: float) -> None:
    """Draw the pattern on matplotlib axes in mm of fabric; every so-many-th yarn; arrows `arrow` mm long."""
    from matplotlib.collections import LineCollection
    from matplotlib.patches import PathPatch

    flat, pitch = result.flat, result.net.pitch
    if flat.outer:
        outline = compound_path([*flat.outer, *flat.inner])
        axes.add_patch(
            PathPatch(
                outline, facecolor=palette.BARE, edgecolor=palette.BARE_STRIPE, hatch="////", lw=0, zorder=1
            )
        )
        draw_cells(axes, result, outline)
        warp = [line for line in flat.warp_lines if round(float(line[0][1]) / pitch) % every == 0]
        weft = [line for line in flat.weft_lines if round(float(line[0][0]) / pitch) % every == 0]
        for lines, colour, opacity in ((warp, palette.INK, 0.45), (weft, palette.PAPER, 0.65)):
            drawn = LineCollection(lines, colors=colour, linewidths=0.45, alpha=opacity, zorder=3)
            axes.add_collection(drawn)
            drawn.set_clip_path(outline, axes.transData)
        seams = [piece for seam in seams_of(result) for piece in seam.pieces]
        if seams:
            axes.add_collection(LineCollection(seams, colors=palette.PAPER, linewidths=4.0, zorder=5))
            axes.add_collection(LineCollection(seams, colors=palette.SEAM, linewidths=2.2, zorder=6))
        axes.add_collection(LineCollection(flat.cuts, colors=palette.INK, linewidths=1.2, zorder=4))
        axes.add_patch(
            PathPatch(outline, facecolor="none", edgecolor=palette.INK, lw=1.2, joinstyle="round", zorder=4)
        )
    draw_rosette(axes, (0.0, 0.0), (arrow, 0.0), (0.0, arrow))


def seams_of(result: Drape) -> tuple[Seam, ...]:
    """The seams between strips of a roll; none without a roll."""
    return result.roll.seams if result.roll is not None else ()


def compound_path(polygons: Sequence[Floats]) -> Any:
    """One matplotlib path of closed polygons (k, 2); holes run the other way round."""
    from matplotlib.path import Path

    return Path.make_compound_path(*[Path(np.vstack([p, p[:1]]), closed=True) for p in polygons])


def draw_cells(axes: Any, result: Drape, outline: Any) -> None:
    """Colour the cells by class, cut off at the outline: an image where the grid is even, else a mesh."""
    from matplotlib.colors import ListedColormap

    net = result.net
    if len(net.u) < 2 or len(net.v) < 2:
        return
    classes = np.ma.masked_invalid(palette.class_of(spread(net.cell_shear), result.limit_angle)).T
    u, v = longer(net.u), longer(net.v)
    colours = {"cmap": ListedColormap([palette.LOW, palette.MIDDLE, palette.HIGH]), "vmin": -0.5, "vmax": 2.5}
    even = all(np.allclose(np.diff(c), c[1] - c[0], rtol=1e-6) for c in (u, v))
    if even:
        box = (u[0], u[-1], v[0], v[-1])
        cells = axes.imshow(
            classes, extent=box, origin="lower", interpolation="nearest", aspect="equal", zorder=2, **colours
        )
    else:
        cells = axes.pcolormesh(u, v, classes, zorder=2, **colours)
    cells.set_clip_path(outline, axes.transData)


def spread(cell_shear: Floats, times: int = RIM) -> Floats:
    """Size of the shear of cells (nu−1, nv−1), carried on to the empty cells beside and about the net.

    The rim of the pattern runs through those. Returns (nu−1+2·times, nv−1+2·times) deg.
    """
    filled = np.pad(np.abs(cell_shear), times, constant_values=np.nan)
    for _ in range(times):
        padded = np.pad(filled, 1, constant_values=np.nan)
        around = np.stack([padded[2:, 1:-1], padded[:-2, 1:-1], padded[1:-1, 2:], padded[1:-1, :-2]])
        known = np.sum(~np.isnan(around), axis=0)
        mean = np.nansum(around, axis=0) / np.maximum(known, 1)
        filled = np.where(np.isnan(filled) & (known > 0), mean, filled)
    return filled


def longer(coordinate: Floats, times: int = RIM) -> Floats:
    """u or v (n,) carried on by its own end steps, (n + 2·times,) mm."""
    first, last = coordinate[1] - coordinate[0], coordinate[-1] - coordinate[-2]
    before = coordinate[0] - first * np.arange(times, 0, -1)
    return np.concatenate([before, coordinate, coordinate[-1] + last * np.arange(1, times + 1)])


def draw_rosette(
    axes: Any, origin: tuple[float, float], warp: tuple[float, float], weft: tuple[float, float]
) -> None:
    """Origin with warp and weft arrows, in the data units of the axes; warp is the bold one."""
    from matplotlib.patheffects import withStroke

    halo = [withStroke(linewidth=3.0, foreground=palette.PAPER)]
    for name, (dx, dy), width in (("weft", weft, 1.3), ("warp", warp, 2.4)):
        tip = (origin[0] + dx, origin[1] + dy)
        arrow = {
            "arrowstyle": "-|>",
            "lw": width,
            "color": palette.INK,
            "shrinkA": 0,
            "shrinkB": 0,
            "mutation_scale": 13,
        }
        drawn = axes.annotate("", xy=tip, xytext=origin, arrowprops=arrow, zorder=8, annotation_clip=False)
        drawn.arrow_patch.set_path_effects([withStroke(linewidth=width + 2.4, foreground=palette.PAPER)])
        length = float(np.hypot(dx, dy)) or 1.0
        side = -1.0 if axes.yaxis_inverted() else 1.0
        offset = (19 * dx / length, 11 * side * dy / length)
        axes.annotate(
            name,
            xy=tip,
            xytext=offset,
            textcoords="offset points",
            fontsize=8,
            ha="center",
            va="center",
            fontweight="bold" if name == "warp" else "normal",
            color=palette.INK,
            zorder=9,
            path_effects=halo,
            annotation_clip=False,
        )
    axes.plot(*origin, "o", ms=5.5, mfc=palette.PAPER, mec=palette.INK, mew=1.4, zorder=9)
