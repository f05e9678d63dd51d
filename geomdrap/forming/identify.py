"""Inverse identification: the parameters of a model that make its curves those of a test.

Levenberg–Marquardt on the logarithms of the parameters, which keeps them positive and makes steps relative. Intervals
and correlations come from the slopes at the solution, under independent readings of one scatter per column.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import FormingError

Array = NDArray[np.float64]
Curves = Mapping[str, Array]
Simulate = Callable[[dict[str, float]], Curves]
"""Parameters by name -> readings by column, at the displacements of the test."""

STEP = 5e-3
"""Change of the logarithm of a parameter from which slopes are taken.

Where masses and steps are held (see `held`), slopes of a 45° strip are then within 0.4 % of central differences over
0.04, within 0.2 % at 0.001, and within 1.3 % at 0.02. Not less, since yarns that are all but straight (undulation
1e-5) turn taut at once, and shake: at 0.001 that adds 10 % to the slopes of their modulus.
"""
MIDDLE = 10.0
"""Where the logarithm of a parameter over its start is counted from: the solver's steps are shares of it."""
FIRST = 0.1
"""Share of `MIDDLE` that the first step may be long, in a norm of all parameters: about a factor of e."""
ENOUGH = 1e-4
"""A fit ends where a step would lower its cost by less than this share: with 50 readings below a tenth of sigma."""
MOST_RUNS = 40
"""Simulations per parameter, those for slopes among them, after which a fit gives up, and says so."""
CONFOUNDED = 0.9
"""Correlation from which two parameters are not told apart, if one of them is not known well by itself."""
KNOWN = 0.05
"""Relative standard deviation up to which a parameter is known, whatever it is correlated with."""
BLIND = 1e-12
"""Share of the information, from which on down there is none but rounding."""
FLOOR = 0.01
"""Share of the largest force below which the error of a force no longer falls with it.

With a twentieth most readings of a 45° strip, whose forces span two decades, would count for little, and the scatter
of the others would be underrated.
"""
CAMERA = 0.05
"""Share of the largest shear that every reading of shear counts as, since its error does not depend on it."""
LOOSE = 0.5
"""Relative standard deviation from which a parameter is not known."""


@dataclass(frozen=True, eq=False)
class Identified:
    """What a fit gave.

    ``names`` (k,) of the parameters; ``values`` (k,); ``sigma`` (k,) standard deviations; ``correlation`` (k, k) of
    their logarithms; ``slopes`` (n, k): by how many standard deviations each reading rises per unit of the
    logarithms; ``scatter`` of the readings by column, as a share of their sizes (see `scales`); ``rms`` of the
    residuals by column, in its unit; ``curves`` (n,) by column at the values; ``runs``: simulations made, those for
    slopes among them; ``converged``; ``resized``: how often the simulation was made anew for stiffer values (see
    `ResizedError`).
    """

    names: tuple[str, ...]
    values: Array
    sigma: Array
    correlation: Array
    slopes: Array
    scatter: dict[str, float]
    rms: dict[str, float]
    curves: Curves
    runs: int
    converged: bool
    resized: int = 0

    @property
    def interval(self) -> Array:
        """95 % intervals (k, 2), even in the logarithm."""
        spread = np.exp(np.minimum(1.96 * self.sigma / self.values, 700.0))
        return np.stack([self.values / spread, self.values * spread], axis=1)

    @property
    def named(self) -> dict[str, float]:
        """The values by name."""
        return dict(zip(self.names, self.values.tolist(), strict=True))

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


class ResizedError(Exception):
    """A simulation is not what it was: it took sizes for values that it could not run before.

    Its curves jump a little by that, so that a fit forgets them, and starts over from the best values that it had.
    """


def identify(
    simulate: Simulate,
    measured: Curves,
    start: Mapping[str, float],
    progress: Callable[[int], None] | None = None,
    enough: float = ENOUGH,
) -> Identified:
    """Fit the parameters ``start`` so that ``simulate`` gives ``measured``: (n,) by column, NaN where not read.

    Residuals are taken over the sizes of the readings (see `scales`), so that forces and angles can be fitted
    together. After `MOST_RUNS` simulations per parameter, those for slopes among them, the fit stops at the best
    values so far, not ``converged``; it ends where a step would lower the cost by less than the share ``enough``.
    FormingError where there are fewer readings than parameters, or none that is not
    zero, or where the simulation at the values that were found lacks a reading.
    """
    names, size = tuple(start), check_enough(measured, tuple(start))
    used = {c: np.isfinite(measured[c]) for c in measured}
    search = _Search(simulate, measured, start, size, used, progress, enough)
    place, converged = search.run()
    curves = search.curves(place)
    _check_complete(curves, used)
    errors = {c: (curves[c] - measured[c])[used[c]] for c in measured}
    rms = {c: float(np.sqrt(np.mean(e**2))) for c, e in errors.items()}
    shares = {c: e / size[c][used[c]] for c, e in errors.items()}
    free = 1.0 - len(names) / sum(len(e) for e in errors.values())
    scatter = {c: max(float(np.sqrt(np.mean(e**2) / free)), 1e-12) for c, e in shares.items()}
    weights = np.concatenate([np.full(len(e), 1.0 / scatter[c]) for c, e in shares.items()])
    slopes = search.slopes(place) * weights[:, None]
    sigma, correlation = spread_of(slopes)
    values = search.values(place)
    return Identified(
        names, values, values * sigma, correlation, slopes, scatter, rms, curves, search.runs, converged,
        search.resized,
    )  # fmt: skip


