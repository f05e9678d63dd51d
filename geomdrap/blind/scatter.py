"""Lay-up scatter: a smooth random shift of the yarns in the fabric, with the slopes that shear it.

A sum of many random waves is a Gaussian field (Rahimi and Recht): normal wave vectors give a squared-exponential
correlation exp(−d²/2l²), Student's t with 2·2.5 degrees of freedom the rougher Matérn 5/2.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geomdrap.blind.terms import Array

WAVES = 400
KINDS = ("squared-exponential", "matern")


@dataclass(frozen=True)
class Shift:
    """Shift of points of the fabric along warp and weft, and its slopes."""

    value: Array
    """(n, 2) mm"""
    slope: Array
    """(n, 2, 2): d value[i] / d (u, v)[j], no unit."""


def random_shift(rng: np.random.Generator, uv: Array, sd: float, length: float, kind: str = KINDS[0]) -> Shift:
    """Draw a shift at fabric points ``uv`` (n, 2) mm: standard deviation ``sd`` and correlation ``length``, mm."""
    waves = rng.normal(size=(2, WAVES, 2)) / length
    if kind == "matern":
        waves *= np.sqrt(5.0 / rng.chisquare(5.0, size=(2, WAVES, 1)))
    phase = rng.uniform(0.0, 2.0 * np.pi, (2, WAVES))
    angle = np.einsum("nj,iwj->niw", uv, waves) + phase
    scale = sd * np.sqrt(2.0 / WAVES)
    return Shift(scale * np.cos(angle).sum(axis=2), -scale * np.einsum("niw,iwj->nij", np.sin(angle), waves))
