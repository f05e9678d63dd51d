"""shear.png: the shear on the part from its two most informative sides, and the flat pattern in classes."""

from __future__ import annotations

import io
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from geomdrap.export import palette
from geomdrap.export.camera import Camera, extent, two_views
from geomdrap.export.drawing import round_length
from geomdrap.export.flat_map import draw_flat_map, draw_rosette, pattern_extent, seams_of
from geomdrap.export.layout import Box, Panel, best_page
from geomdrap.export.legend import draw_footer, draw_header, footer_height
from geomdrap.export.scene import Scale, Skin, prepare_skin, render
from geomdrap.export.whole import write_whole
from geomdrap.export.yarns import choose_yarns, every_so_many

if TYPE_CHECKING:
    from collections.abc import Callable

    from geomdrap.fields import Drape

Floats = NDArray[np.float64]

DOTS = 120
"""Pixels per inch."""
WIDTH = 16.0
MARGIN = 0.35
HEIGHTS = (4.6, 5.4, 6.4, 7.6, 9.0)
"""Of the part of the page with the panels, inch; the best is taken."""
HEADER = 1.0
AROUND_VIEW = (0.15, 0.6, 0.15, 0.5)
AROUND_MAP = (0.75, 0.55, 0.15, 0.42)
"""Room for words about a picture: left, bottom, right, top, inch."""
LEAST_WIDTH = 3.9
"""What captions and scales need, inch."""
LINE_SPACING = 0.10
"""Least distance between drawn yarns, inch."""
ARROW = 0.62
"""Length of the rosette's arrows, inch; less where the picture is small."""


def write(result: Drape, path: Path, progress: Callable[[float], None] = lambda _: None) -> None:
    """Write the picture of a drape as a PNG; no date or path in it. Raises GeomdrapError if it cannot be.

    ``progress`` is called with the share done, 0 to 1.
    """
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    figure = draw(result, lambda share: progress(0.9 * share))
    buffer = io.BytesIO()
    FigureCanvasAgg(figure).print_png(buffer, metadata={"Software": None}, pil_kwargs={"compress_level": 4})
    write_whole(path, buffer.getvalue())


def draw(result: Drape, progress: Callable[[float], None] = lambda _: None) -> Any:
    """The picture as a matplotlib Figure: header, two views and the flat map, legend, warnings."""
    from matplotlib.figure import Figure

    surface, net = result.net.surface, result.net
    importance = 0.35 + np.nan_to_num(np.abs(result.face_shear)) / result.limit_angle
    views = two_views(surface, importance, net.origin, net.normal0, lambda share: progress(0.5 * share))
    panels = [Panel(proportions(*extent(view, surface.points)), AROUND_VIEW, LEAST_WIDTH) for view in views]
    panels.append(Panel(proportions(*pattern_extent(result.flat)), AROUND_MAP, LEAST_WIDTH))
    footer = footer_height(result)
    height, boxes = best_page(WIDTH - 2 * MARGIN, HEIGHTS, panels)
    figure = Figure(figsize=(WIDTH, height + HEADER + footer), dpi=DOTS, facecolor=palette.PAPER)
    boxes = [Box(box.left + MARGIN, box.bottom + footer, box.width, box.height) for box in boxes]
    top = palette.top_of_scale(result.statistics.max, result.limit_angle)
    draw_header(figure, result, MARGIN)
    skin = prepare_skin(surface, result.face_shear)
    for n, (box, view) in enumerate(zip(boxes, views, strict=False), start=1):
        draw_view(figure, box, result, skin, camera=view, top=top)
        progress(0.5 + 0.2 * n)
    draw_pattern(figure, boxes[2], result)
    draw_footer(figure, result, top, MARGIN)
    return figure


def proportions(lower: Floats, upper: Floats) -> float:
    """Width : height of a panel, kept within 1:12 and 12:1."""
    width, height = np.maximum(upper - lower, 1e-12)
    return float(np.clip(width / height, 1 / 12, 12.0))


def place(figure: Any, box: Box) -> Any:
    """Axes in a box given in inches, on whole pixels, so that images come out dot for dot."""
    wide, high = figure.get_size_inches()
    left, bottom, width, height = (
        round(x * DOTS) / DOTS for x in (box.left, box.bottom, box.width, box.height)
    )
    return figure.add_axes((left / wide, bottom / high, width / wide, height / high))