def check_enough(measured: Curves, names: tuple[str, ...]) -> dict[str, Array]:
    """The sizes of the readings (see `scales`); FormingError where there are too few of them for ``names``."""
    if sum(int(np.isfinite(v).sum()) for v in measured.values()) <= len(names):
        raise FormingError(f"there are too few readings for {len(names)} parameters; fit fewer, or measure more")
    return scales(measured)


class _SpentError(Exception):
    """All simulations that a fit may make are made."""


class _Search:
    """What a fit has tried: each place is simulated once, and counted."""

    def __init__(
        self,
        simulate: Simulate,
        measured: Curves,
        start: Mapping[str, float],
        size: Curves,
        used: Mapping[str, NDArray[np.bool_]],
        progress: Callable[[int], None] | None,
        enough: float,
    ):
        self.enough = enough
        self.simulate, self.measured, self.size, self.used, self.progress = simulate, measured, size, used, progress
        self.names, self.begin = tuple(start), np.array(list(start.values()))
        self.most: float = 0
        self.runs, self.resized = 0, 0
        self._place = np.full(len(self.names), MIDDLE)
        self._seen: dict[bytes, Curves] = {}

    def run(self) -> tuple[Array, bool]:
        """The place that was found, with its slopes among what was seen, and whether the search came to an end."""
        while True:
            try:
                self.most = (MOST_RUNS - 1) * len(self.names) - 1  # the rest is for the slopes at the end
                place, ended = self._descend()
                self.most = math.inf
                self.slopes(place)
                return place, ended
            except ResizedError:
                self._place = self.best()
                self.resized += 1
                self._seen.clear()

    def _descend(self) -> tuple[Array, bool]:
        from scipy.optimize import leastsq

        try:
            found = leastsq(
                self.residuals, self._place, Dfun=self.slopes, full_output=True, xtol=1e-5, ftol=self.enough,
                factor=FIRST,
            )  # fmt: skip
            return np.asarray(found[0]), found[-1] in (1, 2, 3, 4)
        except _SpentError:
            return self.best(), False

    def values(self, place: Array) -> Array:
        return np.asarray(self.begin * np.exp(place - MIDDLE))

    def curves(self, place: Array) -> Curves:
        key = place.tobytes()
        if key not in self._seen:
            if self.runs >= self.most:
                raise _SpentError
            self._seen[key] = self.simulate(dict(zip(self.names, self.values(place).tolist(), strict=True)))
            self.runs += 1
            if self.progress:
                self.progress(self.runs)
        return self._seen[key]

    def residuals(self, place: Array) -> Array:
        curves = self.curves(place)
        parts = [((curves[c] - self.measured[c]) / self.size[c])[self.used[c]] for c in self.measured]
        out = np.concatenate(parts)
        return np.where(np.isfinite(out), out, 1e3)  # a run that ended early is far off

    def slopes(self, place: Array) -> Array:
        base = self.residuals(place)
        moved = [self.residuals(place + STEP * row) for row in np.eye(len(place))]
        return np.stack([(up - base) / STEP for up in moved], axis=1)

    def best(self) -> Array:
        places = [np.frombuffer(key) for key in self._seen] or [self._place]
        return min(places, key=lambda place: float(np.sum(self.residuals(place) ** 2)))


def _check_complete(curves: Curves, used: Mapping[str, NDArray[np.bool_]]) -> None:
    for column, chosen in used.items():
        missing = np.flatnonzero(chosen & ~np.isfinite(curves[column]))
        if len(missing):
            listed = ", ".join(str(n + 1) for n in missing[:5]) + (", …" if len(missing) > 5 else "")
            raise FormingError(
                f"the simulation at the best values found ends before the {column} of reading {listed}; start the "
                "fit elsewhere, or leave those readings out"
            )


def scales(readings: Curves) -> dict[str, Array]:
    """The size of each reading by column: a force's own, or `FLOOR` of the largest if more; for shear `CAMERA` of it.

    Load cells err in proportion to what they read; cameras do not.
    FormingError where a column holds nothing but zeros.
    """
    largest = {c: float(np.nanmax(np.abs(values), initial=0.0)) for c, values in readings.items()}
    empty = [c for c, size in largest.items() if not size > 0.0]
    if empty:
        raise FormingError(f"the column {empty[0]} holds no reading other than 0; leave it out")
    return {
        c: np.maximum(np.abs(values), FLOOR * largest[c])
        if c.startswith("force")
        else np.full(len(values), CAMERA * largest[c])
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
