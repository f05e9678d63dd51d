"""The picture frame: four hinged bars of equal length, along the yarns, pulled at opposite corners.

The bars carry the whole sheet with them, so that its strain is even and one cell is exact: no inertia, no mesh.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import FormingError
from geomdrap.forming.cloth import Cloth
from geomdrap.forming.ledger import book_resin_loss, ledger_of
from geomdrap.forming.model import make_model
from geomdrap.forming.run import Frame, Run
from geomdrap.forming.sheet import rectangle
from geomdrap.forming.specimen import Pulled, Specimen, middle_shear
from geomdrap.forming.state import start, take_steps

Array = NDArray[np.float64]


def shear_frame(
    cloth: Cloth,
    side: float,
    shear: Sequence[float],
    speed: float,
    steps: int = 4000,
    progress: Callable[[float], None] | None = None,
) -> Pulled:
    """Shear ``cloth`` in a frame with bars of ``side`` mm, and read it at each of ``shear`` deg, ascending.

    The corner moves at ``speed`` mm/min; ``steps`` in all, in which the resin relaxes. The force is that on the
    corner. FormingError where a number is out of range.
    """
    angles = _checked(shear, side, speed, steps)
    stops, pace = [_opening(side, math.radians(a)) for a in angles], speed / 60.0
    step = stops[-1] / pace / steps
    specimen = Specimen(rectangle(1, 1, side).moved(_corners(side, 0.0)), cloth, np.arange(4), np.zeros((4, 3)), {})
    model = make_model(specimen.sheet, cloth, step, [0, 1, 2, 3])
    state = start(model)
    frames, gone = [Frame(0.0, state.points.copy(), np.zeros((4, 3)), ledger_of(model, state))], 0.0
    for number, stop in enumerate(stops, 1):
        count = max(1, round((stop - gone) / pace / step))
        for k in range(1, count + 1):
            take_steps(model, state, 1, _corners(side, _angle(side, gone + (stop - gone) * k / count)))
            book_resin_loss(model, state, step)
        gone = stop
        frames.append(Frame(state.time, state.points.copy(), -state.f.reshape(-1, 3), ledger_of(model, state)))
        if progress:
            progress(number / len(stops))
    force = [float(np.sum(f.reaction * _leverage(side, a))) for f, a in zip(frames, (0.0, *angles), strict=True)]
    seen = np.array([middle_shear(specimen.sheet, f.points) for f in frames])
    run = Run(model, tuple(frames), state, "")
    return Pulled(specimen, run, np.array([0.0, *stops]), {"force": np.array(force)}, seen, 0.0)


def _checked(shear: Sequence[float], side: float, speed: float, steps: int) -> list[float]:
    angles = [float(a) for a in shear]
    if not (angles and angles[0] > 0.0 and angles[-1] < 90.0 and all(a < b for a, b in pairwise(angles))):
        listed = ", ".join(f"{a:g}" for a in angles)
        raise FormingError(f"the shear of a frame must ascend, from above 0 to below 90 degrees; got {listed}")
    if not (side > 0.0 and speed > 0.0):
        raise FormingError(f"a frame needs a side and a speed above 0; got {side:g} mm and {speed:g} mm/min")
    if steps < len(angles):
        raise FormingError(f"{steps} steps are too few for {len(angles)} readings; take at least {len(angles)}")
    return angles


def _opening(side: float, angle_rad: float) -> float:
    """Displacement, mm, of the corner at a shear of ``angle_rad``."""
    return 2.0 * side * (math.cos(0.25 * math.pi - 0.5 * angle_rad) - math.cos(0.25 * math.pi))


def _angle(side: float, displacement: float) -> float:
    """Shear, rad, at a displacement of the corner."""
    return 0.5 * math.pi - 2.0 * math.acos(0.5 * displacement / side + math.cos(0.25 * math.pi))


def _bars(angle_rad: float) -> tuple[float, float]:
    """Directions, rad from +x, of the bars along warp and weft; the diagonal between them stays on y."""
    return 0.25 * math.pi + 0.5 * angle_rad, 0.75 * math.pi - 0.5 * angle_rad


def _corners(side: float, angle_rad: float) -> Array:
    """Corners (4, 3) mm of the frame in the order of the nodes of one cell."""
    warp, weft = (side * np.array([math.cos(a), math.sin(a), 0.0]) for a in _bars(angle_rad))
    return np.stack([0.0 * warp, weft, warp, warp + weft])


def _leverage(side: float, shear: float) -> Array:
    """How far each corner (4, 3) moves per mm of displacement at ``shear`` deg: reactions times it make the force."""
    angle = math.radians(shear)
    first, second = _bars(angle)
    rate = 1.0 / math.sin(0.25 * math.pi - 0.5 * angle)  # of the angle, times the side
    warp = 0.5 * rate * np.array([-math.sin(first), math.cos(first), 0.0])
    weft = -0.5 * rate * np.array([-math.sin(second), math.cos(second), 0.0])
    return np.stack([0.0 * warp, weft, warp, warp + weft])
