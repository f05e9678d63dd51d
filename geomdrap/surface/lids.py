"""Lids over holes: a ply is laid over a hole and cut out afterwards, so the net must be able to cross it.

A net that had to go round a hole would arrive behind it from two sides with yarns that do not match. The lids carry
yarns but belong to no part: nodes on them are marked and never drawn, measured or counted.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numba import njit

from geomdrap.surface.prepare import Prepared
from geomdrap.surface.types import Floats, Ints

FLAT = 0.25  # rim's distance from its plane, in shares of the hole's size, above which it is no hole to cover
SMOOTH = 0.5  # cosine between the lid and the faces around it, below which it is an end of the part (a tube's)


@njit(cache=True)
def clip_ears(flat: np.ndarray) -> np.ndarray:
    """Triangles (k - 2, 3) of a simple polygon (k, 2), counter-clockwise, by cutting the best-shaped ear each time.

    Fewer triangles come back where the polygon crosses itself.
    """
    n = len(flat)
    onward = np.arange(1, n + 1)
    onward[n - 1] = 0
    back = np.arange(-1, n - 1)
    back[0] = n - 1
    out = np.empty((n - 2, 3), np.int64)
    here = 0
    for count in range(n - 2):
        best, best_shape = -1, 0.0
        b = here
        for _ in range(n - count):
            a, c = back[b], onward[b]
            shape = ear_shape(flat, a, b, c)
            if shape > best_shape and not holds_point(flat, onward, a, b, c):
                best, best_shape = b, shape
            b = onward[b]
        if best < 0:
            return out[:count]
        a, c = back[best], onward[best]
        out[count] = a, best, c
        onward[a], back[c] = c, a
        here = a
    return out


@njit(cache=True)
def ear_shape(flat: np.ndarray, a: int, b: int, c: int) -> float:
    """Area over squared perimeter of a triangle; not positive where it turns the wrong way."""
    ux, uy = flat[b, 0] - flat[a, 0], flat[b, 1] - flat[a, 1]
    vx, vy = flat[c, 0] - flat[b, 0], flat[c, 1] - flat[b, 1]
    around = np.hypot(ux, uy) + np.hypot(vx, vy) + np.hypot(ux + vx, uy + vy)
    return (ux * vy - uy * vx) / (around * around)


@njit(cache=True)
def holds_point(flat: np.ndarray, onward: np.ndarray, a: int, b: int, c: int) -> bool:
    """Whether another corner of the polygon lies in triangle a, b, c."""
    k = onward[c]
    while k != a:
        if ear_shape(flat, a, b, k) >= 0.0 and ear_shape(flat, b, c, k) >= 0.0 and ear_shape(flat, c, a, k) >= 0.0:
            return True
        k = onward[k]
    return False


def lid_over(points: Floats, rim: Ints, beside: Floats) -> Ints | None:
    """Triangles (k - 2, 3) of vertex numbers that close a rim, or None where it is no hole to cover.

    ``rim`` (k,) are vertex numbers in the direction of the lid's own faces, ``beside`` (k, 3) the normals of the
    faces along it.
    """
    ring = points[rim] - points[rim].mean(axis=0)
    across = 0.5 * np.cross(ring, np.roll(ring, -1, axis=0)).sum(axis=0)
    area = float(np.linalg.norm(across))
    if area == 0.0:
        return None
    normal = across / area
    if np.abs(ring @ normal).max() > FLAT * np.sqrt(area) or (beside @ normal).mean() < SMOOTH:
        return None
    e1 = ring[0] - (ring[0] @ normal) * normal
    e1 /= np.linalg.norm(e1)
    flat = np.column_stack([ring @ e1, ring @ np.cross(normal, e1)])
    ears = clip_ears(np.ascontiguousarray(flat))
    return rim[ears] if len(ears) == len(rim) - 2 else None


def cover(mesh: Prepared, loops: tuple[Ints, ...], normals: Floats) -> Prepared:
    """The mesh with lids over its holes, behind its own faces; the longest rim is the outline and stays open."""
    if len(loops) < 2:
        return mesh
    corners = [mesh.triangles[loop // 3, loop % 3] for loop in loops]
    lengths = [
        float(np.linalg.norm(mesh.points[c] - np.roll(mesh.points[c], -1, axis=0), axis=1).sum()) for c in corners
    ]
    lids = []
    for n, (loop, rim) in enumerate(zip(loops, corners, strict=True)):
        simple = len(np.unique(rim)) == len(rim) >= 3
        lid = (
            lid_over(mesh.points, rim[::-1], normals[loop // 3]) if simple and n != int(np.argmax(lengths)) else None
        )
        if lid is not None:
            lids.append(lid)
    return _add(mesh, np.concatenate(lids)) if lids else mesh


def _add(mesh: Prepared, lids: Ints) -> Prepared:
    """The mesh with more faces, joined to it and to each other."""
    from geomdrap.surface.topology import match_edges, sorted_edges

    triangles = np.ascontiguousarray(np.vstack([mesh.triangles, lids]).astype(np.int32))
    order, start = sorted_edges(triangles, len(mesh.points))
    neighbours, neighbour_edge, _ = match_edges(order, start, len(triangles))
    more = len(lids)
    return replace(
        mesh,
        triangles=triangles,
        neighbours=neighbours,
        neighbour_edge=neighbour_edge,
        source_face=np.concatenate([mesh.source_face, np.full(more, -1)]),
        component=np.concatenate([mesh.component, np.zeros(more, mesh.component.dtype)]),
        doubled=np.concatenate([mesh.doubled, np.zeros(more, np.bool_)]),
        slender=np.concatenate([mesh.slender, np.ones(more)]),
    )
