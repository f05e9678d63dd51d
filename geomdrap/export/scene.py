"""One 3-D view of a draped part as an image: shear, soft light, outlines, yarns; the rear is hidden."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np
from numba import njit
from numpy.typing import NDArray

from geomdrap.export import palette
from geomdrap.export.camera import Camera, Viewport
from geomdrap.export.raster import draw_segments, fill_triangles, outline, visible_points
from geomdrap.export.yarns import Yarns

if TYPE_CHECKING:
    from geomdrap.fishnet import Net
    from geomdrap.surface.surface import Surface

Floats = NDArray[np.float64]

OVERSAMPLING = 2
SEAM_WIDTH = 4
"""Pixels before the image is made smaller."""
CREASE = np.cos(np.radians(30.0))


@dataclass(frozen=True)
class Skin:
    """What all views share: values (m, 3) and normals (m, 3, 3) per corner, sharp edges (k, 2, 3)."""

    surface: Surface
    values: NDArray[np.float32]
    normals: NDArray[np.float32]
    edges: Floats


@dataclass(frozen=True)
class View:
    """An image (rows, columns, 3) 0 to 1, and where things lie on it (in pixels of the image)."""

    image: NDArray[np.float32]
    viewport: Viewport
    origin: tuple[float, float]
    origin_visible: bool


def prepare_skin(surface: Surface, face_values: Floats) -> Skin:
    """Corner values and normals of a part, smoothed within bare or draped regions and between creases."""
    return Skin(surface, corner_values(surface, face_values), corner_normals(surface), sharp_edges(surface))


def corner_values(surface: Surface, face_values: Floats) -> NDArray[np.float32]:
    """Face values (m,) averaged to the corners (m, 3) by area; faces with NaN keep it at their corners."""
    corners = surface.triangles.ravel()
    weight = np.where(np.isnan(face_values), 0.0, surface.areas)
    total = np.bincount(corners, np.repeat(weight, 3), len(surface.points))
    moment = np.bincount(corners, np.repeat(weight * np.nan_to_num(face_values), 3), len(surface.points))
    smooth = (moment / np.where(total > 0.0, total, 1.0))[surface.triangles]
    return np.where(np.isnan(face_values)[:, None], np.nan, smooth).astype(np.float32)


def corner_normals(surface: Surface) -> NDArray[np.float32]:
    """Normals (m, 3, 3) for shading: of the vertex where the part is smooth, of the face at a crease."""
    vertex = surface.vertex_normals.astype(np.float32)[surface.triangles]
    face = surface.normals.astype(np.float32)[:, None, :]
    smooth = np.sum(vertex * face, axis=2, keepdims=True) > CREASE
    return np.where(smooth, vertex, face)


def sharp_edges(surface: Surface) -> Floats:
    """End points (k, 2, 3) of boundary edges and of edges where the part bends by over 30°."""
    neighbours = surface.neighbours
    face, corner = np.nonzero(neighbours < np.arange(len(neighbours))[:, None])  # each edge once
    other = neighbours[face, corner]
    bend = np.einsum("ij,ij->i", surface.normals[face], surface.normals[other])
    sharp = (other < 0) | (bend < CREASE)
    face, corner = face[sharp], corner[sharp]
    ends = np.stack([surface.triangles[face, corner], surface.triangles[face, (corner + 1) % 3]], axis=1)
    return np.asarray(surface.points[ends])


@dataclass(frozen=True)
class Scale:
    """Shear at the end of the colour scale and at the limit line, deg."""

    top: float
    limit: float


def render(
    skin: Skin,
    camera: Camera,
    net: Net,
    *,
    yarns: Yarns,
    scale: Scale,
    size: tuple[int, int],
    seams: Sequence[Floats] = (),
) -> View:
    """Draw the part with its net, and seams (k, 3) mm, in an image of size (columns, rows)."""
    columns, rows = (OVERSAMPLING * n for n in size)
    viewport = Viewport.around(camera, skin.surface.points, columns, rows)
    depth, image = draw_skin(skin, viewport, scale)
    bias = 0.3 * net.pitch + 2.0 / viewport.scale
    ink(image, line_mask(yarns.weft, viewport, bias, depth), palette.INK, 0.30)
    ink(image, line_mask(yarns.warp, viewport, bias, depth), palette.INK, 0.60)
    ink(image, edge_mask(skin, viewport, depth), palette.INK, 0.85)
    ink(image, line_mask(seams, viewport, bias, depth, SEAM_WIDTH), palette.SEAM, 1.0)
    place = viewport.pixels(net.origin[None])
    seen = bool(visible_points(place, depth, bias)[0])
    small = image.reshape(size[1], OVERSAMPLING, size[0], OVERSAMPLING, 3).mean(axis=(1, 3))
    final = replace(viewport, scale=viewport.scale / OVERSAMPLING, columns=size[0], rows=size[1])
    x, y = place[0, :2] / OVERSAMPLING
    return View(small, final, (float(x), float(y)), seen)


def draw_skin(
    skin: Skin, viewport: Viewport, scale: Scale
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Depth (rows, columns) and image (rows, columns, 3) of the part alone, with the line of the limit."""
    depth = np.full((viewport.rows, viewport.columns), -np.inf, dtype=np.float32)
    value, shade = np.zeros_like(depth), np.zeros_like(depth)
    pixels = viewport.pixels(skin.surface.points)
    light = corner_light(skin.normals, viewport.camera)
    fill_triangles(pixels, skin.surface.triangles, skin.values, light, depth, value, shade)
    image = np.ones((*depth.shape, 3), dtype=np.float32)
    bare = np.array([palette.rgb(palette.BARE), palette.rgb(palette.BARE_STRIPE)], dtype=np.float32)
    paint(depth, value, shade, palette.continuous_table(), scale.top, bare, image)
    mask = np.zeros(depth.shape, dtype=np.uint8)
    level_line(value, depth, scale.limit, mask)
    ink(image, mask, palette.LIMIT_LINE, 1.0)
    return depth, image


