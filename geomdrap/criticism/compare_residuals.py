"""Residual vectors along the yarns, and angles between fibre directions."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from geomdrap.measurement.match import Matched


def in_yarns(vector: np.ndarray, matched: Matched) -> np.ndarray:
    """Components (n, 3) of vectors (n, 3) along warp, weft and normal, NaN where there is no prediction.

    Along sheared yarns the components are oblique: how far to go along the warp, then along the weft.
    """
    normal = np.einsum("ij,ij->i", vector, matched.normal)
    cosine = np.einsum("ij,ij->i", matched.warp, matched.weft)
    along = np.einsum("ij,ij->i", vector, matched.warp)
    across = np.einsum("ij,ij->i", vector, matched.weft)
    sine2 = 1.0 - cosine**2
    return np.column_stack([(along - cosine * across) / sine2, (across - cosine * along) / sine2, normal])


def turns(predicted: np.ndarray, measured: np.ndarray, normal: np.ndarray) -> np.ndarray:
    """Angles (n,) degrees from predicted to measured directions (n, 3), seen along the normal.

    Counter-clockwise about the normal; directions have no head, so that the angle lies in (-90, 90].
    """
    sine = np.einsum("ij,ij->i", np.cross(predicted, measured), normal)
    height = np.einsum("ij,ij->i", measured, normal)[:, None] * normal
    cosine = np.einsum("ij,ij->i", predicted, measured - height)
    angle = np.degrees(np.arctan2(sine, cosine))
    return 90.0 - (90.0 - angle) % 180.0
