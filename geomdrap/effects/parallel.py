"""The surface at a distance from another: vertices moved so that the planes of the facets keep theirs."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import EffectError

if TYPE_CHECKING:
    from geomdrap.surface import Surface

# Facets whose normals differ by less than SMOOTH degrees stand for a curved surface, on which a vertex moves along its
# normal; beyond SHARP they are planes that meet in an edge, and the vertex moves to where their offsets meet.
SMOOTH, SHARP = 20.0, 40.0
MITRE = 3.0  # times the distance: a vertex of a spike moves no further


def parallel_surface(surface: Surface, offset: float, effect: str) -> Surface:
    """The surface at ``offset`` mm along the normals.

    Raises EffectError, naming ``effect`` and the place, where the surface is curved more tightly than that.
    """
    moved = surface.moved(surface.points + offset * offset_vectors(surface))
    turned = (moved.normals * surface.normals).sum(axis=1) <= 0.0
    if turned.any() or not np.isfinite(moved.normals).all():
        where = surface.points[surface.triangles[int(np.argmax(turned))]].mean(axis=0)
        raise EffectError(
            f"effect {effect}: at {_place(where)} {surface.source} is curved more tightly than {offset:g} mm, so that "
            "no ply fits in; use a smaller offset, or bridging with a radius of at least the offset as well"
        )
    return moved


def _place(point: np.ndarray) -> str:
    return "(" + ", ".join(f"{x:.4g}" for x in point) + ")"


def offset_vectors(surface: Surface) -> np.ndarray:
    """How each vertex moves (n, 3) for an offset of 1.

    With angle weights w and normals n of the facets at a vertex, the vector m for which Σ w (n·m − 1)² is least puts
    all planes at distance 1; along directions in which the normals hardly differ it is not determined, and 0 there.
    """
    weight = corner_angles(surface)
    normal = surface.normals
    outer = normal[:, :, None] * normal[:, None, :]
    vertex = surface.triangles.ravel()
    n = len(surface.points)

    def sums(values: np.ndarray) -> np.ndarray:
        flat = (weight[:, :, None] * values[:, None, :]).reshape(-1, values.shape[1])
        return np.column_stack([np.bincount(vertex, column, n) for column in flat.T])

    matrix = sums(outer.reshape(-1, 9)).reshape(n, 3, 3)
    total = sums(normal)
    size, axes = np.linalg.eigh(matrix)
    along = np.einsum("nik,ni->nk", axes, total)
    share = size / np.maximum(size[:, 2:], 1e-300)
    low, high = (math.tan(math.radians(angle / 2)) ** 2 for angle in (SMOOTH, SHARP))
    sharp = np.clip((share - low) / (high - low), 0.0, 1.0)
    solved = along / np.where(size > 0.0, size, np.inf)
    edge = sharp[:, 1:2]  # at a smooth vertex the first axis is its normal, and one unit of it the way
    solved[:, 2:] = edge * solved[:, 2:] + (1.0 - edge) * np.sign(along[:, 2:])
    vectors = np.einsum("nik,nk->ni", axes, sharp * solved)
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    moved: np.ndarray = vectors * np.minimum(1.0, MITRE / np.maximum(length, 1e-300))
    return moved


def corner_angles(surface: Surface) -> np.ndarray:
    """Interior angles (m, 3) of the facets, radians."""
    corners = surface.points[surface.triangles]
    out = np.empty(surface.triangles.shape)
    for k in range(3):
        a, b = corners[:, (k + 1) % 3] - corners[:, k], corners[:, (k + 2) % 3] - corners[:, k]
        out[:, k] = np.arctan2(np.linalg.norm(np.cross(a, b), axis=1), (a * b).sum(axis=1))
    return out
