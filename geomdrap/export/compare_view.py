"""The part in 3-D with residuals on it: vectors, or dots coloured by a signed number."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from geomdrap.export import palette
from geomdrap.export.camera import Camera, Viewport, extent, two_views
from geomdrap.export.compare_scale import (
    SIGNED_COLOURS,
    CompareScale,
    signed_values,
    size_colours,
    thinned,
)
from geomdrap.export.flat_map import draw_rosette
from geomdrap.export.layout import Box
from geomdrap.export.picture import (
    AROUND_VIEW,
    DOTS,
    LINE_SPACING,
    arrow_length,
    caption,
    draw_scale_bar,
    draw_triad,
    place,
)
from geomdrap.export.raster import fill_triangles, visible_points
from geomdrap.export.scene import Scale, Skin, View, prepare_skin, render
from geomdrap.export.yarns import choose_yarns

if TYPE_CHECKING:
    from geomdrap.criticism import Comparison
    from geomdrap.surface import Surface

Floats = NDArray[np.float64]

MOST_VECTORS, MOST_DOTS = 700, 1500
"""Vectors and dots on a panel; of more, evenly spread ones are drawn."""
SHAFT = 0.0016
"""Width of a vector's shaft, of the width of the panel."""


def choose_camera(comparison: Comparison) -> Camera:
    """The oblique view that shows most of the part from the side that the ply is on."""
    surface, net = comparison.net.surface, comparison.net
    return two_views(surface, np.ones(len(surface.triangles)), net.origin, net.normal0)[0]


def plain_skin(comparison: Comparison) -> Skin:
    """The part without colours."""
    surface = comparison.net.surface
    return prepare_skin(surface, np.zeros(len(surface.triangles)))


def draw_vectors(
    figure: Any, box: Box, comparison: Comparison, skin: Skin, *, camera: Camera, scale: CompareScale, title: str
) -> Any:
    """Residual vectors of position from where the model has the points, longer by the scale's factor."""
    axes, view, words = _draw_part(figure, box, comparison, skin, camera)
    seen = _in_sight(view.viewport, skin.surface, comparison)
    start = view.viewport.pixels(comparison.matched.point)
    end = view.viewport.pixels(comparison.matched.point + scale.factor * comparison.vector)
    way, size = end - start, comparison.size
    order = thinned(fabric_places(comparison), np.flatnonzero(seen & comparison.trusted), MOST_VECTORS)
    drawn = f", {len(order)} drawn" if len(order) < (seen & comparison.trusted).sum() else ""
    order = order[np.argsort(size[order], kind="stable")]  # large ones on top
    vectors = axes.quiver(
        *start[order, :2].T,
        *way[order, :2].T,
        size[order],
        cmap=size_colours(),
        clim=(0.0, scale.size),
        angles="xy",
        scale_units="xy",
        scale=1.0,
        width=SHAFT,
        headwidth=4.5,
        headlength=5.0,
        zorder=5,
    )
    _mark_outliers(axes, start, seen, comparison, "position")
    caption(figure, box, title)
    draw_scale_bar(figure, box, view.viewport.scale, f"vectors × {scale.factor:g}{drawn}{words}")
    draw_triad(figure, box, camera)
    return vectors


def draw_dots(
    figure: Any, box: Box, comparison: Comparison, skin: Skin, *, camera: Camera, scale: CompareScale, title: str
) -> Any:
    """Measured points coloured by their shear residual (or what else was measured)."""
    axes, view, words = _draw_part(figure, box, comparison, skin, camera)
    seen = _in_sight(view.viewport, skin.surface, comparison)
    values, _, _ = signed_values(comparison)
    place_of = view.viewport.pixels(comparison.matched.point)
    drawn = np.flatnonzero(seen & np.isfinite(values) & comparison.trusted)
    drawn = thinned(fabric_places(comparison), drawn, MOST_DOTS)
    dots = scatter_dots(axes, place_of[drawn, :2], values[drawn], scale, dot_size(len(drawn)))
    _mark_outliers(axes, place_of, seen, comparison, "shear" if comparison.shear is not None else "position")
    caption(figure, box, title)
    draw_scale_bar(figure, box, view.viewport.scale, words.removeprefix("; "))
    draw_triad(figure, box, camera)
    return dots


