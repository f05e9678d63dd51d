"""How large the noise of a measurement is, and from where that is known."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import MeasurementError
from geomdrap.measurement.local import deviations, robust_sigma
from geomdrap.measurement.outliers import LIMIT, stand_out

if TYPE_CHECKING:
    from geomdrap.measurement.measurement import Measurement

LEAST_REPEATS = 5
"""Degrees of freedom of repeats from which a noise is estimated."""
DISAGREE = 1.5
"""Factor between the noise given and the one that repeats show from which it is worth a warning."""
TOO_LARGE, LEAST_NEIGHBOURS = 3.0, 20
"""Factor between the noise given and what neighbours differ by, from so many points on, that chance does not reach.

Neighbours differ by noise and by structure, so that only a noise that is too large is certain from them."""

DIGITS = 1e-9
"""Of the values: repeats that scatter less are copies."""
ROUNDING = 1e-6
"""Of the residual: neighbour differences below this are rounding, not noise."""

COLUMN, GIVEN, REPEATS = "columns of the table", "given", "replicates"
RESIDUAL = "neighbour differences of the residual"
SHEAR = "noise of the shear over √2"
UNITS = {"sigma_xyz": " mm", "sigma_shear": "°", "sigma_direction": "°"}


@dataclass(frozen=True, eq=False)
class Noise:
    """Standard deviations (n,) of single values, and the source of them; None where it is not known."""

    sigma: np.ndarray | None
    source: str | None

    @property
    def typical(self) -> float | None:
        """Root mean square of the standard deviations."""
        return None if self.sigma is None else float(np.sqrt(np.mean(self.sigma**2)))


def noise_of(
    name: str,
    column: np.ndarray | None,
    given: float | None,
    values: np.ndarray,
    group: np.ndarray | None,
    residual: np.ndarray,
    places: np.ndarray,
    otherwise: tuple[float, str] | None = None,
) -> tuple[Noise, tuple[str, ...]]:
    """Noise of values (n, k), from the first of: column, given, repeats, neighbour differences; and warnings.

    ``name`` is that of the column, and of the option in Python (``sigma_xyz``), for messages.
    ``column`` (n,) may hold NaN, which the next source fills. ``group`` (n,) numbers the repeats of one mark;
    ``residual`` (n, k) with NaN where there is no prediction, at ``places`` (n, 2). ``otherwise`` is a noise and
    its source for where none of these says it. Raises MeasurementError for a given noise that is not above 0.
    """
    require_above_zero(name, given)
    repeats, freedom = pooled(values, group, _ordinary(residual, places))
    if not repeats > DIGITS * float(np.nanmax(np.abs(values), initial=0.0)):
        freedom = 0  # copies of a row are no repeats
    scatter = _scatter(residual, places)
    fallback, source = _fallback(given, repeats, freedom, residual, scatter)
    if fallback is None and otherwise is not None:
        fallback, source = otherwise
    sigma, source = _filled(column, fallback, source, len(values))
    if sigma is None:
        return Noise(None, None), ()
    noise = Noise(sigma, source)
    return noise, _disagreement(name, noise, repeats, freedom) or _too_large(name, noise, scatter)


def noise_of_directions(
    column: np.ndarray | None,
    given: float | None,
    shear: float | None,
    turn: np.ndarray,
    group: np.ndarray | None,
    places: np.ndarray,
) -> tuple[Noise, tuple[str, ...]]:
    """Noise of directions by their turns (n, k), degrees, from the model; sources as in `noise_of`, and warnings.

    Where none of them says it, the noise of the ``shear`` over √2, which is said: shear is the difference of two
    directions. Raises MeasurementError for a noise that is not above 0.
    """
    require_above_zero("sigma_shear", shear)
    otherwise = None if shear is None else (shear / float(np.sqrt(2.0)), SHEAR)
    turn = _unwrapped(turn)
    noise, said = noise_of("sigma_direction", column, given, turn, group, turn, places, otherwise)
    if otherwise is not None and noise.source is not None and noise.source.endswith(SHEAR):
        said = (*said, f"the noise of the directions, {otherwise[0]:.3g}°, is the {SHEAR}: nothing else says it")
    return noise, said


def _unwrapped(turn: np.ndarray) -> np.ndarray:
    """Angles (n, k), degrees, of directions without a head within 90 degrees of their mean, column by column."""
    twice = np.exp(2j * np.radians(turn))
    mean = np.degrees(np.angle(np.nansum(twice, axis=0))) / 2.0
    return np.asarray(mean + 90.0 - (mean + 90.0 - turn) % 180.0)


def require_above_zero(name: str, sigma: float | None) -> None:
    """Raise MeasurementError for a standard deviation, if there is one, that is not above 0."""
    if sigma is not None and not (np.isfinite(sigma) and sigma > 0.0):
        raise MeasurementError(f"{name} is a standard deviation and must be above 0, not {sigma:g}")


def pooled(values: np.ndarray, group: np.ndarray | None, rows: np.ndarray | None = None) -> tuple[float, int]:
    """Standard deviation within groups (n,) of values (n, k), and its degrees of freedom; of some ``rows`` only."""
    if group is None:
        return float("nan"), 0
    known = np.isfinite(values).all(axis=1)
    if rows is not None:
        known &= rows
    values, (_, group) = values[known], np.unique(group[known], return_inverse=True)
    count = np.bincount(group)
    total = sum(_within(values[:, k], group, count) for k in range(values.shape[1]))
    freedom = int(values.shape[1] * (count - 1).sum())
    return (float(np.sqrt(total / freedom)), freedom) if freedom else (float("nan"), 0)


def _within(values: np.ndarray, group: np.ndarray, count: np.ndarray) -> float:
    mean = np.bincount(group, values) / count
    return float(((values - mean[group]) ** 2).sum())


def repeats_of(measurement: Measurement) -> np.ndarray | None:
    """Numbers (n,) of the mark that each row repeats, None where no mark was measured twice."""
    if measurement.u is None or measurement.v is None:
        return None
    labels = np.round(np.column_stack([measurement.u, measurement.v]), 6)
    _, group = np.unique(labels, axis=0, return_inverse=True)
    group = group.ravel()
    return group if len(np.unique(group)) < len(group) else None


def _ordinary(residual: np.ndarray, places: np.ndarray) -> np.ndarray:
    """Rows (n,) bool whose residual (n, k) does not stand out from its neighbours: a slip is no noise of repeats."""
    known = np.isfinite(residual).all(axis=1) & np.isfinite(places).all(axis=1)
    ordinary = np.ones(len(residual), bool)
    if known.any():
        ordinary[known] = stand_out(places[known], residual[known], None)[1] <= LIMIT
    return ordinary


def _scatter(residual: np.ndarray, places: np.ndarray) -> np.ndarray:
    """What each residual (n, k) is off its neighbours by, on the scale of its noise; NaN where that is not known."""
    known = np.isfinite(residual).all(axis=1) & np.isfinite(places).all(axis=1)
    out = np.full(residual.shape, np.nan)
    off, factor = deviations(places[known], residual[known])
    out[known] = off / factor[:, None]
    return out


def _fallback(
    given: float | None, repeats: float, freedom: int, residual: np.ndarray, scatter: np.ndarray
) -> tuple[float | None, str | None]:
    if given is not None:
        return given, GIVEN
    if freedom >= LEAST_REPEATS:
        return repeats, REPEATS
    sigma = robust_sigma(scatter)
    known = np.isfinite(scatter).all(axis=1)
    if not known.any():
        return None, None
    size = float(np.sqrt(np.mean(residual[known] ** 2)))
    return (sigma, RESIDUAL) if sigma > ROUNDING * size else (None, None)


def _filled(
    column: np.ndarray | None, fallback: float | None, source: str | None, n: int
) -> tuple[np.ndarray | None, str | None]:
    """The column with its open cells filled, or the fallback in all rows."""
    if column is None or (np.isnan(column).any() and fallback is None):
        return (None, None) if fallback is None else (np.full(n, fallback), source)
    open_cells = np.isnan(column)
    if open_cells.any() and fallback is not None:
        return np.where(open_cells, fallback, column), f"{COLUMN}, else {source}"
    return column, COLUMN


def _disagreement(name: str, noise: Noise, repeats: float, freedom: int) -> tuple[str, ...]:
    """A warning where repeats scatter otherwise than the noise that was given, beyond chance."""
    from scipy.special import chdtr, chdtrc

    said = noise.typical
    if freedom < LEAST_REPEATS or said is None or noise.source == REPEATS:
        return ()
    ratio = repeats / said
    p = 2.0 * min(chdtr(freedom, freedom * ratio**2), chdtrc(freedom, freedom * ratio**2))
    if p > 1e-3 or 1.0 / DISAGREE < ratio < DISAGREE:
        return ()
    word = "more" if ratio > 1.0 else "less"
    return (
        f"the replicates scatter by {repeats:.3g}, {word} than the noise of {said:.3g} that is given for {name}: "
        "check which of the two is right",
    )


def _too_large(name: str, noise: Noise, scatter: np.ndarray) -> tuple[str, ...]:
    """A warning where neighbours (n, k) differ by far less than the noise that was given."""
    said, source = noise.typical, noise.source or ""
    if noise.sigma is None or said is None or not source.startswith((GIVEN, COLUMN)):
        return ()
    share = robust_sigma(scatter / noise.sigma[:, None])
    if np.isfinite(scatter).all(axis=1).sum() < LEAST_NEIGHBOURS or not share * TOO_LARGE < 1.0:
        return ()
    unit = UNITS.get(name, "")
    where, what = f"--{name.replace('_', '-')} or {name} of the set-up", "leave it out"
    if source.startswith(COLUMN):
        where, what = f"the column {name}", "take the column out"
    return (
        f"the noise of {said:.3g}{unit} that is given ({where}) is far too large: neighbouring points differ by "
        f"noise of {share * said:.2g}{unit} at most; with it little can be found missing: correct it, or {what}, "
        "and the noise is read from the data",
    )
