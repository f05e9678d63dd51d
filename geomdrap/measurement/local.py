"""What a value would be if it went with its neighbours: robust local planes."""

from __future__ import annotations

import numpy as np

NEIGHBOURS = 12
FEWEST = 8
"""Places from which on there are planes through neighbours."""
ROUNDS = 6
TUNING = 4.685
"""Of Tukey's bisquare: weight 0 beyond so many robust standard deviations (95 % efficient for normal noise)."""
ROUNDING = 1e-6
"""Of the range of the values: what lies this close to a plane lies on it."""
SAME = 1e-7
"""Of the extent of the places: differences below this are rounding."""
HOLD = 1e-7
"""Of the weights: holds up planes whose neighbours lie on a line."""
MAD_TO_SIGMA = 1.4826


def quantile_of_size(share: float, width: int) -> float:
    """Quantile of the length of ``width`` independent normal numbers."""
    from scipy.special import chdtri

    return float(np.sqrt(chdtri(width, 1.0 - share)))


def robust_sigma(values: np.ndarray) -> float:
    """Standard deviation of the components of values (n, k) about zero, from the median of their lengths.

    Rows with NaN are left out; NaN where none is left.
    """
    sizes = np.linalg.norm(values[np.isfinite(values).all(axis=1)], axis=1)
    return float(np.median(sizes)) / quantile_of_size(0.5, values.shape[1]) if len(sizes) else float("nan")


def neighbours(places: np.ndarray, count: int = NEIGHBOURS) -> np.ndarray:
    """Numbers (n, count) of the nearest other places (n, d); fewer columns where there are fewer places.

    Which of equally near ones are taken depends on the places alone, not on the order of the rows.
    """
    # rounded, so that marks on a grid stay equally near after a change of unit
    places = np.round((places - places.min(axis=0)) / max(SAME * float(np.ptp(places, axis=0).max()), 1e-300))
    order = np.lexsort(places.T)
    out = np.empty((len(places), min(count, len(places) - 1)), np.int64)
    out[order] = order[_nearest_others(places[order], out.shape[1])]
    return out


def _nearest_others(places: np.ndarray, count: int) -> np.ndarray:
    from scipy.spatial import cKDTree

    _, near = cKDTree(places).query(places, k=count + 1)
    near = near.reshape(len(places), count + 1)
    # a place is its own nearest, but among coincident places not always the first
    own = near == np.arange(len(places))[:, None]
    own[~own.any(axis=1), -1] = True
    return np.asarray(near[~own].reshape(len(places), count))


def deviations(places: np.ndarray, values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """How far values (n, k) lie off a robust plane through their neighbours, without themselves.

    ``places`` (n, 2) mm. Gives the deviations (n, k) and the factor (n,) by which independent noise is larger in them
    than in the values. NaN for all where there are fewer than 8 places.
    """
    n, width = values.shape
    if n < FEWEST:
        return np.full((n, width), np.nan), np.full(n, np.nan)
    near = neighbours(places)
    offset = places[near] - places[:, None]
    scale = np.sqrt((offset**2).sum(axis=2).max(axis=1))
    offset = offset / np.where(scale > 0.0, scale, 1.0)[:, None, None]
    basis = np.concatenate([np.ones((*offset.shape[:2], 1)), offset], axis=2)
    weight = np.ones(near.shape)
    around = values[near]
    for _ in range(ROUNDS):
        plane, gram = _fit(basis, around, weight)
        off = np.linalg.norm(around - basis @ plane, axis=2)
        spread = np.median(off, axis=1, keepdims=True) * MAD_TO_SIGMA / np.sqrt(width)
        reach = TUNING * np.sqrt(width) * np.maximum(spread, ROUNDING * float(np.ptp(values)) + 1e-300)
        weight = (1.0 - np.minimum(off / reach, 1.0) ** 2) ** 2 + 1e-6
    plane, gram = _fit(basis, around, weight)
    leverage = np.linalg.inv(gram)[:, 0, 0]
    return values - plane[:, 0], np.sqrt(1.0 + np.clip(leverage, 0.0, 10.0))


def _fit(basis: np.ndarray, around: np.ndarray, weight: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Weighted planes (n, 3, k) and their normal matrices (n, 3, 3), held up where the neighbours lie on a line."""
    weighted = basis * weight[..., None]
    gram = np.einsum("nmi,nmj->nij", weighted, basis)
    gram = gram + np.eye(3) * np.array([0.0, HOLD, HOLD]) * weight.sum(axis=1)[:, None, None]
    right = np.einsum("nmi,nmk->nik", weighted, around)
    return np.linalg.solve(gram, right), gram
