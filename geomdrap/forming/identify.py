"""Inverse identification: the parameters of a model that make its curves those of a test.

Levenberg–Marquardt on the logarithms of the parameters, which keeps them positive and makes steps relative. Intervals
and correlations come from the slopes at the solution, under independent readings of one scatter per column.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import FormingError

Array = NDArray[np.float64]
Curves = Mapping[str, Array]
Simulate = Callable[[dict[str, float]], Curves]
"""Parameters by name -> readings by column, at the displacements of the test."""

STEP = 2e-3
"""Change of the logarithm of a parameter from which slopes are taken: well above the noise of an explicit run."""
MIDDLE = 10.0
"""Where the logarithm of a parameter over its start is counted from: the solver's steps are shares of it."""
MOST_RUNS = 40
"""Simulations per parameter after which a fit gives up, and says so."""
CONFOUNDED = 0.95
"""Correlation from which two parameters are not told apart, if one of them is not known well by itself."""
KNOWN = 0.05
"""Relative standard deviation up to which a parameter is known, whatever it is correlated with."""
BLIND = 1e-12
"""Share of the information, from which on down there is none but rounding."""
FLOOR = 0.05
"""Share of the largest reading below which the error of a reading no longer falls with it."""
LOOSE = 0.5
"""Relative standard deviation from which a parameter is not known."""


@dataclass(frozen=True, eq=False)
class Identified:
    """What a fit gave.

    ``names`` (k,) of the parameters; ``values`` (k,); ``sigma`` (k,) standard deviations; ``correlation`` (k, k) of
    their logarithms; ``slopes`` (n, k): by how many standard deviations each reading rises per unit of the
    logarithms; ``scatter`` of the readings by column, as a share of their sizes (see `scales`); ``rms`` of the
    residuals by column, in its unit; ``runs``: simulations made; ``converged``.
    """

    names: tuple[str, ...]
    values: Array
    sigma: Array
    correlation: Array
    slopes: Array
    scatter: dict[str, float]
    rms: dict[str, float]
    runs: int
    converged: bool

    @property
    def interval(self) -> Array:
        """95 % intervals (k, 2), even in the logarithm."""
        spread = np.exp(np.minimum(1.96 * self.sigma / self.values, 700.0))
        return np.stack([self.values / spread, self.values * spread], axis=1)

    @property
    def confounded(self) -> list[tuple[str, str, float]]:
        """Pairs of parameters that these readings do not tell apart, with their correlation."""
        size = len(self.names)
        return [
            (self.names[i], self.names[j], float(self.correlation[i, j]))
            for i in range(size)
            for j in range(i + 1, size)
            if abs(self.correlation[i, j]) > CONFOUNDED
            and max(self.sigma[i] / self.values[i], self.sigma[j] / self.values[j]) > KNOWN
        ]

    @property
    def loose(self) -> list[str]:
        """Parameters that these readings do not show."""
        return [n for n, s, v in zip(self.names, self.sigma, self.values, strict=True) if s > LOOSE * v]


