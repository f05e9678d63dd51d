"""Lay-up scatter: smooth random shifts of the ply, and what they do to every quantity that is measured.

No two plies lie alike: yarns wander by some tenths of a millimetre, and neighbours wander together, over 6 to 20 unit
cells (A. A. Skordos and M. P. F. Sutcliffe, Composites A 39, 2008). A test that takes residuals for independent finds
an effect in nearly every such ply. Here the shift s = (s_u, s_v) is a random field with standard deviation τ and
correlation length ℓ, the same along warp and weft, and every other quantity follows from it: shear by
∂s_u/∂v + ∂s_v/∂u, the turn of the warp by ∂s_v/∂u, that of the weft by -∂s_u/∂v. So positions and shear of one table
are not counted twice.

Source: derivatives of Gaussian processes, C. E. Rasmussen and C. K. I. Williams, Gaussian Processes for Machine
Learning (2006), section 9.4.
"""

from __future__ import annotations

import math
from enum import Enum

import numpy as np

DEG = math.degrees(1.0)

# What a channel sees of the shift: of s_u, then of s_v, the weights of the value and of its slopes along u and v.
SEES = {
    "along": ((1.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
    "across": ((0.0, 0.0, 0.0), (1.0, 0.0, 0.0)),
    "normal": ((0.0, 0.0, 0.0), (0.0, 0.0, 0.0)),
    "shear": ((0.0, 0.0, DEG), (0.0, DEG, 0.0)),
    "warp": ((0.0, 0.0, 0.0), (0.0, DEG, 0.0)),
    "weft": ((0.0, 0.0, -DEG), (0.0, 0.0, 0.0)),
}


def shifts(channel: str) -> bool:
    """Whether a shift of the ply along the part changes what the channel sees."""
    return any(any(weights) for weights in SEES[channel])


class Smoothness(Enum):
    """How smooth the shift is."""

    SMOOTH = "squared exponential"
    ROUGH = "Matérn 5/2"


def radial(distance: np.ndarray, length: float, kind: Smoothness) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Correlation k(r) at distances, g = -k'/r and h = -g'/r, which its derivatives are made of."""
    if kind is Smoothness.SMOOTH:
        k = np.exp(-0.5 * (distance / length) ** 2)
        return k, k / length**2, k / length**4
    a = math.sqrt(5.0) / length
    fall = np.exp(-a * distance)
    k = (1.0 + a * distance + (a * distance) ** 2 / 3.0) * fall
    return k, a**2 / 3.0 * (1.0 + a * distance) * fall, a**4 / 3.0 * fall


def scatter_covariance(
    at: np.ndarray, channels: tuple[str, ...], mask: np.ndarray, length: float, kind: Smoothness
) -> np.ndarray:
    """Covariance (m, m) of the quantities that a shift of standard deviation 1 mm causes.

    ``at`` (n, 2) mm are fabric coordinates; ``mask`` (n, c) says which point has which of the ``channels``; m are the
    true entries of ``mask``, channel by channel.
    """
    rows = [np.flatnonzero(mask[:, c]) for c in range(len(channels))]
    apart = at[:, None] - at[None, :]
    k, g, h = radial(np.linalg.norm(apart, axis=2), length, kind)
    du, dv = apart[..., 0], apart[..., 1]
    # cov(a-th derivative at x, b-th at x'), with 0 the value, 1 and 2 the slopes along u and v
    both = {
        (0, 0): k, (0, 1): g * du, (0, 2): g * dv, (1, 0): -g * du, (2, 0): -g * dv,
        (1, 1): g - h * du * du, (1, 2): -h * du * dv, (2, 1): -h * du * dv, (2, 2): g - h * dv * dv,
    }  # fmt: skip
    size = sum(len(r) for r in rows)
    total = np.zeros((size, size))
    starts = np.cumsum([0, *(len(r) for r in rows)])
    for c, one in enumerate(channels):
        for d, other in enumerate(channels):
            block = total[starts[c] : starts[c + 1], starts[d] : starts[d + 1]]
            for seen, seen_too in zip(SEES[one], SEES[other], strict=True):
                for (a, b), covariance in both.items():
                    if seen[a] and seen_too[b]:
                        block += seen[a] * seen_too[b] * covariance[np.ix_(rows[c], rows[d])]
    return total
