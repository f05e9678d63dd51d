"""A stack of plies: each is draped on what those below it make of the tool."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np

from geomdrap.effects.parallel import offset_vectors
from geomdrap.errors import DrapeError
from geomdrap.fields import evaluate
from geomdrap.fishnet import drape

if TYPE_CHECKING:
    from geomdrap.fields import Drape
    from geomdrap.surface import Surface

MOST = 1000


@dataclass(frozen=True, eq=False)
class Ply:
    """One ply of a stack: its ``number`` from 1, the tool's side first; ``angle`` degrees from the stack's heading;
    ``tool``, the surface that it lies on; ``below``, mean and greatest thickness of the plies under it, mm.
    """

    number: int
    angle: float
    tool: Surface
    below: tuple[float, float]
    drape: Drape


def lay_plies(
    surface: Surface,
    angles: Sequence[float],
    thickness: float,
    *,
    origin: Any = "centroid",
    angle: float = 0.0,
    limit_angle: float | None = None,
    project: bool = False,
    on_ply: Callable[[Ply], None] = lambda ply: None,
    **laid: Any,
) -> tuple[Ply, ...]:
    """Drape plies one on another, on the side to which the part's normal points.

    The first lies on the tool; each next one on the surface that the plies below make, which is higher than that by
    ``thickness`` mm over the cosine of their shear: a sheared ply keeps its volume. Where a ply is bare it adds
    nothing. ``angles`` count from the heading ``angle``; the origin of a ply is the point of its surface nearest to
    that of the ply below. ``laid`` goes to ``geomdrap.drape``, the pitch chosen for the first ply to all.
    Raises DrapeError for a thickness that is not positive, for more plies than can be meant, and where the surface of
    the plies folds.
    """
    if len(angles) > MOST:
        raise DrapeError(f"{len(angles)} plies are more than the {MOST} that can be stacked")
    if not (math.isfinite(thickness) and thickness > 0.0):
        raise DrapeError(f"the thickness of a ply must be a positive number of mm, not {thickness}")
    plies: list[Ply] = []
    tool, height = surface, np.zeros(len(surface.points))
    for number, turn in enumerate(angles, 1):
        net = drape(tool, origin, angle + turn, project=project, **laid)
        ply = Ply(number, turn, tool, _mean_and_most(tool, height), evaluate(net, limit_angle))
        plies.append(ply)
        on_ply(ply)
        if number < len(angles):
            added = thickness * thickness_factor(ply)
            tool, height = thickened(tool, added, number), height + added
            origin, project, laid = tuple(float(x) for x in net.origin), True, {**laid, "pitch": net.pitch}
    return tuple(plies)


def thickness_factor(ply: Ply) -> np.ndarray:
    """What a ply adds at the vertices (n,) of the surface that it lies on, as a share of its thickness when flat."""
    on = ply.drape.net.surface
    weight = on.areas * ply.drape.face_coverage
    corners = on.triangles.ravel()
    moment = np.bincount(corners, np.repeat(weight * np.nan_to_num(ply.drape.face_thickness), 3), len(on.points))
    total = np.bincount(corners, np.repeat(on.areas, 3), len(on.points))
    factor = moment / np.where(total > 0.0, total, 1.0)
    if np.array_equal(on.triangles, ply.tool.triangles):
        return factor
    # the fabric lies on one piece of the part, or on a surface that effects made of it
    piece = ply.tool.component[ply.tool.nearest(ply.drape.net.origin).face[0]]
    own = np.zeros(len(ply.tool.points), bool)
    own[ply.tool.triangles[ply.tool.component == piece]] = True
    near = on.nearest(ply.tool.points)
    return np.where(own, factor[on.triangles[near.face]].mean(axis=1), 0.0)


def thickened(surface: Surface, height: np.ndarray, number: int) -> Surface:
    """The surface raised at its vertices by ``height`` (n,) mm along the normals, by ply ``number``.

    Raises DrapeError, with the place, where a facet turns over: the hollow there is filled.
    """
    moved = surface.moved(surface.points + height[:, None] * offset_vectors(surface))
    turned = ~((moved.normals * surface.normals).sum(axis=1) > 0.0)
    if turned.any():
        x, y, z = surface.points[surface.triangles[int(np.argmax(turned))]].mean(axis=0)
        raise DrapeError(
            f"at ({x:.4g}, {y:.4g}, {z:.4g}) {surface.source} is curved more tightly than ply {number} is thick: no "
            "further ply fits in; use fewer or thinner plies, or --effect bridging:radius=MM"
        )
    return moved


def _mean_and_most(surface: Surface, height: np.ndarray) -> tuple[float, float]:
    """Mean over the area, and greatest, of values (n,) at the vertices."""
    mean = float((height[surface.triangles].mean(axis=1) * surface.areas).sum() / surface.area)
    return mean, float(height.max())
