"""A ply that was laid down elsewhere than meant."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import DrapeError
from geomdrap.fishnet.seed import Seed
from geomdrap.geodesic.mesh import in_space, normal_of
from geomdrap.geodesic.trace import follow
from geomdrap.geodesic.unfold import ENDED

if TYPE_CHECKING:
    from collections.abc import Callable

    from geomdrap.geodesic.mesh import Mesh


@dataclass(frozen=True)
class Shift:
    """How far the ply lies from where it should: ``du``, ``dv`` mm along warp and weft, ``dangle`` degrees."""

    du: float = 0.0
    dv: float = 0.0
    dangle: float = 0.0


def displaced(shift: Shift, meant: Seed, plant: Callable[[float], Seed], mesh: Mesh, faces: int) -> Seed:
    """The seed where the ply was really laid down.

    The seed slides along the geodesic that leaves ``meant`` in the direction (du, dv) of its warp and weft; the warp
    is carried along without turning (parallel transport) and then turned counter-clockwise by ``dangle``. So the
    net is a smooth function of all three. ``plant`` gives a seed at the same point with the warp turned by degrees;
    ``faces`` is the number of faces that are no lids over holes.
    Raises DrapeError where the seed would leave the part.
    """
    skew = _weft_angle(meant)
    way = (shift.du + shift.dv * math.cos(skew), shift.dv * math.sin(skew))
    length, course = math.hypot(*way), math.atan2(way[1], way[0])
    if length == 0.0:
        return plant(shift.dangle)
    ray = plant(math.degrees(course))
    status, face, x, y, dx, dy, *_ = follow(mesh.row, mesh.link, int(ray.starts[0]), *ray.places[0], length)
    if status != ENDED or face >= faces:
        raise DrapeError(
            f"a placement of du = {shift.du:g} mm, dv = {shift.dv:g} mm moves the seed off the part; use smaller ones"
        )
    heading = math.atan2(dy, dx) - course + math.radians(shift.dangle)
    return _seed_on_face(mesh, face, x, y, heading, skew)


def _weft_angle(seed: Seed) -> float:
    """Angle from warp to weft about the normal, radians."""
    return math.atan2(float(np.cross(seed.warp, seed.weft) @ seed.normal), float(seed.warp @ seed.weft))


def _seed_on_face(mesh: Mesh, face: int, x: float, y: float, heading_rad: float, weft_rad: float) -> Seed:
    """A seed inside a face, the warp at an angle from the first axis of its frame."""
    turns = heading_rad + np.array([0.0, weft_rad, math.pi, math.pi + weft_rad])
    ways = np.column_stack([np.cos(turns), np.sin(turns)])
    axes = mesh.frames[face, 3:].reshape(2, 3)
    return Seed(
        face=int(face),
        point=np.array(in_space(mesh.frames, face, x, y)),
        normal=np.array(normal_of(mesh.frames, face)),
        warp=ways[0] @ axes,
        weft=ways[1] @ axes,
        starts=np.full(4, face),
        places=np.column_stack([np.full(4, x), np.full(4, y), ways]),
    )
