"""Facets that were cut to the pitch, put together again where the fabric on them is linear: the same, smaller."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.export.ply_corners import Floats, PlyCorners
from geomdrap.export.scene import corner_normals

if TYPE_CHECKING:
    from geomdrap.fields import Drape

MOST_MOVE = 0.02
"""Share of the pitch by which fabric coordinates may differ from linear ones."""
MOST_SHEAR = 0.1
"""Degrees by which shear may."""


def merged(corners: PlyCorners, result: Drape) -> PlyCorners:
    """The same ply with those facets of the part whole on which coordinates and shear are linear, or all is bare.

    What the pieces that are left share with the facets of the part is left out of it.
    """
    surface, mesh = result.net.surface, result.trimmed.mesh
    cut, m = corners.cut, len(surface.triangles)
    if not len(cut):
        return corners
    parent = mesh.parent[cut]
    owner = surface.triangles[parent]
    values = np.concatenate([corners.at, corners.shear[..., None]], axis=2)
    whole = at_own_corners(values[cut], mesh.triangles[cut], owner, parent, m)
    off = np.abs(np.einsum("mcp,mpk->mck", corners.shares, whole[parent]) - values[cut]).max(axis=1)
    near = (off[:, :2].max(axis=1) <= MOST_MOVE * result.net.pitch) & (off[:, 2] <= MOST_SHEAR)
    near &= ~corners.bare[cut]
    reason = np.where(corners.bare, corners.reason, -1)[cut]
    bare_alike = corners.bare[cut] & (reason == first_of(reason, parent, m))
    alike = all_of(near, parent, m) | all_of(bare_alike, parent, m)
    gone = np.zeros(len(mesh.triangles), bool)
    gone[cut] = alike[parent]
    back = np.unique(parent[alike[parent]])
    of_part = corner_normals(surface).astype(float)[back]
    reason_of = np.zeros(m, np.int64)
    reason_of[parent] = corners.reason[cut]
    bare_of = np.zeros(m, bool)
    bare_of[parent] = corners.bare[cut]
    return replace(
        corners,
        triangles=np.concatenate([corners.triangles[~gone], surface.triangles[back]]),
        at=np.concatenate([corners.at[~gone], whole[back, :, :2]]),
        shear=np.concatenate([corners.shear[~gone], whole[back, :, 2]]),
        normals=np.concatenate([corners.normals[~gone], of_part]),
        bare=np.concatenate([corners.bare[~gone], bare_of[back]]),
        reason=np.concatenate([corners.reason[~gone], reason_of[back]]),
        cut=corners.cut[:0],
        shares=corners.shares[:0],
    )


def at_own_corners(values: Floats, triangles: np.ndarray, owner: np.ndarray, parent: np.ndarray, m: int) -> Floats:
    """Values (k, 3, c) of pieces as they are at the corners of the facets (m, 3, c) that the pieces are of."""
    piece, corner, own = np.nonzero(triangles[:, :, None] == owner[:, None, :])
    whole = np.full((m, 3, values.shape[2]), np.nan)
    whole[parent[piece], own] = values[piece, corner]
    return whole


def all_of(true: np.ndarray, parent: np.ndarray, m: int) -> np.ndarray:
    """Which facets (m,) have pieces, all of them true."""
    count = np.bincount(parent, minlength=m)
    return (count > 0) & (np.bincount(parent, true, m) == count)


def first_of(values: np.ndarray, parent: np.ndarray, m: int) -> np.ndarray:
    """For each piece the value of one piece of its facet, the same for all of them."""
    one = np.zeros(m, values.dtype)
    one[parent] = values
    return one[parent]
