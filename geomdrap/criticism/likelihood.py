"""How likely residuals are, under noise and lay-up scatter that are themselves found from them.

Every model of the ply is judged with the scatter that suits it best: the model without an effect may call its misfit
scatter, as far as scatter can look like that. What is left as evidence for an effect is what scatter cannot explain.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from geomdrap.criticism.kept import kept
from geomdrap.criticism.scatter import DEG, Smoothness, radial, scatter_covariance, shifts

RATIO = 1.4  # between neighbouring correlation lengths that are tried
SIZES = (0.0, 0.3, 0.4, 0.5, 0.65, 0.8, 1.0, 1.3, 1.6, 2.0, 2.5, 3.2, 4.0, 5.0, 6.5, 8.0, 10.0, 13.0, 16.0, 20.0)
"""Scatter over the positions' noise: in small steps, since intervals and tests are as good as its size is."""
START = 5  # of them: where the search begins
TURNING = 2.5  # degrees: scatter of the yarns' directions and shear, which no good lay-up exceeds
LARGEST = 1.0  # mm: yarns wander by some tenths of one; what lies further off was laid so, and has a cause
COVARIANCES, FACTORS = 2, 32  # kept: some 10 MB each at 400 points
WIDEST = 0.3  # of the measured patch's longer side: what varies more slowly is no scatter


@dataclass(frozen=True)
class Scatter:
    """Lay-up scatter: standard deviation ``size`` mm, correlation ``length`` mm; size 0 is none."""

    size: float = 0.0
    length: float = 1.0
    kind: Smoothness = Smoothness.SMOOTH

    @property
    def shear(self) -> float:
        """Standard deviation of the shear that it makes, degrees."""
        slope = float(radial(np.zeros(1), self.length, self.kind)[1][0])  # variance of a slope of a shift of 1 mm
        return DEG * self.size * float(np.sqrt(2.0 * slope))


NO_SCATTER = Scatter()


@dataclass(frozen=True, eq=False)
class Residuals:
    """A model's linearised fit: ``residual`` (m,) and ``slopes`` (m, p) of all its parameters."""

    residual: np.ndarray
    slopes: np.ndarray


