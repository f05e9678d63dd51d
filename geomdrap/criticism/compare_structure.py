"""Whether residuals are noise or have a structure: neighbours that are alike."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.measurement.local import neighbours

if TYPE_CHECKING:
    from geomdrap.criticism.comparison import Comparison

BEYOND_CHANCE = 0.001
NEAR = 8
CLASSES = 16
MOST = 1200
"""Points of which all pairs are taken; of more, evenly chosen ones."""


@dataclass(frozen=True)
class Likeness:
    """Moran's I of one kind of residual: 0 for noise, towards 1 where neighbours are alike; ``z`` standard scores of
    it, ``p`` the probability of one so large by chance.
    """

    moran: float
    z: float
    p: float

    @property
    def alike(self) -> bool:
        """Whether neighbours are alike beyond chance, which noise is not."""
        return self.p < BEYOND_CHANCE


@dataclass(frozen=True)
class Structure:
    """Likeness of neighbours by kind; None where there are too few points or nothing was measured."""

    position: Likeness | None
    shear: Likeness | None


@dataclass(frozen=True, eq=False)
class Pairs:
    """Pairs of points by classes of distance: ``count`` (k,), both ways, and ``mean`` products of each field."""

    count: np.ndarray
    mean: tuple[np.ndarray, ...]


def structure_of(comparison: Comparison) -> Structure:
    """Moran's I of the trusted residuals over their neighbours on the fabric."""
    where = np.column_stack([comparison.matched.u, comparison.matched.v])
    parts = comparison.vector if comparison.coordinates == 3 else comparison.parts[:, 2:]
    shear = comparison.shear
    return Structure(
        _likeness(where, parts, comparison.trusted),
        None if shear is None else _likeness(where, shear[:, None], comparison.trusted),
    )


def _likeness(where: np.ndarray, values: np.ndarray, trusted: np.ndarray) -> Likeness | None:
    from scipy.stats import norm

    kept = trusted & np.isfinite(values).all(axis=1)
    if kept.sum() < 2 * NEAR:
        return None
    near = neighbours(where[kept], NEAR)
    index, spread = morans_index(values[kept], near)
    z = index / spread
    return Likeness(index, z, float(norm.sf(z)))


def morans_index(values: np.ndarray, near: np.ndarray) -> tuple[float, float]:
    """Moran's I of values (n, m) less its expectation, and its standard deviation for independent normal noise.

    A. Cliff, J. Ord, Spatial processes, 1981, with weights 1/k for the k neighbours in ``near`` (n, k). Of vectors it
    is the mean of the components' by their variances, whatever the axes.
    """
    n = len(values)
    off = values - values.mean(axis=0)
    spread = float((off**2).sum())
    if spread <= 0.0:
        return 0.0, 1.0
    index = float((off * off[near].mean(axis=1)).sum()) / spread + 1.0 / (n - 1)
    covariance = off.T @ off
    share = float((covariance**2).sum()) / spread**2  # 1 for one component, 1/3 for three alike
    return index, float(np.sqrt(share * _variance_of_index(near)))


def _variance_of_index(near: np.ndarray) -> float:
    """Variance of Moran's I of independent normal numbers for the neighbours (n, k)."""
    n, k = near.shape
    chosen = np.bincount(near.ravel(), minlength=n) / k
    s0 = float(n)
    s1 = float(n / k + _mutual(near) / k**2)  # half the sum of (w_ij + w_ji)²
    s2 = float(np.sum((1.0 + chosen) ** 2))
    variance = (n**2 * s1 - n * s2 + 3.0 * s0**2) / ((n**2 - 1.0) * s0**2) - 1.0 / (n - 1.0) ** 2
    return max(variance, 1e-300)


def _mutual(near: np.ndarray) -> int:
    """Number of ordered pairs (i, j) of which each is a neighbour of the other."""
    n, k = near.shape
    here = np.repeat(np.arange(n), k)
    there = near.ravel()
    return int(np.isin(here * n + there, there * n + here).sum())


def pairs_by_distance(where: np.ndarray, fields: tuple[np.ndarray, ...]) -> Pairs:
    """Mean products of fields (n,), which have mean 0, over pairs of places (n, 2) by classes of distance.

    Reaches to half of the largest distance; further pairs are few and say little. Counts are those of all n points.
    """
    order = np.lexsort(where.T)
    chosen = order[np.unique(np.linspace(0, len(order) - 1, min(MOST, len(order))).astype(int))]
    places = where[chosen]
    apart = np.hypot(*(places[:, None] - places).transpose(2, 0, 1))
    np.fill_diagonal(apart, np.inf)
    top = 0.5 * float(np.max(apart[np.isfinite(apart)]))
    number = np.minimum(apart / max(top, 1e-300) * CLASSES, CLASSES).astype(int)
    near = number < CLASSES
    count = np.bincount(number[near], minlength=CLASSES)[:CLASSES]
    mean = []
    for values in fields:
        product = np.outer(values[chosen], values[chosen])
        mean.append(np.bincount(number[near], product[near], CLASSES)[:CLASSES] / np.maximum(count, 1))
    scale = (len(where) / len(chosen)) ** 2
    return Pairs(count * scale, tuple(mean))
