"""Fitting a model's parameters to measured values: Gauss-Newton with few predictions.

A prediction is a drape, tens of milliseconds, or a relaxed net, a second; the algebra is nothing. So the slopes are
taken once, by differences, and from then on corrected from each step's own result (C. G. Broyden, 1965).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

Predict = Callable[[np.ndarray], np.ndarray]
Beside = Callable[[np.ndarray, np.ndarray], np.ndarray | None]

STEPS = 12  # most accepted or refused steps
FIRST_STEPS = 3  # after which a fit must have come below a chi-square that is asked of it
SMALL, LOOSE = 0.05, 1.0  # of chi-square: a step that promises or gains less ends a fit, one that is fitted on later
LEAST_STEP = 1e-3  # of a parameter's own step, in every parameter: less ends the fit, too
FARTHEST = 100.0  # of a parameter's own step: no further at once, since slopes tell nothing of what is far
RAGGED = 1.0  # of chi-square: where a step along fresh slopes promises no more and fails, facets decide
UNSEEN = 5e-3  # noises, over all values together: a parameter whose own step changes less stays where it is


@dataclass(frozen=True, eq=False)
class Fit:
    """A fitted model: ``values`` (p,), ``residual`` (m,) measured less predicted, ``slopes`` (m, p), ``chi2``.

    ``chi2`` is over the noise that the fit was given; ``residual`` is NaN where the model could not predict.
    """

    values: np.ndarray
    residual: np.ndarray
    slopes: np.ndarray
    chi2: float


def fit(
    predict: Predict,
    measured: np.ndarray,
    whiten: Callable[[np.ndarray], np.ndarray],
    start: np.ndarray,
    steps: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
    slopes: np.ndarray | None = None,
    most: int = STEPS,
    enough: float = math.inf,
    patience: int = 2 * FIRST_STEPS,
    small: float = SMALL,
    beside: Beside = lambda at, step: None,
    lasting: int = 0,
    are_fresh: bool = False,
) -> Fit:
    """Parameters (p,) between ``low`` and ``high`` with the least squares of ``whiten(measured - predict(p))``.

    ``predict`` gives (m,) values, NaN where it has none; those count as if they had kept their last residual.
    ``steps`` (p,) are the differences with which slopes are taken, where ``slopes`` (m, p) are not given; given ones
    that ``are_fresh`` were taken at the start. At most ``most`` steps are tried; a fit that is above a chi-square of
    ``enough`` ``FIRST_STEPS`` after the start, or after slopes were taken anew, but at the latest after ``patience``
    steps, is given up.
    A step that promises or gains less than ``small`` of chi-square ends it, in units of what the model leaves of each
    value where that is more than noise: it then counts as noise. ``beside`` as of ``take_slopes``.
    If any are ``lasting``, slopes of the parameters after the first so many are taken anew at the start.
    """
    values = np.clip(np.asarray(start, dtype=float), low, high)
    residual = measured - predict(values)
    lost = np.isnan(residual)
    filled = np.where(lost, 0.0, residual)
    jacobian = np.zeros((len(residual), len(values))) if slopes is None else slopes.copy()
    free = np.flatnonzero(high > low)  # the others keep the slopes that they have
    if slopes is None or lasting:
        new = free[free >= lasting]
        jacobian[:, new] = take_slopes(predict, values, predict(values), steps, low, high, new, beside)[:, new]
    chi2 = _square(whiten(filled))
    damping = 0.0
    fresh, good = slopes is None or are_fresh, jacobian
    first = FIRST_STEPS
    for tried in range(most):
        if tried >= first and chi2 > enough:
            break
        seen = whiten(jacobian)
        # as a locking angle that no shear reaches: its slope is rounding, and would send it to the end of its range
        moves = np.linalg.norm(seen, axis=0) * steps > UNSEEN
        step = _step(seen, whiten(filled), damping, values, low, high, moves)
        share = min(1.0, FARTHEST / max(float(np.abs(step / steps).max()), 1e-300))
        step *= share
        foreseen = chi2 - _square(whiten(filled - jacobian @ step))
        unit = max(1.0, chi2 / len(measured)) if share == 1.0 else 1.0  # of a step cut short not all is known
        if (np.abs(step) <= LEAST_STEP * steps).all() or foreseen < small * unit:
            break
        there = predict(values + step)
        new = measured - there
        new = np.where(np.isnan(new), filled, new)
        new_chi2 = _square(whiten(new))
        # Broyden's correction: what the step really changed, less what the slopes foretold
        scaled = step / steps
        jacobian = jacobian + np.outer((filled - new - jacobian @ step) / (scaled @ scaled), scaled / steps)
        gain = chi2 - new_chi2
        if gain > 0.0:
            values, filled, chi2, damping = values + step, new, new_chi2, 0.0
            lost = np.isnan(there)
            fresh, good = False, jacobian
            if gain < small * unit:
                break
        elif not fresh:  # the slopes are worn: take them anew, once for each place
            jacobian[:, free] = take_slopes(predict, values, predict(values), steps, low, high, free, beside)[:, free]
            fresh, first, good = True, min(max(first, tried + 1 + FIRST_STEPS), patience), jacobian
        else:
            jacobian = good  # what a refused step has shown, beyond a threshold it may be, is no slope here
            damping = max(4.0 * damping, 0.3)
            if foreseen < RAGGED * unit or damping > 100.0:
                break
    return Fit(values, np.where(lost, np.nan, filled), jacobian, _square(whiten(np.where(lost, 0.0, filled))))


def take_slopes(
    predict: Predict,
    at: np.ndarray,
    there: np.ndarray,
    steps: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
    only: np.ndarray | None = None,
    beside: Beside = lambda at, step: None,
) -> np.ndarray:
    """Slopes (m, p) by differences away from the nearer bound; 0 where one side cannot be predicted.

    ``only`` (k,) are the parameters whose slopes are taken; the others stay 0. ``beside`` says what a step (p,)
    changes to first order (m,), where that takes less than a prediction; None where it does not.
    """
    out = np.zeros((len(there), len(at)))
    for k in range(len(at)) if only is None else only:
        step = np.zeros(len(at))
        up, down = min(steps[k], high[k] - at[k]), min(steps[k], at[k] - low[k])
        step[k] = up if up >= min(steps[k], down) else -down
        if step[k] == 0.0:
            continue
        change = beside(at, step)
        out[:, k] = np.nan_to_num((predict(at + step) - there if change is None else change) / step[k])
    return out


def _square(vector: np.ndarray) -> float:
    return float(vector @ vector)


def _step(
    slopes: np.ndarray,
    residual: np.ndarray,
    damping: float,
    values: np.ndarray,
    low: np.ndarray,
    high: np.ndarray,
    moves: np.ndarray,
) -> np.ndarray:
    """Damped least-squares step (p,) of the parameters that move (p,).

    Those that would leave their bounds go to them and the rest is solved again.
    """
    p = len(values)
    step = np.zeros(p)
    free = moves.copy()
    for _ in range(int(moves.sum())):
        left = residual - slopes[:, ~free] @ step[~free]
        a = slopes[:, free]
        scale = np.sqrt((a * a).sum(axis=0)) + 1e-300
        stacked = np.vstack([a / scale, np.sqrt(damping) * np.eye(a.shape[1])])
        step[free] = np.linalg.lstsq(stacked, np.append(left, np.zeros(a.shape[1])), rcond=1e-9)[0] / scale
        wanted = values + step
        outside = free & ((wanted < low) | (wanted > high))
        if not outside.any():
            break
        step[outside] = np.clip(wanted[outside], low[outside], high[outside]) - values[outside]
        free &= ~outside
        if not free.any():
            break
    return step
