"""The numbers of a comparison: root mean squares beside the noise, chi² per degree of freedom."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from geomdrap.criticism.comparison import Comparison
    from geomdrap.measurement.noise import Noise


@dataclass(frozen=True)
class Score:
    """One kind of residual, in its unit (mm or degrees).

    ``rms``: root mean square of all values, of the length of the vector for positions. ``robust_rms``: the same
    without the outliers. ``noise``: the root mean square that noise alone would give; ``sigma``:
    the standard deviation behind it, per coordinate; None where the noise is not known. ``source``: of the noise.
    ``bias``: mean of the residual (components along warp, weft, normal, or one number). ``chi2``: sum of the squares
    in units of sigma over the ``dof`` trusted values. ``n``: values.
    """

    n: int
    rms: float
    robust_rms: float
    noise: float | None
    sigma: float | None
    source: str | None
    bias: tuple[float, ...]
    chi2: float | None
    dof: int


@dataclass(frozen=True)
class Scores:
    """Scores by kind, None where nothing of that kind was measured; ``chi2_per_dof`` over all of them."""

    position: Score | None
    shear: Score | None
    warp: Score | None
    weft: Score | None
    chi2_per_dof: float | None


def scores_of(comparison: Comparison) -> Scores:
    """The scores of a comparison."""
    wide = comparison.vector if comparison.coordinates == 3 else comparison.parts[:, 2:]
    position = _score(comparison, wide, comparison.noise_xyz, comparison.parts)
    shear, warp, weft = (
        None if values is None else _score(comparison, values[:, None], noise, values[:, None])
        for values, noise in (
            (comparison.shear, comparison.noise_shear),
            (comparison.warp_turn, comparison.noise_warp),
            (comparison.weft_turn, comparison.noise_weft),
        )
    )
    known = [score for score in (position, shear, warp, weft) if score is not None and score.chi2 is not None]
    dof = sum(score.dof for score in known)
    chi2 = sum(score.chi2 or 0.0 for score in known)
    return Scores(position, shear, warp, weft, chi2 / dof if dof else None)


def _score(comparison: Comparison, values: np.ndarray, noise: Noise, parts: np.ndarray) -> Score | None:
    """Score of values (n, k); ``parts`` (n, m) are what the bias is the mean of."""
    known = np.isfinite(values).all(axis=1)
    if not known.any():
        return None
    width = values.shape[1]
    size = np.linalg.norm(values[known], axis=1)
    kept = known & comparison.trusted
    sigma = None if noise.sigma is None else float(np.sqrt(np.mean(noise.sigma[known] ** 2)))
    chi2 = None if noise.sigma is None else float(np.sum((values[kept] / noise.sigma[kept, None]) ** 2))
    return Score(
        n=int(known.sum()),
        rms=float(np.sqrt(np.mean(size**2))),
        robust_rms=float(np.sqrt(np.mean(np.sum(values[kept] ** 2, axis=1)))),
        noise=None if sigma is None else float(sigma * np.sqrt(width)),
        sigma=sigma,
        source=noise.source,
        bias=tuple(np.mean(parts[kept], axis=0).tolist()) if kept.any() else (),
        chi2=chi2,
        dof=int(width * kept.sum()),
    )
