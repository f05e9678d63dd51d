"""The ply at the corners of the facets cut to the pitch: fabric coordinates, shear, normals, and which are one."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from geomdrap.export.scene import corner_normals
from geomdrap.fields.evaluate import sheared, unit_directions

if TYPE_CHECKING:
    from geomdrap.fields import Drape

Floats = NDArray[np.float64]
Array = NDArray[Any]

STEPS = 65535
"""Of 16 bits: places are told apart to 1/65535 of the part's and of the pattern's size."""
ROUNDS = 2


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


@dataclass(frozen=True, eq=False)
class PlyCorners:
    """Facets (m,) with values at their corners.

    ``triangles`` (m, 3) rows of the points of ``result.trimmed.mesh``; ``at`` (m, 3, 2) mm in the fabric, within
    ``fabric``; ``shear`` (m, 3) degrees; ``normals`` (m, 3, 3); ``bare`` (m,) and ``reason`` (m,), a `Status`.
    ``at`` and ``shear`` mean nothing where bare. ``cut`` (k,): those that are pieces of a facet of the part,
    ``shares`` (k, 3, 3) where their corners lie between its corners.
    """

    fabric: Box
    triangles: Array
    at: Floats
    shear: Floats
    normals: Floats
    bare: NDArray[np.bool_]
    reason: Array
    cut: Array
    shares: Floats

    def places(self) -> Array:
        """Numbers (m, 3), equal for corners of one vertex that lie at one place of the fabric, or are bare alike."""
        at = self.fabric.count(self.at).astype(np.int64)
        key = (self.triangles.astype(np.int64) << 32) + (at[..., 0] << 16) + at[..., 1]
        key[self.bare] = (self.triangles[self.bare].astype(np.int64) << 32) + self.reason[self.bare, None]
        return np.asarray(np.unique(key, return_inverse=True)[1].reshape(key.shape))

    def joined(self) -> tuple[Array, Array]:
        """Numbers (m, 3), equal for corners that are one place and have one normal; the first corner of each (n,)."""
        x, y = np.moveaxis(on_octahedron(self.normals).astype(np.int64) + 32768, -1, 0)
        key = (self.places().astype(np.int64) << 32) + (x << 16) + y
        _, first, number = np.unique(key, return_index=True, return_inverse=True)
        return number.reshape(key.shape), first


def ply_corners(result: Drape) -> PlyCorners:
    """The corners of a drape's facets."""
    trimmed, surface = result.trimmed, result.net.surface
    mesh, bare = trimmed.mesh, trimmed.kind == 0
    owner = surface.triangles[mesh.parent]
    cut = np.flatnonzero((mesh.triangles != owner).any(axis=1))
    shares = barycentric(mesh.points[mesh.triangles[cut]], surface.points[owner[cut]])
    made = PlyCorners(
        fabric=Box.around(trimmed.at[~bare].reshape(-1, 2)),
        triangles=mesh.triangles,
        at=trimmed.at,
        shear=np.zeros(mesh.triangles.shape),
        normals=piece_normals(result, cut, shares),
        bare=bare,
        reason=trimmed.reason.astype(np.int64),
        cut=cut,
        shares=shares,
    )
    return replace(made, shear=at_corners(piece_shear(result), trimmed.area, made.places()))


def piece_shear(result: Drape) -> Floats:
    """Shear (m,) degrees, signed, on the facets cut to the pitch; NaN where bare."""
    return sheared(*unit_directions(result.trimmed))


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


def piece_normals(result: Drape, cut: Array, shares: Floats) -> Floats:
    """Normals (m, 3, 3) at the corners of the facets cut to the pitch, smooth but at creases of the part."""
    normals = corner_normals(result.net.surface).astype(float)[result.trimmed.mesh.parent]
    normals[cut] = np.einsum("mcp,mpk->mck", shares, normals[cut])
    return np.asarray(normals / np.sqrt(np.einsum("mck,mck->mc", normals, normals))[..., None])


def barycentric(points: Floats, triangle: Floats) -> Floats:
    """Shares (m, c, 3) of the corners of triangles (m, 3, 3) in points (m, c, 3) of their planes."""
    a = triangle[:, 0]
    e, f, r = triangle[:, 1] - a, triangle[:, 2] - a, points - a[:, None]
    ee, ef, ff = (np.einsum("mk,mk->m", x, y)[:, None] for x, y in ((e, e), (e, f), (f, f)))
    re, rf = np.einsum("mck,mk->mc", r, e), np.einsum("mck,mk->mc", r, f)
    det = ee * ff - ef * ef
    shares = np.empty((*re.shape, 3))
    shares[..., 1], shares[..., 2] = (ff * re - ef * rf) / det, (ee * rf - ef * re) / det
    shares[..., 0] = 1.0 - shares[..., 1] - shares[..., 2]
    return shares


def on_octahedron(normals: Floats) -> Array:
    """Unit vectors (..., 3) as int16 (..., 2): on the octahedron |x| + |y| + |z| = 1, unfolded (Meyer, 2010)."""
    n = normals / np.abs(normals).sum(axis=-1, keepdims=True)
    x, y = n[..., 0], n[..., 1]
    sign_x, sign_y = np.where(x >= 0, 1.0, -1.0), np.where(y >= 0, 1.0, -1.0)
    below = n[..., 2] < 0.0
    flat = np.stack([np.where(below, (1 - np.abs(y)) * sign_x, x), np.where(below, (1 - np.abs(x)) * sign_y, y)], -1)
    return np.asarray(np.rint(32767 * flat), dtype=np.int16)