def draw_view(figure: Any, box: Box, result: Drape, skin: Skin, *, camera: Camera, top: float) -> None:
    """One 3-D view with caption, rosette, scale bar and the part's axes."""
    inside = box.inset(*AROUND_VIEW)
    axes = place(figure, inside)
    size = (round(inside.width * DOTS), round(inside.height * DOTS))
    lower, upper = extent(camera, skin.surface.points)
    inches_per_mm = min(
        inside.width / (upper[0] - lower[0] + 1e-12), inside.height / (upper[1] - lower[1] + 1e-12)
    )
    net = result.net
    yarns = choose_yarns(net, LINE_SPACING / inches_per_mm)
    seams = [line for seam in seams_of(result) for line in seam.on_part]
    scale = Scale(top, result.limit_angle)
    view = render(skin, camera, net, yarns=yarns, scale=scale, size=size, seams=seams)
    axes.imshow(view.image, interpolation="nearest", aspect="auto", extent=(0, size[0], size[1], 0))
    axes.set(xlim=(0, size[0]), ylim=(size[1], 0))
    axes.set_axis_off()
    arrow = DOTS * arrow_length((upper - lower) * inches_per_mm)
    warp, weft = ((arrow * (camera.right @ d), -arrow * (camera.up @ d)) for d in (net.warp0, net.weft0))
    words = yarns_words(yarns.every, net.pitch) + ("; green: seams" if seams else "")
    if view.origin_visible:
        draw_rosette(axes, view.origin, warp, weft)
    else:
        words += "; origin on the far side"
    caption(figure, box, f"Shear angle on the part, {camera.name}")
    draw_scale_bar(figure, box, view.viewport.scale, words)
    draw_triad(figure, box, camera)


def draw_pattern(figure: Any, box: Box, result: Drape) -> None:
    """The flat map in true proportions with axes in mm."""
    inside = box.inset(*AROUND_MAP)
    axes = place(figure, inside)
    lower, upper = pattern_extent(result.flat)
    size = np.maximum(upper - lower, 1e-9)
    room = 0.03 * float(size.max())
    mm_per_inch = max((size[0] + 2 * room) / inside.width, (size[1] + 2 * room) / inside.height)
    every = every_so_many(result.net, LINE_SPACING * mm_per_inch)
    draw_flat_map(axes, result, every, mm_per_inch * arrow_length(size / mm_per_inch))
    axes.set_aspect("equal", adjustable="box", anchor="C")
    axes.set(xlim=(lower[0] - room, upper[0] + room), ylim=(lower[1] - room, upper[1] + room))
    axes.set_xlabel("u, along the warp [mm]", fontsize=8.5, color=palette.INK)
    axes.set_ylabel("v, along the weft [mm]", fontsize=8.5, color=palette.INK)
    axes.tick_params(labelsize=8, colors=palette.INK, length=3)
    axes.locator_params(nbins=6, min_n_ticks=2)
    for side in axes.spines.values():
        side.set_color(palette.BARE_STRIPE)
    words = f"Flat pattern, {size[0]:.4g} × {size[1]:.4g} mm"
    if seams_of(result):
        words += f", {len(seams_of(result)) + 1} strips"
    caption(figure, box, words)


def arrow_length(size: Floats) -> float:
    """Of the rosette's arrows, inch, for a picture of that size (2,) in inches."""
    return float(np.clip(0.3 * size.min(), 0.5 * ARROW, ARROW))


def caption(figure: Any, box: Box, text: str) -> None:
    """Heading in the upper left corner of a panel."""
    wide, high = figure.get_size_inches()
    x, y = (box.left + 0.15) / wide, (box.bottom + box.height - 0.08) / high
    figure.text(x, y, text, fontsize=10.5, fontweight="bold", color=palette.INK, va="top")


def yarns_words(every: int, pitch: float) -> str:
    """What the lines on a panel are."""
    return f"yarns every {every * pitch:.4g} mm" if every > 1 else f"all yarns, every {pitch:.4g} mm"


def draw_scale_bar(figure: Any, box: Box, pixels_per_mm: float, words: str) -> None:
    """A bar of a round length under a view, and what the lines in it are."""
    wide, high = figure.get_size_inches()
    length = round_length(0.3 * box.width * DOTS / pixels_per_mm)
    inches = length * pixels_per_mm / DOTS
    x, y = box.left + 0.75, box.bottom + 0.3
    from matplotlib.lines import Line2D

    figure.add_artist(
        Line2D(
            [x / wide, (x + inches) / wide], [y / high] * 2, color=palette.INK, lw=2.2, solid_capstyle="butt"
        )
    )
    figure.text(
        (x + inches + 0.1) / wide,
        y / high,
        f"{length:g} mm   {words}",
        fontsize=8.5,
        color=palette.INK,
        va="center",
    )


def draw_triad(figure: Any, box: Box, camera: Camera) -> None:
    """Small x, y, z arrows of the part in the lower left corner of a view."""
    axes = place(figure, Box(box.left + 0.05, box.bottom + 0.02, 0.6, 0.6))
    axes.set(xlim=(-1.5, 1.5), ylim=(-1.5, 1.5))
    axes.set_axis_off()
    for k, name in enumerate("xyz"):
        dx, dy = camera.right[k], camera.up[k]
        if np.hypot(dx, dy) < 0.05:
            continue
        arrow = {
            "arrowstyle": "-|>",
            "lw": 0.9,
            "color": palette.FAINT,
            "shrinkA": 0,
            "shrinkB": 0,
            "mutation_scale": 6,
        }
        axes.annotate("", xy=(dx, dy), xytext=(0, 0), arrowprops=arrow)
        axes.text(1.35 * dx, 1.35 * dy, name, fontsize=7, color=palette.FAINT, ha="center", va="center")