def fabric_places(comparison: Comparison) -> Floats:
    """Fabric coordinates (n, 2) of the points, NaN where there are none."""
    return np.column_stack([comparison.matched.u, comparison.matched.v])


def dot_size(count: int) -> float:
    """Area of a dot in points² for so many of them."""
    return float(np.clip(9000.0 / max(count, 1), 6.0, 60.0))


def scatter_dots(axes: Any, places: Floats, values: Floats, scale: CompareScale, area: float) -> Any:
    """Dots of ``area`` points² at places (n, 2) on the axes, coloured by signed values (n,), large ones on top."""
    order = np.argsort(np.abs(values), kind="stable")
    return axes.scatter(
        *places[order].T,
        c=values[order],
        s=area,
        cmap=SIGNED_COLOURS,
        vmin=-scale.signed,
        vmax=scale.signed,
        edgecolors=palette.INK,
        linewidths=0.35,
        zorder=5,
    )


def _draw_part(figure: Any, box: Box, comparison: Comparison, skin: Skin, camera: Camera) -> tuple[Any, View, str]:
    """The part alone with its rosette; axes in pixels, the view, and what is to be said about it."""
    inside = box.inset(*AROUND_VIEW)
    axes = place(figure, inside)
    size = (round(inside.width * DOTS), round(inside.height * DOTS))
    lower, upper = extent(camera, skin.surface.points)
    inches_per_mm = min(inside.width, inside.height) / max(float((upper - lower).max()), 1e-12)
    net = comparison.net
    yarns = choose_yarns(net, 2.0 * LINE_SPACING / inches_per_mm)
    view = render(skin, camera, net, yarns=yarns, scale=Scale(1.0, 2.0), size=size)
    axes.imshow(_grey(view.image), interpolation="nearest", aspect="auto", extent=(0, size[0], size[1], 0))
    axes.set(xlim=(0, size[0]), ylim=(size[1], 0))
    axes.set_axis_off()
    arrow = DOTS * arrow_length((upper - lower) * inches_per_mm)
    warp, weft = ((arrow * (camera.right @ d), -arrow * (camera.up @ d)) for d in (net.warp0, net.weft0))
    if view.origin_visible:
        draw_rosette(axes, view.origin, warp, weft)
    seen = _in_sight(view.viewport, skin.surface, comparison)
    hidden = int((comparison.used & ~seen).sum())
    return axes, view, f"; {hidden} points hidden" if hidden else ""


def _grey(image: NDArray[np.float32]) -> NDArray[np.float32]:
    """The image (rows, columns, 3) without its colours, lighter, so that what lies on it stands out."""
    grey = image @ np.array([0.3, 0.59, 0.11], dtype=np.float32)
    return np.repeat((1.0 - 0.85 * (1.0 - grey))[..., None], 3, axis=2)


def _in_sight(viewport: Viewport, surface: Surface, comparison: Comparison) -> NDArray[np.bool_]:
    """Which predicted points (n,) the part does not hide."""
    depth = np.full((viewport.rows, viewport.columns), -np.inf, dtype=np.float32)
    unused = np.zeros((2, *depth.shape), dtype=np.float32)
    nothing = np.zeros((len(surface.triangles), 3), dtype=np.float32)
    fill_triangles(
        viewport.pixels(surface.points), surface.triangles, nothing, nothing, depth, unused[0], unused[1]
    )
    points = np.where(comparison.used[:, None], comparison.matched.point, surface.points[0])
    bias = 0.3 * comparison.net.pitch + 2.0 / viewport.scale
    return np.asarray(visible_points(viewport.pixels(points), depth, bias) & comparison.used)


def _mark_outliers(axes: Any, places: Floats, seen: NDArray[np.bool_], comparison: Comparison, kind: str) -> None:
    rows = [outlier.row for outlier in comparison.outliers if outlier.kind == kind and seen[outlier.row]]
    axes.plot(*places[rows, :2].T, "x", ms=6, mew=1.6, color=palette.LIMIT_LINE, zorder=6)
