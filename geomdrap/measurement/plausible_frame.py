"""Points measured in another frame than the part's: moved, turned, or mirrored as a whole."""

from __future__ import annotations

import warnings
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from geomdrap.fishnet import Net
    from geomdrap.measurement.match import Matched
    from geomdrap.measurement.measurement import Measurement

ASTRAY = 0.01
"""Of the part's diagonal: points that far from where they are predicted are no matter of lay-up."""
OFF = 0.12
"""Of that distance: the points lie as unevenly off the part where their frame is another one, at least."""
BETTER = 0.25
"""Another frame explains a measurement where it brings half of the points to this share of the distance."""
LEAST_TURN = 0.5
"""Degrees: a smaller turn is not told."""
FEWEST = 6
"""Points from which on a frame can be told."""


def other_frame(net: Net, measurement: Measurement, found: Matched) -> str | None:
    """In which other frame the points seem to be, and how near they would lie; None where they do not.

    A ply that is laid elsewhere still lies on the part, and a thick one as far off it everywhere: only points that
    are off the part by more here than there count as moved.
    """
    if measurement.u is None or found.used.sum() < FEWEST:
        return None
    points, predicted = measurement.points[found.used], found.point[found.used]
    size, present = net.surface.diagonal, _typical(points - predicted)
    if present < ASTRAY * size:
        return None
    (there, move, turn), (mirrored, _, _) = (_carried(points, predicted, sign) for sign in (1.0, -1.0))
    said = "half of the points would then lie within {:.3g} mm of the prediction, instead of {:.3g} mm"
    left, left_mirrored = _typical(there - predicted), _typical(mirrored - predicted)
    if left_mirrored < BETTER * min(present, left):
        what = "the points are those of a mirrored part (left for right, or an axis with the other sign)"
        return f"{what}: {said.format(left_mirrored, present)}"
    off = _unevenly_off(net, points)
    if left < BETTER * present and off > OFF * present:
        turned = f" and turned by {turn:.3g} degrees" if turn > LEAST_TURN else ""
        x, y, z = np.round(move, 2) + 0.0
        what = f"the points are in another frame, moved by ({x:.4g}, {y:.4g}, {z:.4g}) mm{turned}"
        return f"{what}: {said.format(left, present)}"
    return None


def _typical(away: np.ndarray) -> float:
    return float(np.median(np.linalg.norm(away, axis=1)))


def _unevenly_off(net: Net, points: np.ndarray) -> float:
    """How unevenly far off the part points (n, 3) lie, mm: half of them differ by less from the middle one."""
    near = net.surface.nearest(points)
    height = np.einsum("ij,ij->i", points - near.point, net.surface.normals[near.face])
    return float(np.median(np.abs(height - np.median(height))))


def _carried(points: np.ndarray, to: np.ndarray, sign: float) -> tuple[np.ndarray, np.ndarray, float]:
    """Points (n, 3) carried as a whole to others, turned (sign 1) or mirrored (-1) as fits best.

    With the move of their middle (3,) mm from where they should be, and the angle of the turn, degrees.
    """
    from scipy.spatial.transform import Rotation

    middle, other = points.mean(axis=0), to.mean(axis=0)
    away = sign * (points - middle)  # through their middle: a mirror and half a turn
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", UserWarning)  # on one line many turns are as good, and any will do
        turn, _ = Rotation.align_vectors(to - other, away)
    return turn.apply(away) + other, middle - other, float(np.degrees(turn.magnitude()))
