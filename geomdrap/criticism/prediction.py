"""What a net foretells of a measured table."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from geomdrap.fishnet import Net
    from geomdrap.measurement import Measurement

CHANNELS = ("along", "across", "normal", "shear", "warp", "weft")


def predicted(net: Net, measurement: Measurement, frames: np.ndarray, channels: tuple[str, ...]) -> np.ndarray:
    """The model's table (n, c): positions in mm along the frames, shear in degrees, turns of the yarns in degrees.

    Directions have no zero of their own: their value is the turn from what was measured to the model.
    """
    from geomdrap.measurement.match import match

    found = match(net, measurement)
    out = np.full((len(measurement), len(channels)), np.nan)
    for c, name in enumerate(channels):
        if name in ("along", "across", "normal"):
            out[:, c] = np.einsum("nk,nk->n", found.point, frames[:, CHANNELS.index(name)])
        elif name == "shear":
            out[:, c] = found.shear
        elif (measured := getattr(measurement, name)) is not None:
            out[:, c] = turn(measured, getattr(found, name), frames[:, 2])
    return out


def turn(first: np.ndarray, second: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Angle (n,) in degrees from first to second direction (n, 3), counter-clockwise about the normal, mod 180°."""
    sine = np.einsum("nk,nk->n", np.cross(first, second), normal)
    cosine = np.einsum("nk,nk->n", first, second)
    angle = np.degrees(np.arctan2(sine, cosine))
    return (angle + 90.0) % 180.0 - 90.0
