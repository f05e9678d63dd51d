"""What is measured of a simulated ply: marks on a grid in the fabric, true, and as an instrument sees them."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from geomdrap.blind.ply import Ply
from geomdrap.blind.recipe import Recipe
from geomdrap.blind.scatter import Shift
from geomdrap.blind.shear import angle_between, differences, node_shear
from geomdrap.blind.terms import Array

Index = NDArray[np.intp]

SPACING = 16.0  # mm, of the marks in the flat fabric


@dataclass(frozen=True)
class Marks:
    """Marks with fabric coordinates (n, 2) mm, positions (n, 3) mm, shear (n,) deg, unit directions (n, 3)."""

    uv: Array
    points: Array
    shear: Array
    warp: Array
    weft: Array

    def only(self, chosen: Index) -> Marks:
        """Give the marks with these indices."""
        return Marks(*(getattr(self, name)[chosen] for name in self.__dataclass_fields__))


def _at(ply: Ply, spacing: float) -> tuple[Index, Index]:
    """Indices of the nodes that carry a mark and have all neighbours."""
    step = round(spacing / (ply.u[1] - ply.u[0]))
    middle = len(ply.u) // 2
    complete = np.isfinite(node_shear(ply.points))
    marked = np.zeros_like(complete)
    marked[middle % step :: step, middle % step :: step] = True
    i, j = np.nonzero(complete & marked)
    return i, j


def fabric_points(ply: Ply, spacing: float = SPACING) -> Array:
    """Fabric coordinates (n, 2) mm of the marks on ``ply``."""
    i, j = _at(ply, spacing)
    return np.stack([ply.u[i], ply.v[j]], axis=1)


def true_marks(ply: Ply, recipe: Recipe, shift: Shift | None = None, spacing: float = SPACING) -> Marks:
    """Give the marks as they are; ``shift``: scatter at ``fabric_points``.

    A shifted mark lies where the net is at (u + s_u, v + s_v); its yarns turn with the slopes of the shift, which
    changes the shear by about ∂s_u/∂v + ∂s_v/∂u. Recovery scales the shear and not the place.
    """
    i, j = _at(ply, spacing)
    side = ply.u[1] - ply.u[0]
    uv = np.stack([ply.u[i], ply.v[j]], axis=1)
    warp, weft = (d[i, j] / side for d in differences(ply.points))
    shear, plan = node_shear(ply.points)[i, j], ply.plan[i, j]
    if shift is not None:
        plan_u, plan_v = (d[i, j] / side for d in differences(ply.plan))
        plan = plan + shift.value[:, :1] * plan_u + shift.value[:, 1:] * plan_v
        s = shift.slope
        before = angle_between(warp, weft)
        warp, weft = (
            warp * (1.0 + s[:, 0, 0, None]) + weft * s[:, 1, 0, None],
            warp * s[:, 0, 1, None] + weft * (1.0 + s[:, 1, 1, None]),
        )
        shear = shear + angle_between(warp, weft) - before
    points = ply.sheet(plan)[0] if len(plan) else np.zeros((0, 3))
    points = recovered_shape(points, recipe, ply)
    return Marks(uv, points, (1.0 - recipe.recovery) * shear, _unit(warp), _unit(weft))


def recovered_shape(points: Array, recipe: Recipe, ply: Ply) -> Array:
    """Sag of the ply between its edges and growth of the part by heat: (n, 3) mm."""
    if recipe.sag:
        half = np.nanmax(np.abs(ply.points[..., :2]), axis=(0, 1))
        span = np.prod(1.0 - (points[:, :2] / half) ** 2, axis=1)
        points = points - np.column_stack([np.zeros((len(points), 2)), recipe.sag * span])
    return (1.0 + recipe.swell) * points


def lost(marks: Marks, rng: np.random.Generator, share: float, most: int | None = None) -> Marks:
    """Lose a ``share`` of the marks at random, and as many more as exceed ``most``."""
    keep = rng.permutation(len(marks.shear))[: max(round((1.0 - share) * len(marks.shear)), 1)]
    return marks.only(np.sort(keep[:most]))


def measured(marks: Marks, rng: np.random.Generator, sigma_xyz: float, sigma_shear: float) -> Marks:
    """Add independent instrument noise: ``sigma_xyz`` mm on each coordinate, ``sigma_shear`` deg on the shear.

    Each direction turns by sigma_shear/√2 in the plane of both, so that the angle between them errs as the shear.
    """
    points = marks.points + rng.normal(0.0, sigma_xyz, marks.points.shape)
    shear = marks.shear + rng.normal(0.0, sigma_shear, marks.shear.shape)
    normal = np.cross(marks.warp, marks.weft)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    turn = np.deg2rad(rng.normal(0.0, sigma_shear / np.sqrt(2.0), (2, len(shear), 1)))
    warp, weft = (
        _unit(d + np.tan(t) * np.cross(normal, d)) for d, t in zip((marks.warp, marks.weft), turn, strict=True)
    )
    return Marks(marks.uv, points, shear, warp, weft)


def spoilt(marks: Marks, rng: np.random.Generator, share: float) -> tuple[Marks, Index]:
    """Make a ``share`` of the marks outliers, 3 to 10 mm and 5 to 20° off; also gives their indices."""
    n = len(marks.shear)
    bad = np.sort(rng.permutation(n)[: round(share * n)]).astype(np.intp)
    way = _unit(rng.normal(size=(len(bad), 3)))
    points, shear = marks.points.copy(), marks.shear.copy()
    points[bad] += way * rng.uniform(3.0, 10.0, (len(bad), 1))
    shear[bad] += rng.uniform(5.0, 20.0, len(bad)) * rng.choice([-1.0, 1.0], len(bad))
    return replace(marks, points=points, shear=shear), bad


def _unit(vectors: Array) -> Array:
    return vectors / np.linalg.norm(vectors, axis=-1, keepdims=True)
