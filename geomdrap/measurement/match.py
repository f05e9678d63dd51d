"""Where a net predicts each measured point, and why it does not where it does not."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.measurement.inverse import fabric_coordinates
from geomdrap.measurement.rim import distance_to_rim

if TYPE_CHECKING:
    from geomdrap.fishnet import Net
    from geomdrap.measurement.measurement import Measurement
    from geomdrap.surface import Nearest

    Reasons = Callable[[Net, np.ndarray, np.ndarray], list[str]]

NO_CELL = "no cell of the net here: a bare part of the tool, or between the last whole cell and the rim"
BEYOND = "beyond the rim of the part"

BESIDE = 0.02
"""Of the distance from the part, and of the pitch: a foot this far off the normal lies beyond the rim."""


@dataclass(frozen=True, eq=False)
class Matched:
    """Predictions of a net for the rows of a measurement.

    ``u``, ``v`` (n,) mm: given, or found at the nearest point of the net. ``point`` (n, 3) mm is the predicted place,
    or the nearest one; ``shear`` (n,) degrees; ``warp``, ``weft``, ``normal`` (n, 3) unit directions there. All are
    NaN in rows without a prediction, whose ``reason`` says why; it is empty in the others.
    """

    u: np.ndarray
    v: np.ndarray
    point: np.ndarray
    shear: np.ndarray
    warp: np.ndarray
    weft: np.ndarray
    normal: np.ndarray
    reason: tuple[str, ...]

    @property
    def used(self) -> np.ndarray:
        """Which rows (n,) have a prediction."""
        return np.array([not reason for reason in self.reason], bool)


def match(net: Net, measurement: Measurement) -> Matched:
    """Match by fabric coordinates where the measurement has them, else by the nearest point of the draped net."""
    if measurement.u is not None and measurement.v is not None:
        u, v = measurement.u, measurement.v
        return _predicted(net, u, v, *net.interpolate(u, v), _label_reasons)
    near = net.surface.nearest(measurement.points)
    u, v = fabric_coordinates(net, near.face, near.point)
    _, shear = net.interpolate(u, v)
    matched = _predicted(net, u, v, near.point, shear, _place_reasons)
    beside = _beside(net, measurement.points, near).tolist()
    reason = tuple(BEYOND if b else r for b, r in zip(beside, matched.reason, strict=True))
    return _blanked(matched, np.where(beside, np.nan, 1.0)[:, None], reason)


def _predicted(
    net: Net, u: np.ndarray, v: np.ndarray, point: np.ndarray, shear: np.ndarray, reasons: Reasons
) -> Matched:
    warp, weft = net.directions(u, v)
    normal = np.cross(warp, weft)
    size = np.linalg.norm(normal, axis=1)
    known = np.isfinite(shear) & (size > 0.0)
    normal = normal / np.where(known, size, 1.0)[:, None]
    why = np.full(len(known), "", object)
    why[~known] = reasons(net, u[~known], v[~known])
    reason = tuple(why.tolist())
    everything = Matched(u, v, point, shear, warp, weft, normal, reason)
    return _blanked(everything, np.where(known, 1.0, np.nan)[:, None], reason)


def _label_reasons(net: Net, u: np.ndarray, v: np.ndarray) -> list[str]:
    """Why there is no cell at fabric coordinates (n,): the status of the absent corners of the cell there."""
    from geomdrap.fishnet import Status

    i, j = (np.searchsorted(c, x, side="right") - 1 for c, x in ((net.u, u), (net.v, v)))
    far = [(x < c[0] - net.pitch) | (x > c[-1] + net.pitch) for c, x in ((net.u, u), (net.v, v))]
    out = []
    for k, m, beyond in zip(i.tolist(), j.tolist(), (far[0] | far[1]).tolist(), strict=True):
        if beyond:
            out.append("beyond the rim of the net")
            continue
        # status_around has a frame of one node: corner (k, m) is its [k + 1, m + 1]
        corners = net.status_around[k + 1 : k + 3, m + 1 : m + 3].ravel()
        absent = [Status(c) for c in corners.tolist() if c not in (Status.PRESENT, Status.UNREACHED)]
        out.append(absent[0].reason if absent else NO_CELL)
    return out


def _place_reasons(net: Net, u: np.ndarray, v: np.ndarray) -> list[str]:
    return [NO_CELL] * len(u)


def _beside(net: Net, points: np.ndarray, near: Nearest) -> np.ndarray:
    """Which points (n, 3) lie beside the part: their nearest place is on the rim, askew to its normal."""
    away = points - near.point
    normal = net.surface.normals[near.face]
    aside = np.linalg.norm(away - np.einsum("ij,ij->i", away, normal)[:, None] * normal, axis=1)
    on_rim = distance_to_rim(net.surface, near.point) < 1e-6 * net.surface.diagonal
    return np.asarray(on_rim & (aside > BESIDE * (near.distance + net.pitch)))


def _blanked(matched: Matched, blank: np.ndarray, reason: tuple[str, ...]) -> Matched:
    """The same with predictions times ``blank`` (n, 1), which is 1 or NaN."""
    vectors = {name: getattr(matched, name) * blank for name in ("point", "warp", "weft", "normal")}
    return replace(matched, shear=matched.shear * blank[:, 0], reason=reason, **vectors)
