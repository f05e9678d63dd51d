"""How the generators turn: at a constant rate, along guide curves, or not at all."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import DrapeError
from geomdrap.fishnet.grid import STRAIN
from geomdrap.fishnet.guide import Curve, crossing, curve_on, turns_along
from geomdrap.fishnet.seed import Seed, heading_frame, plant
from geomdrap.fishnet.shift import Shift

if TYPE_CHECKING:
    from collections.abc import Sequence

    from geomdrap.fishnet.fabric import Fabric
    from geomdrap.fishnet.grid import Grid
    from geomdrap.geodesic.mesh import Mesh
    from geomdrap.surface import Surface

    Points = Sequence[Sequence[float]] | np.ndarray | None

LEAST, MOST = 20.0, 160.0  # degrees at which two guides may cross


@dataclass(frozen=True, eq=False)
class Guides:
    """Curves on the part that the warp and the weft generator follow; one of them may be None."""

    warp: Curve | None
    weft: Curve | None

    @classmethod
    def laid(cls, part: Surface, warp: Points, weft: Points, pitch: float, project: bool) -> Guides | None:
        """Guides laid onto the part; None where there are none. Raises DrapeError for those that leave it."""
        if warp is None and weft is None:
            return None
        named = ((warp, "the warp guide"), (weft, "the weft guide"))
        return cls(*(None if c is None else curve_on(part, c, name, pitch, project) for c, name in named))

    @property
    def note(self) -> str:
        """What they change, in words."""
        names = [name for name, curve in (("warp", self.warp), ("weft", self.weft)) if curve is not None]
        follow = "follow their guides" if len(names) > 1 else "follows its guide"
        return f"the {' and the '.join(names)} through the origin {follow}, on which the origin was moved"

    def require_alone(self, fabric: Fabric, shift: Shift) -> None:
        """Raise DrapeError for effects that would turn or move generators that guides hold."""
        if fabric.curvature_warp or fabric.curvature_weft or fabric.weft_angle != 90.0 or shift != Shift():
            raise DrapeError(
                "guide curves say where generators lie, and so do the effects steering, weave-skew and placement; "
                "use one or the other"
            )
        if fabric.relaxes:
            raise DrapeError("nets of least energy do not keep to guide curves; leave the guides or the effect out")

    def plant(
        self,
        part: Surface,
        point: np.ndarray,
        mesh: Mesh,
        reference: Sequence[float] | None,
        fabric: Fabric,
        pitch: float,
    ) -> tuple[Seed, float, Fabric]:
        """The seed on the guides nearest to ``point``, its heading (degrees), and the fabric as it crosses there."""
        if self.warp is not None and self.weft is not None:
            point = crossing(self.warp, self.weft, pitch)
        else:
            only = self.warp or self.weft
            assert only is not None
            point, _ = only.nearest(point, 0.0, only.length)
        near = part.nearest(point)
        point, normal = near.point[0], part.normals[int(near.face[0])]
        warp, weft = (None if c is None else _tangent_at(c, point, normal) for c in (self.warp, self.weft))
        if warp is not None and weft is not None:
            fabric = replace(fabric, weft_angle=_angle_between(warp, weft, normal))
        if warp is None:
            assert weft is not None
            warp = np.cross(weft, normal)
        start = plant(part, point, 0.0, mesh, [float(c) for c in warp], fabric.weft_angle)
        across = heading_frame(start.normal, reference)
        heading = math.degrees(math.atan2(start.warp @ np.cross(start.normal, across), start.warp @ across))
        return start, heading, fabric


def _tangent_at(curve: Curve, point: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Unit direction (3,) of a curve at its point nearest to ``point``, in the plane across ``normal``."""
    way = curve.tangent(curve.nearest(point, 0.0, curve.length)[1])
    flat = way - (way @ normal) * normal
    return np.asarray(flat / np.linalg.norm(flat))


def _angle_between(warp: np.ndarray, weft: np.ndarray, normal: np.ndarray) -> float:
    """Degrees from warp to weft about the normal. Raises DrapeError where they hardly cross, or the wrong way."""
    angle = math.degrees(math.atan2(float(normal @ np.cross(warp, weft)), float(warp @ weft)))
    if not LEAST < angle < MOST:
        raise DrapeError(
            f"the weft guide leaves at {angle:.1f}° from the warp guide, counter-clockwise about the normal; it must "
            f"be between {LEAST:g}° and {MOST:g}°: turn the order of its points round, or choose another curve"
        )
    return angle


def generator_turns(
    mesh: Mesh, grid: Grid, i0: int, j0: int, start: Seed, fabric: Fabric, guides: Guides | None
) -> np.ndarray:
    """Turns (4, n) to the left, radians, of the half-axes +u, +v, -u, -v at their nodes, the first at the seed.

    Of a constant curvature each node takes what a side of the yarn turns by, the seed half of it on either hand.
    """
    rates = (fabric.curvature_warp, fabric.curvature_weft)
    curves = (guides.warp, guides.weft) if guides else (None, None)
    if not any(rates) and not guides:
        return np.zeros((4, 1))
    turns = np.zeros((4, max(grid.face.shape)))
    along, across = grid.sides_u, grid.sides_v * (1.0 + grid.node[i0, :-1, STRAIN])
    half_axes = (along[i0:], across[j0:], along[:i0][::-1], across[:j0][::-1])
    for a, sides in enumerate(half_axes):
        sense, curve, count = 1 if a < 2 else -1, curves[a % 2], len(sides)
        if curve is not None:
            name = f"the {'warp' if a % 2 == 0 else 'weft'} guide"
            turns[a, :count] = turns_along(mesh, curve, int(start.starts[a]), start.places[a], sides, sense, name)
        elif count:
            turns[a, :count] = sense * rates[a % 2] * sides
            turns[a, 0] *= 0.5
    return turns