class Judge:
    """Log-likelihoods of models under noise (m,) and scatter, with what is costly kept.

    ``at`` (n, 2) mm fabric coordinates; ``mask`` (n, c) which point has which of ``channels``; vectors hold the true
    entries of the mask, channel by channel.
    """

    def __init__(
        self, at: np.ndarray, channels: tuple[str, ...], mask: np.ndarray, noise: np.ndarray, unit: float
    ) -> None:
        self.at, self.channels, self.mask, self.noise, self.unit = at, channels, mask, noise, unit
        self.lengths = correlation_lengths(at[mask.any(axis=1)])
        # what no shift along the part can change keeps its own noise and stays out of the dense algebra
        self.shifted = np.concatenate([np.full(mask[:, c].sum(), shifts(name)) for c, name in enumerate(channels)])
        self._covariances: dict[tuple[float, Smoothness], np.ndarray] = {}
        self._factors: dict[Scatter, tuple[np.ndarray, float]] = {}

    def _covariance(self, length: float, kind: Smoothness) -> np.ndarray:
        return kept(self._covariances, (length, kind), lambda: self._make_covariance(length, kind), COVARIANCES)

    def _factor(self, scatter: Scatter) -> tuple[np.ndarray, float]:
        return kept(self._factors, scatter, lambda: self._make_factor(scatter), FACTORS)

    def _make_covariance(self, length: float, kind: Smoothness) -> np.ndarray:
        seen = [c for c, name in enumerate(self.channels) if shifts(name)]
        return scatter_covariance(self.at, tuple(self.channels[c] for c in seen), self.mask[:, seen], length, kind)

    def _make_factor(self, scatter: Scatter) -> tuple[np.ndarray, float]:
        """Lower Cholesky factor of the covariance of the shifted values, and half the log of all its determinant."""
        from scipy.linalg import cholesky

        total = scatter.size**2 * self._covariance(scatter.length, scatter.kind)
        total[np.diag_indices(len(total))] += self.noise[self.shifted] ** 2
        factor = cholesky(total, lower=True, overwrite_a=True, check_finite=False)
        return factor, float(np.log(np.diag(factor)).sum() + np.log(self.noise[~self.shifted]).sum())

    def whiten(self, scatter: Scatter) -> Callable[[np.ndarray], np.ndarray]:
        """The map that turns residuals (m,) or slopes (m, p) into independent ones of variance 1."""
        if scatter.size == 0.0:
            return lambda a: a / (self.noise if a.ndim == 1 else self.noise[:, None])
        from scipy.linalg import solve_triangular

        factor = self._factor(scatter)[0]

        def whitened(a: np.ndarray) -> np.ndarray:
            out = a / (self.noise if a.ndim == 1 else self.noise[:, None])
            out[self.shifted] = solve_triangular(factor, a[self.shifted], lower=True, check_finite=False)
            return out

        return whitened

    def log_likelihood(self, scatter: Scatter, models: Sequence[Residuals]) -> np.ndarray:
        """Log-likelihoods of models, each with its parameters at their best (to first order), less a constant."""
        whiten = self.whiten(scatter)
        half_log = float(np.log(self.noise).sum()) if scatter.size == 0.0 else self._factor(scatter)[1]
        columns = whiten(np.column_stack([np.column_stack([m.residual, m.slopes]) for m in models]))
        out, k = np.empty(len(models)), 0
        for n, model in enumerate(models):
            p = model.slopes.shape[1]
            out[n] = -0.5 * square_beside(columns[:, k], columns[:, k + 1 : k + 1 + p]) - half_log
            k += 1 + p
        return out

    def square(self, scatter: Scatter, model: Residuals) -> float:
        """Chi-square of a model under noise and scatter, its parameters at their best (to first order)."""
        whiten = self.whiten(scatter)
        return square_beside(whiten(model.residual), whiten(model.slopes))

    def floor(self, scatter: Scatter) -> float:
        """Root mean square over the noise of what noise and scatter leave to a perfect model."""
        if scatter.size == 0.0:
            return 1.0
        covariance = self._covariance(scatter.length, scatter.kind)
        more = scatter.size**2 * np.diag(covariance) / self.noise[self.shifted] ** 2
        return float(np.sqrt(1.0 + more.sum() / len(self.noise)))

    def best_scatter(
        self, models: Sequence[Residuals], of: Sequence[int], near: Scatter | None = None
    ) -> tuple[list[Scatter], np.ndarray]:
        """The likeliest scatter of each model and its log-likelihood (k,).

        The search climbs for the models ``of``, for the first of them from a scatter ``near``; every scatter that it
        visits is tried for all of them.
        """
        seen: dict[Scatter, np.ndarray] = {}

        def value(scatter: Scatter, n: int) -> float:
            if scatter not in seen:
                seen[scatter] = self.log_likelihood(scatter, models)
            return float(seen[scatter][n])

        value(NO_SCATTER, 0)
        for n, start in zip(of, [near, *[None] * len(of)], strict=False):
            self._climb(lambda scatter, n=n: value(scatter, n), *self._place_of(start))  # type: ignore[misc]
        visited = list(seen)
        table = np.array([seen[s] for s in visited])
        best = table.argmax(axis=0)
        return [visited[b] for b in best], table.max(axis=0)

    def _place_of(self, scatter: Scatter | None) -> tuple[int, int, Smoothness]:
        """Where a climb starts: numbers of length and size, and smoothness, like those of a scatter if given."""
        if scatter is not None and scatter.size > 0.0:
            length = int(np.argmin(np.abs(np.log(np.array(self.lengths) / scatter.length))))
            wanted, kind = int(np.argmin(np.abs(np.array(SIZES) * self.unit - scatter.size))), scatter.kind
        else:
            length, wanted, kind = len(self.lengths) // 2, START if scatter is None else 0, Smoothness.SMOOTH
        most = largest_scatter(self.lengths[length])
        return length, max(n for n in range(wanted + 1) if n == 0 or SIZES[n] * self.unit <= most), kind

    def _climb(self, value: Callable[[Scatter], float], length: int, size: int, kind: Smoothness) -> None:
        """Coordinate search over length, size and smoothness, from these, for the greatest value."""

        def here(length: int, size: int, kind: Smoothness) -> float:
            s = SIZES[size] * self.unit
            return value(Scatter(s, self.lengths[length], kind) if s > 0.0 else NO_SCATTER)

        best = here(length, size, kind)
        improved = True
        while improved:
            improved = False
            other = Smoothness.ROUGH if kind is Smoothness.SMOOTH else Smoothness.SMOOTH
            for new_length, new_size, new_kind in (
                (length, size + 1, kind),
                (length, size - 1, kind),
                (length + 1, size, kind),
                (length - 1, size, kind),
                (length, size, other),
                # a larger scatter over a greater length shears as much: the likeliest lie along a slanting ridge
                (length + 1, size + 1, kind),
                (length - 1, size - 1, kind),
            ):
                if not (0 <= new_length < len(self.lengths) and 0 <= new_size < len(SIZES)):
                    continue
                if SIZES[new_size] * self.unit > largest_scatter(self.lengths[new_length]):
                    continue
                there = here(new_length, new_size, new_kind)
                if there > best + 1e-9:
                    best, length, size, kind, improved = there, new_length, new_size, new_kind, True
                    break


