"""A small z-buffer: facets, lines and visibility of points for an orthographic picture.

Pixels: x to the right, y down, pixel (row i, column j) has its centre at (j + 0.5, i + 0.5).
Depth: mm towards the viewer, so that the greater depth hides the smaller; −inf is the background.
Whoever paints decides on colours; here are only depth, values and masks.
"""

from __future__ import annotations

import numpy as np
from numba import njit


@njit(cache=True)
def fill_triangles(pixels, triangles, values, light, depth, value, shade):  # type: ignore[no-untyped-def]
    """Draw facets into the buffers; the nearest facet wins, whatever the order.

    pixels (n, 3): x, y in pixels and depth in mm; triangles (m, 3); values and light (m, 3) per corner, NaN
    values are kept. depth, value and shade (rows, columns) float32 are written in place.
    """
    rows, columns = depth.shape
    for f in range(len(triangles)):
        a, b, c = triangles[f, 0], triangles[f, 1], triangles[f, 2]
        ax, ay, bx, by = pixels[a, 0], pixels[a, 1], pixels[b, 0], pixels[b, 1]
        cx, cy = pixels[c, 0], pixels[c, 1]
        area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
        if abs(area) < 1e-12:
            continue
        first_column = max(0, int(np.floor(min(ax, bx, cx) - 0.5)))
        last_column = min(columns - 1, int(np.ceil(max(ax, bx, cx) - 0.5)))
        first_row = max(0, int(np.floor(min(ay, by, cy) - 0.5)))
        last_row = min(rows - 1, int(np.ceil(max(ay, by, cy) - 0.5)))
        for i in range(first_row, last_row + 1):
            y = i + 0.5
            for j in range(first_column, last_column + 1):
                x = j + 0.5
                wa = ((bx - x) * (cy - y) - (by - y) * (cx - x)) / area
                wb = ((cx - x) * (ay - y) - (cy - y) * (ax - x)) / area
                wc = 1.0 - wa - wb
                if wa < -1e-9 or wb < -1e-9 or wc < -1e-9:
                    continue
                z = wa * pixels[a, 2] + wb * pixels[b, 2] + wc * pixels[c, 2]
                if z > depth[i, j]:
                    depth[i, j] = z
                    value[i, j] = wa * values[f, 0] + wb * values[f, 1] + wc * values[f, 2]
                    shade[i, j] = wa * light[f, 0] + wb * light[f, 1] + wc * light[f, 2]


@njit(cache=True)
def farthest_nearby(depth, i, j):  # type: ignore[no-untyped-def]
    """Smallest depth in the 3 × 3 pixels about (i, j): makes depth tests independent of the slope."""
    rows, columns = depth.shape
    lowest = np.inf
    for k in range(max(0, i - 1), min(rows, i + 2)):
        for m in range(max(0, j - 1), min(columns, j + 2)):
            lowest = min(lowest, depth[k, m])
    return lowest


@njit(cache=True)
def visible_points(pixels, depth, bias):  # type: ignore[no-untyped-def]
    """(k,) bool: which of the points (k, 3) (x, y in pixels, depth in mm) no facet hides by over bias mm."""
    rows, columns = depth.shape
    visible = np.zeros(len(pixels), dtype=np.bool_)
    for k in range(len(pixels)):
        i, j = int(np.floor(pixels[k, 1])), int(np.floor(pixels[k, 0]))
        if 0 <= i < rows and 0 <= j < columns:
            visible[k] = pixels[k, 2] + bias >= farthest_nearby(depth, i, j)
    return visible


@njit(cache=True)
def draw_segments(starts, ends, width, bias, depth, mask):  # type: ignore[no-untyped-def]
    """Mark the pixels of visible segments with 1 in mask (rows, columns) uint8.

    starts, ends (k, 3): x, y in pixels, depth in mm; width in pixels; a piece is hidden where the surface
    lies over bias mm before it. Segments with NaN are left out.
    """
    rows, columns = depth.shape
    for k in range(len(starts)):
        dx, dy, dz = ends[k, 0] - starts[k, 0], ends[k, 1] - starts[k, 1], ends[k, 2] - starts[k, 2]
        length = max(abs(dx), abs(dy))
        if not length < 4.0 * (rows + columns):  # NaN too
            continue
        steps = max(1, int(np.ceil(2.0 * length)))
        for step in range(steps + 1):
            t = step / steps
            x, y, z = starts[k, 0] + t * dx, starts[k, 1] + t * dy, starts[k, 2] + t * dz
            i, j = int(np.floor(y)), int(np.floor(x))
            if i < 0 or j < 0 or i >= rows or j >= columns or z + bias < farthest_nearby(depth, i, j):
                continue
            top, left = int(np.floor(y - 0.5 * width + 0.5)), int(np.floor(x - 0.5 * width + 0.5))
            for r in range(max(0, top), min(rows, top + width)):
                for c in range(max(0, left), min(columns, left + width)):
                    mask[r, c] = 1


@njit(cache=True)
def outline(depth, jump, mask):  # type: ignore[no-untyped-def]
    """Mark the pixels (rows, columns) next to which the surface falls away by over jump mm: silhouettes.

    A steep facet falls away too; only where the slope itself changes is it an outline.
    """
    rows, columns = depth.shape
    for i in range(1, rows - 1):
        for j in range(1, columns - 1):
            z = depth[i, j]
            if z == -np.inf:
                continue
            for di, dj in ((0, 1), (0, -1), (1, 0), (-1, 0)):
                fall = z - depth[i + di, j + dj]
                rise = depth[i - di, j - dj] - z
                if fall > jump and fall > 3.0 * max(0.0, rise):
                    mask[i, j] = 1