def identify(
    simulate: Simulate,
    measured: Curves,
    start: Mapping[str, float],
    progress: Callable[[int], None] | None = None,
) -> Identified:
    """Fit the parameters ``start`` so that ``simulate`` gives ``measured``: (n,) by column, NaN where not read.

    Residuals are taken over the sizes of the readings (see `scales`), so that forces and angles can be fitted
    together. FormingError where there are fewer readings than parameters, or none that is not zero.
    """
    from scipy.optimize import least_squares

    names, scale = tuple(start), scales(measured)
    begin = np.array(list(start.values()))
    used = {c: np.isfinite(measured[c]) for c in measured}
    if sum(int(u.sum()) for u in used.values()) <= len(names):
        raise FormingError(f"there are too few readings for {len(names)} parameters; fit fewer, or measure more")
    runs = 0

    def values_at(place: Array) -> Array:
        return np.asarray(begin * np.exp(place - MIDDLE))

    def residuals(place: Array) -> Array:
        nonlocal runs
        runs += 1
        if progress:
            progress(runs)
        curves = simulate(dict(zip(names, values_at(place).tolist(), strict=True)))
        out = np.concatenate([((curves[c] - measured[c]) / scale[c])[used[c]] for c in measured])
        return np.where(np.isfinite(out), out, 1e3)  # a run that ended early is far off

    first = np.full(len(names), MIDDLE)
    found = least_squares(
        residuals,
        first,
        method="lm",
        diff_step=0.0 * first + STEP / MIDDLE,
        xtol=1e-5,
        ftol=1e-6,
        max_nfev=MOST_RUNS * len(names),
    )
    counts = [int(used[c].sum()) for c in measured]
    parts = dict(zip(measured, np.split(found.fun, np.cumsum(counts)[:-1]), strict=True))
    rms = {c: float(np.sqrt(np.mean((part * scale[c][used[c]]) ** 2))) for c, part in parts.items()}
    free = 1.0 - len(names) / sum(counts)
    scatter = {c: max(float(np.sqrt(np.mean(part**2) / free)), 1e-12) for c, part in parts.items()}
    weights = np.concatenate([np.full(len(part), 1.0 / scatter[c]) for c, part in parts.items()])
    slopes = found.jac * weights[:, None]
    sigma, correlation = spread_of(slopes)
    values = values_at(found.x)
    return Identified(names, values, values * sigma, correlation, slopes, scatter, rms, runs, bool(found.success))


def scales(readings: Curves) -> dict[str, Array]:
    """The size of each reading by column: a twentieth of the largest there; for a force its own, if that is more.

    Load cells err in proportion to what they read; cameras do not.
    FormingError where a column holds nothing but zeros.
    """
    largest = {c: float(np.nanmax(np.abs(values), initial=0.0)) for c, values in readings.items()}
    empty = [c for c, size in largest.items() if not size > 0.0]
    if empty:
        raise FormingError(f"the column {empty[0]} holds no reading other than 0; leave it out")
    return {
        c: np.maximum(np.abs(values) if c.startswith("force") else 0.0, np.full(len(values), FLOOR * largest[c]))
        for c, values in readings.items()
    }


def spread_of(slopes: Array) -> tuple[Array, Array]:
    """Standard deviations (k,) and correlations (k, k) from slopes (n, k) in standard deviations of the readings.

    What the readings do not show at all has one beyond all bounds.
    """
    information = slopes.T @ slopes
    size = np.sqrt(np.diag(information))
    size[size == 0.0] = 1.0
    values, vectors = np.linalg.eigh(information / np.outer(size, size))
    spread = 1.0 / np.maximum(values, BLIND)
    covariance = (vectors * spread) @ vectors.T / np.outer(size, size)
    sigma = np.sqrt(np.diag(covariance))
    return sigma, covariance / np.outer(sigma, sigma)


def with_more(identified: Identified, slopes: Array) -> Array:
    """Standard deviations (k,) that the parameters would have if a test with these ``slopes`` (n, k) came on top."""
    sigma, _ = spread_of(np.concatenate([identified.slopes, slopes]))
    return identified.values * sigma


def slopes_of(simulate: Simulate, identified: Identified, scatter: float) -> Array:
    """Slopes (n, k) of a further test at the fitted values, if its readings scatter by the share ``scatter``."""
    names, values = identified.names, identified.values
    base = simulate(dict(zip(names, values.tolist(), strict=True)))
    size = scales({c: v for c, v in base.items() if np.nanmax(np.abs(v)) > 0.0})
    columns = []
    for k in range(len(names)):
        moved = values.copy()
        moved[k] *= np.exp(STEP)
        curves = simulate(dict(zip(names, moved.tolist(), strict=True)))
        columns.append(np.concatenate([(curves[c] - base[c]) / (scatter * STEP * size[c]) for c in size]))
    return np.nan_to_num(np.stack(columns, axis=1))