def largest_scatter(length: float) -> float:
    """Largest scatter, mm, with a correlation length; its shear has a standard deviation of √2·size/length."""
    return min(LARGEST, float(np.radians(TURNING)) * length / float(np.sqrt(2.0)))


def is_noise(chi2: float, values: int) -> bool:
    """Whether a chi-square is what noise alone gives to so many values."""
    return chi2 < values + 3.0 * math.sqrt(2.0 * values)


def square_beside(residual: np.ndarray, slopes: np.ndarray) -> float:
    """Squared length of a whitened residual (m,) after the best step along whitened slopes (m, p)."""
    q = spanned(slopes)
    left = residual - q @ (q.T @ residual)
    return float(left @ left)


def deviations(slopes: np.ndarray) -> np.ndarray:
    """Standard deviations (p,) of parameters with whitened slopes (m, p); infinite where nothing is seen of one."""
    return np.sqrt(np.diag(covariance(slopes)))


def covariance(slopes: np.ndarray) -> np.ndarray:
    """Covariance (p, p) of parameters with whitened slopes (m, p)."""
    size = np.linalg.norm(slopes, axis=0)
    seen = size > 0.0
    scaled = slopes[:, seen] / size[seen]
    out = np.zeros((len(size), len(size)))
    out[np.ix_(seen, seen)] = np.linalg.pinv(scaled.T @ scaled, rcond=1e-12) / np.outer(size[seen], size[seen])
    out[~seen, ~seen] = np.inf
    return out


def spanned(columns: np.ndarray) -> np.ndarray:
    """Orthonormal columns (m, r) that span those given (m, p)."""
    if not columns.size:
        return columns
    scaled = columns / (np.linalg.norm(columns, axis=0) + 1e-300)
    u, size, _ = np.linalg.svd(scaled, full_matrices=False)
    return np.asarray(u[:, size > 1e-8 * size.max(initial=0.0)])


def correlation_lengths(at: np.ndarray) -> tuple[float, ...]:
    """Correlation lengths that points (n, 2) mm can tell: from their spacing to a good part of their patch."""
    from scipy.spatial import cKDTree

    near = np.asarray(cKDTree(at).query(at, k=2)[0])
    spacing = float(np.median(near[:, 1])) or 1.0
    longest = WIDEST * float(np.ptp(at, axis=0).max())
    count = max(int(np.floor(np.log(max(longest / (1.2 * spacing), 1.0)) / np.log(RATIO))), 0)
    return tuple(1.2 * spacing * RATIO**k for k in range(count + 1))
