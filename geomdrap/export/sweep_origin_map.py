"""The part from above with the origins on it: how good the best heading there is, and which it is."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from geomdrap.export import palette
from geomdrap.export.camera import Camera, Viewport
from geomdrap.export.layout import Box
from geomdrap.export.picture import DOTS, place
from geomdrap.export.scene import OVERSAMPLING, Scale, draw_skin, edge_mask, ink, prepare_skin

if TYPE_CHECKING:
    from geomdrap.surface import Surface
    from geomdrap.sweep import Row, Sweep

AROUND = (0.2, 0.85, 0.2, 0.35)
BAR = (0.9, 0.42, 0.14)
"""Left margin, height above the box, thickness of the colour bar, inch."""
MAP = "viridis_r"
HALF = 11.0
"""Half the length of the bar that shows a heading, pixels."""


def draw_origins(figure: Any, box: Box, sweep: Sweep, way: Sequence[Row] = ()) -> None:
    """The map in a box given in inches, with its colour bar; ``way`` are the rows of a search, drawn as a line."""
    from geomdrap.sweep.ranking import best_of_origins

    inside = box.inset(*AROUND)
    axes = place(figure, inside)
    columns, rows = round(inside.width * DOTS), round(inside.height * DOTS)
    viewport = _viewport(sweep.job.surface, columns, rows)
    axes.imshow(_part(sweep.job.surface, viewport), extent=(0, columns, rows, 0), aspect="auto")
    axes.set(xlim=(0, columns), ylim=(rows, 0))
    axes.set_axis_off()
    if len(way) > 1:
        steps = viewport.pixels(np.array([row.origin for row in way]))[:, :2]
        axes.plot(*steps.T, color=palette.HIGH, lw=1.4, marker="o", ms=2.5, zorder=2)
    best = best_of_origins(sweep.ranked)
    score = np.array([sweep.objective.score(row) for row in best])
    at = viewport.pixels(np.array([row.origin for row in best]))[:, :2]
    points = axes.scatter(*at.T, c=score, cmap=MAP, s=90, edgecolors=palette.INK, linewidths=0.8, zorder=3)
    for row, place_of in zip(best, at, strict=True):
        along = _warp(sweep, row, viewport)
        axes.plot(*(place_of + HALF * np.outer([-1, 1], along)).T, color=palette.INK, lw=1.6, zorder=4)
    first = int(np.argmin(score))
    axes.scatter(*at[first], s=330, facecolors="none", edgecolors=palette.HIGH, linewidths=2.2, zorder=5)
    axes.set_title("Origins: score and warp of the best heading there", fontsize=9, loc="left", color=palette.INK)
    words = (
        f"{sweep.objective}, with what is bare; red ring: the best{', line: the way there' if len(way) > 1 else ''}"
    )
    _draw_bar(figure, box, points, words)


def _viewport(surface: Surface, columns: int, rows: int) -> Viewport:
    """The view in which grids of origins are laid out."""
    from geomdrap.sweep.origins import plan_frame

    along, across, up = plan_frame(surface)
    return Viewport.around(Camera(toward=up, right=along, up=across), surface.points, columns, rows)


def _part(surface: Surface, viewport: Viewport) -> np.ndarray:
    """An image (rows, columns, 3) of the part alone, drawn larger and made smaller."""
    skin = prepare_skin(surface, np.zeros(len(surface.triangles)))
    size = (OVERSAMPLING * viewport.columns, OVERSAMPLING * viewport.rows)
    large = Viewport.around(viewport.camera, surface.points, *size)
    depth, image = draw_skin(skin, large, Scale(90.0, 90.0))
    ink(image, edge_mask(skin, large, depth), palette.INK, 0.85)
    small = image.reshape(viewport.rows, OVERSAMPLING, viewport.columns, OVERSAMPLING, 3)
    grey = small.mean(axis=(1, 3)).mean(axis=2, keepdims=True)  # colour belongs to the origins
    return np.asarray(np.repeat(grey, 3, axis=2))


def _warp(sweep: Sweep, row: Row, viewport: Viewport) -> np.ndarray:
    """Unit direction (2,) in pixels of the warp at the origin of a row."""
    from geomdrap.fishnet.seed import heading_frame

    surface = sweep.job.surface
    normal = surface.normals[int(surface.nearest(np.array([row.origin])).face[0])]
    across = heading_frame(normal, sweep.job.reference)
    turn_rad = np.radians(row.angle)
    warp = np.cos(turn_rad) * across + np.sin(turn_rad) * np.cross(normal, across)
    seen = np.array([viewport.camera.right @ warp, -(viewport.camera.up @ warp)])
    return seen / max(float(np.hypot(*seen)), 1e-9)


def _draw_bar(figure: Any, box: Box, points: Any, words: str) -> None:
    wide, high = figure.get_size_inches()
    left, bottom, thick = BAR
    axes = figure.add_axes(
        ((box.left + left) / wide, (box.bottom + bottom) / high, (box.width - 2 * left) / wide, thick / high)
    )
    bar = figure.colorbar(points, cax=axes, orientation="horizontal")
    bar.ax.tick_params(labelsize=8, colors=palette.INK, length=3)
    bar.set_label(words, fontsize=8.5, color=palette.INK)
