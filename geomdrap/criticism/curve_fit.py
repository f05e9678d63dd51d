"""Fit effects to a measured curve, and hold a part of it out to see which foretells it."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import product

import numpy as np

from geomdrap.criticism.curve import Array, Curve, CurveEffect
from geomdrap.errors import MeasurementError


@dataclass(frozen=True)
class CurveFit:
    """An effect fitted to a curve.

    ``values`` (k,) fitted to all points and ``rms`` deg of them; ``held_values`` fitted to the first part alone and
    ``held_rms`` deg over the rest; ``plausible``: both within the physical range; ``autocorrelation`` of successive
    errors; ``criterion``: Bayesian information criterion of errors that follow each other so (see ``ar1_criterion``).
    """

    effect: CurveEffect
    values: Array
    rms: float
    held_values: Array
    held_rms: float
    plausible: bool
    autocorrelation: float
    criterion: float


def fit_curve(effect: CurveEffect, curve: Curve, split: float) -> CurveFit:
    """Fit ``effect`` to all of ``curve``, and to the points up to ``split`` mm to predict the others.

    MeasurementError where the split leaves too few points on a side.
    """
    check_split(effect, curve, split)
    first = curve.displacement <= split
    values, held = least_squares_fit(effect, curve), least_squares_fit(effect, curve.part(first))
    errors = residuals(effect, values, curve)
    rho, criterion = ar1_criterion(errors, len(values))
    rest = residuals(effect, held, curve.part(~first))
    plausible = in_range(effect, values) and in_range(effect, held)
    return CurveFit(effect, values, _rms(errors), held, _rms(rest), plausible, rho, criterion)


def check_split(effect: CurveEffect, curve: Curve, split: float) -> None:
    """MeasurementError where a split at ``split`` mm leaves too few points to fit ``effect``, or none to foretell."""
    first = curve.displacement <= split
    if np.count_nonzero(first) <= len(effect.parameters) or np.all(first):
        raise MeasurementError(
            f"the split at {split:g} mm leaves {np.count_nonzero(first)} of {len(first)} points of the series "
            f"'{curve.series}' to fit {effect.name}; choose another split"
        )


def least_squares_fit(effect: CurveEffect, curve: Curve) -> Array:
    """Least squares from every start of the effect: the lowest minimum in the physical range, else the lowest of all.

    Curves with an onset have several minima, some of them with an onset that no cloth has.
    """
    from scipy.optimize import least_squares

    if not effect.parameters:
        return np.zeros(0)
    minima = []

    def errors(values: Array) -> Array:
        return residuals(effect, values, curve)

    for start in product(*(p.starts for p in effect.parameters)):
        found = least_squares(errors, start, x_scale=np.abs(start), xtol=1e-12, ftol=1e-12)
        minima.append((not in_range(effect, found.x), float(found.cost), found.x))
    return np.asarray(min(minima, key=lambda one: one[:2])[2], dtype=np.float64)


def residuals(effect: CurveEffect, values: Array, curve: Curve) -> Array:
    """Measured less modelled shear (n,) deg."""
    return curve.shear - effect.model(curve.displacement, values, curve.length)


def in_range(effect: CurveEffect, values: Array) -> bool:
    """Whether all ``values`` are physically plausible."""
    return all(p.low <= value <= p.high for p, value in zip(effect.parameters, values, strict=True))


def ar1_criterion(errors: Array, parameters: int) -> tuple[float, float]:
    """Autocorrelation ρ of the errors (n,), and the information criterion −2 ln L + (k + 2) ln n with it.

    L: exact Gaussian likelihood of a first-order autoregression, e_i = ρ e_{i−1} + innovation, maximal over ρ and
    the variance; an independent-error criterion takes a smooth misfit for dozens of independent facts.
    """
    from scipy.optimize import minimize_scalar

    n = len(errors)

    def deviance(rho: float) -> float:
        start = (1.0 - rho**2) * errors[0] ** 2
        variance = (start + np.sum((errors[1:] - rho * errors[:-1]) ** 2)) / n
        return float(n * np.log(2.0 * np.pi * max(variance, np.finfo(float).tiny)) + n - np.log(1.0 - rho**2))

    found = minimize_scalar(deviance, bounds=(-0.999, 0.999), method="bounded", options={"xatol": 1e-6})
    return float(found.x), float(found.fun + (parameters + 2) * np.log(n))


def _rms(errors: Array) -> float:
    return float(np.sqrt(np.mean(errors**2)))