def edge_mask(skin: Skin, viewport: Viewport, depth: NDArray[np.float32]) -> NDArray[np.uint8]:
    """Pixels of the part's visible boundary, creases and silhouettes."""
    mask = np.zeros(depth.shape, dtype=np.uint8)
    outline(depth, 4e-3 * skin.surface.diagonal, mask)
    starts, ends = viewport.pixels(skin.edges[:, 0]), viewport.pixels(skin.edges[:, 1])
    draw_segments(starts, ends, 2, 2e-3 * skin.surface.diagonal, depth, mask)
    return mask


def corner_light(normals: NDArray[np.float32], camera: Camera) -> NDArray[np.float32]:
    """Brightness (m, 3) 0 to 1: a soft two-sided light over the viewer's left shoulder; backs are dimmer."""
    lamp = 0.80 * camera.toward - 0.35 * camera.right + 0.49 * camera.up
    facing = normals @ camera.toward.astype(np.float32)
    lit = (normals @ (lamp / np.linalg.norm(lamp)).astype(np.float32)) * np.sign(facing)
    brightness = 0.72 + 0.28 * np.clip(0.5 + 0.5 * lit, 0.0, 1.0) ** 1.5
    return np.asarray(np.where(facing < 0.0, 0.88 * brightness, brightness), dtype=np.float32)


def line_mask(
    lines: Sequence[Floats], viewport: Viewport, bias: float, depth: NDArray[np.float32], width: int = 1
) -> NDArray[np.uint8]:
    """Visible pixels of polylines (k, 3) mm, as a mask of the image's size."""
    mask = np.zeros(depth.shape, dtype=np.uint8)
    for line in lines:
        seen = viewport.pixels(line)
        draw_segments(seen[:-1], seen[1:], width, bias, depth, mask)
    return mask


def ink(image: NDArray[np.float32], mask: NDArray[np.uint8], colour: str, opacity: float) -> None:
    """Lay a colour on the image where the mask is set."""
    where = mask.astype(bool)
    image[where] += np.float32(opacity) * (np.array(palette.rgb(colour), dtype=np.float32) - image[where])


@njit(cache=True)
def paint(depth, value, shade, table, top, bare, image):  # type: ignore[no-untyped-def]
    """Colour the pixels by |value| on 0 … top with table (256, 3); NaN gets stripes of both bare colours."""
    rows, columns = depth.shape
    for i in range(rows):
        for j in range(columns):
            if depth[i, j] == -np.inf:
                continue
            size = abs(value[i, j])
            if np.isnan(size):
                colour = bare[1] if (i + j) % 16 < 4 else bare[0]
            else:
                colour = table[min(255, int(255.999 * size / top))]
            for k in range(3):
                image[i, j, k] = colour[k] * shade[i, j]


@njit(cache=True)
def level_line(value, depth, level, mask):  # type: ignore[no-untyped-def]
    """Mark the pixels where |value| crosses the level towards the right or the lower neighbour."""
    rows, columns = depth.shape
    for i in range(rows - 1):
        for j in range(columns - 1):
            here = abs(value[i, j]) - level
            if depth[i, j] == -np.inf:
                continue
            for k, m in ((i + 1, j), (i, j + 1), (i + 1, j + 1)):
                there = abs(value[k, m]) - level
                if depth[k, m] != -np.inf and here * there < 0.0:  # NaN is false
                    mask[i, j] = 1
                    mask[k, m] = 1
