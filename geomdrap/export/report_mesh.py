"""The ply as a mesh for a viewer in the browser: quantised, a vertex for each place in the fabric."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from geomdrap.export.scene import corner_normals, sharp_edges
from geomdrap.fields.evaluate import unit_directions

if TYPE_CHECKING:
    from geomdrap.fields import Drape

Floats = NDArray[np.float64]
Array = NDArray[Any]

STEPS = 65535
"""Of 16 bits: coordinates are kept to 1/65535 of the part's and of the pattern's size."""
PER_DEGREE = 100
"""Shear is kept to 0.01°."""
BARE = -32768
"""Shear of bare vertices: this plus the number of the `Status` that says why."""
ROUNDS = 2
MOST_EDGES = 0.25
"""Sharp edges per facet above which a part is rough all over, and only its rim is drawn."""


@dataclass(frozen=True)
class Box:
    """Lower corner and size (k,) mm between which coordinates are counted in 65535 steps."""

    lower: Floats
    size: Floats

    @classmethod
    def around(cls, points: Floats) -> Box:
        """The box of points (n, k); of size 1 where they have none."""
        if not len(points):
            return cls(np.zeros(points.shape[1]), np.ones(points.shape[1]))
        lower, upper = points.min(axis=0), points.max(axis=0)
        return cls(lower, np.where(upper > lower, upper - lower, 1.0))

    def count(self, points: Floats) -> Array:
        """Points (..., k) mm in steps, uint16; NaN becomes 0."""
        return np.asarray(np.nan_to_num(np.rint((points - self.lower) / self.size * STEPS)), dtype=np.uint16)


@dataclass(frozen=True)
class ReportMesh:
    """Vertices (n,) and triangles (m, 3) of the draped part, cut to the pitch.

    ``position`` (n, 3) and ``at`` (n, 2) uint16 in steps of ``space`` and ``fabric``; ``normal`` (n, 2) int16, on the
    octahedron; ``shear`` (n,) int16 in 0.01°, or ``BARE`` plus the reason; ``edges`` (k, 2, 3) uint16.
    """

    space: Box
    fabric: Box
    position: Array
    at: Array
    normal: Array
    shear: Array
    triangles: Array
    edges: Array


def report_mesh(result: Drape) -> ReportMesh:
    """The mesh of a drape; vertices are parted where the fabric, the normal or the reason differs on their facets."""
    trimmed, surface = result.trimmed, result.net.surface
    triangles, bare = trimmed.mesh.triangles.astype(np.int64), trimmed.kind == 0
    space = Box.around(trimmed.mesh.points)
    fabric = Box.around(trimmed.at[~bare].reshape(-1, 2))
    at = fabric.count(trimmed.at)
    normal = on_octahedron(piece_normals(result))
    fabric_vertex = (triangles << 32) + (at[..., 0].astype(np.int64) << 16) + at[..., 1]
    fabric_vertex[bare] = (triangles[bare] << 32) + trimmed.reason[bare, None].astype(np.int64)
    _, group = np.unique(fabric_vertex, return_inverse=True)
    group = group.reshape(triangles.shape)
    shear = np.rint(PER_DEGREE * at_corners(piece_shear(result), trimmed.area, group)).astype(np.int64)
    shear[bare] = BARE + trimmed.reason[bare, None].astype(np.int64)
    towards = normal.astype(np.int64) - BARE
    key = (group.astype(np.int64) << 32) + (towards[..., 0] << 16) + towards[..., 1]
    _, first, corner = np.unique(key, return_index=True, return_inverse=True)
    return ReportMesh(
        space=space,
        fabric=fabric,
        position=space.count(trimmed.mesh.points)[triangles.ravel()[first]],
        at=at.reshape(-1, 2)[first],
        normal=normal.reshape(-1, 2)[first],
        shear=shear.ravel()[first].astype(np.int16),
        triangles=corner.reshape(-1, 3).astype(np.uint16 if len(first) <= STEPS else np.uint32),
        edges=space.count(drawn_edges(surface)),
    )


def piece_shear(result: Drape) -> Floats:
    """Shear (m,) degrees, signed, on the facets cut to the pitch; NaN where bare."""
    warp, weft = unit_directions(result.trimmed)
    return np.asarray(np.degrees(np.arcsin(np.clip((warp * weft).sum(axis=1), -1.0, 1.0))))


def at_corners(values: Floats, area: Floats, group: Array) -> Floats:
    """Values (m,) of facets as a continuous field at their corners (m, 3), which ``group`` (m, 3) joins.

    The mean about each vertex, by area. It is of first order at a rim, where facets lie on one side only: what the
    means miss in the facets themselves is added, twice, which leaves a quarter of that. NaN facets get 0.
    """
    known = np.isfinite(values)
    weight = np.repeat(np.where(known, area, 0.0), 3)
    number = int(group.max()) + 1 if group.size else 0
    total = np.maximum(np.bincount(group.ravel(), weight, number), 1e-300)
    field = np.zeros(number)
    missing = np.where(known, values, 0.0)
    for _ in range(1 + ROUNDS):
        field += np.bincount(group.ravel(), weight * np.repeat(missing, 3), number) / total
        missing = np.where(known, values - field[group].mean(axis=1), 0.0)
    return np.asarray(field[group])


def piece_normals(result: Drape) -> Floats:
    """Normals (m, 3, 3) at the corners of the facets cut to the pitch, smooth but at creases of the part."""
    surface, mesh = result.net.surface, result.trimmed.mesh
    of_parent = corner_normals(surface).astype(float)[mesh.parent]
    owner = surface.triangles[mesh.parent]
    cut = np.flatnonzero((mesh.triangles != owner).any(axis=1))
    if len(cut):
        share = barycentric(mesh.points[mesh.triangles[cut]], surface.points[owner[cut]])
        of_parent[cut] = np.einsum("mcp,mpk->mck", share, of_parent[cut])
    return np.asarray(of_parent / np.linalg.norm(of_parent, axis=2, keepdims=True))


def barycentric(points: Floats, triangle: Floats) -> Floats:
    """Shares (m, c, 3) of the corners of triangles (m, 3, 3) in points (m, c, 3) of their planes."""
    a = triangle[:, :1]
    e, f, r = triangle[:, 1:2] - a, triangle[:, 2:3] - a, points - a
    ee, ef, ff = ((x * y).sum(axis=2) for x, y in ((e, e), (e, f), (f, f)))
    re, rf = (r * e).sum(axis=2), (r * f).sum(axis=2)
    det = ee * ff - ef * ef
    second, third = (ff * re - ef * rf) / det, (ee * rf - ef * re) / det
    return np.stack([1.0 - second - third, second, third], axis=2)


def on_octahedron(normals: Floats) -> Array:
    """Unit vectors (..., 3) as int16 (..., 2): on the octahedron |x| + |y| + |z| = 1, unfolded (Meyer, 2010)."""
    n = normals / np.abs(normals).sum(axis=-1, keepdims=True)
    x, y = n[..., 0], n[..., 1]
    sign_x, sign_y = np.where(x >= 0, 1.0, -1.0), np.where(y >= 0, 1.0, -1.0)
    below = n[..., 2] < 0.0
    flat = np.stack([np.where(below, (1 - np.abs(y)) * sign_x, x), np.where(below, (1 - np.abs(x)) * sign_y, y)], -1)
    return np.asarray(np.rint(32767 * flat), dtype=np.int16)


def drawn_edges(surface: Any) -> Floats:
    """End points (k, 2, 3) mm of the rim and of the creases; of the rim alone where nearly everything is a crease."""
    edges = sharp_edges(surface)
    if len(edges) <= MOST_EDGES * len(surface.triangles):
        return edges
    face, corner = np.nonzero(surface.neighbours < 0)
    ends = np.stack([surface.triangles[face, corner], surface.triangles[face, (corner + 1) % 3]], axis=1)
    return np.asarray(surface.points[ends])
