"""Shear that stops: the mark of a locked fabric, whichever of its many states the ply is in.

Where yarns lock, whole families of nets have nearly the same energy, and friction holds the ply in any of them. No
model foretells which, so positions stay off; but in all of them shear stops at one angle, however much more the
geometric net would shear. No other effect of the library does that: with all others the ply shears more where the
geometric net does.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

TOPS = (0.9, 0.95, 0.975, 0.99)  # quantiles of the measured shear that are tried for the plateau: few marks may lock
CLEAR = 4.0  # noises by which the model must exceed the plateau for a point to count
LEAST_POINTS = 8
ABOVE = 3.0  # noises that measured shear may lie above the plateau
SHARE_BELOW = 0.95  # of those points: must not exceed it
STEEP = 0.4  # slope of measured against predicted shear on the plateau: more is no plateau
PROPORTIONAL = 0.6  # a slope that springback or slip leaves at least: must be out of reach of two standard deviations


@dataclass(frozen=True)
class Plateau:
    """Shear stops at ``angle`` degrees (standard deviation ``sigma``)."""

    angle: float
    sigma: float


def plateau(measured: np.ndarray, predicted: np.ndarray, noise: float) -> Plateau | None:
    """The plateau of measured shear (n,) where a net predicts more (n,), degrees; None if there is none.

    ``noise`` (degrees) of the shear, with what lay-up scatter adds to it.
    """
    known = np.isfinite(measured) & np.isfinite(predicted)
    found, model = np.abs(measured[known]), np.abs(predicted[known])
    if len(found) < LEAST_POINTS:
        return None
    levels = (_at_level(found, model, float(np.quantile(found, q)), noise) for q in TOPS)
    return next((level for level in levels if level is not None), None)


def _at_level(found: np.ndarray, model: np.ndarray, top: float, noise: float) -> Plateau | None:
    """The plateau if there is one at ``top`` degrees."""
    over = model > top + CLEAR * noise
    if over.sum() < LEAST_POINTS or np.mean(found[over] <= top + ABOVE * noise) < SHARE_BELOW:
        return None
    spread = model[over] - model[over].mean()
    size = max(float(spread @ spread), 1e-12)
    slope = float(spread @ found[over]) / size
    crowded = np.mean(np.abs(found - top) < 2.0 * noise) > np.mean(np.abs(model - top) < 2.0 * noise)
    if abs(slope) > STEEP or slope + 2.0 * noise / np.sqrt(size) > PROPORTIONAL or not crowded:
        return None
    angle = float(np.median(found[over]))
    return Plateau(angle, max(float(np.std(found[over])) / np.sqrt(float(over.sum())), 0.5 * noise))
