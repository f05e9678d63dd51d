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
MANY = 1000  # values: of fewer, what a model leaves is no measure of what it may still gain
KEPT = 0.5  # of what a step has promised: its slopes hold
LEAST_DAMPING, MOST_DAMPING = 0.03, 100.0  # of slopes: none, and where a fit stands still
EASED = 0.3  # of the damping after a step that gains: along a bent valley the next one would fail again without it
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
    value where that is more than noise: it then counts as noise. That is believed of slopes that are fresh, or by
    which the last step kept its promise. ``beside`` as of ``take_slopes``.
    If any are ``lasting``, slopes of the parameters after the first so many are taken anew at the start.
    """
    problem = _Problem(predict, measured, whiten, steps, low, high, beside)
    way = _Way(problem, np.clip(np.asarray(start, dtype=float), low, high), slopes, are_fresh)
    if slopes is None or lasting:
        way.take_slopes(lasting)
    first = FIRST_STEPS
    for tried in range(most):
        if tried >= first and way.chi2 > enough:
            break
        step, foreseen, is_whole = way.step()
        # what is left beside a step that was cut short tells nothing of the model
        unit = max(1.0, way.chi2 / max(len(measured), MANY)) if is_whole else 1.0
        nothing = (np.abs(step) <= LEAST_STEP * steps).all()
        if nothing or (foreseen < small * unit and way.is_trusted):
            break
        gain = way.go(step, foreseen) if foreseen >= small * unit else 0.0
        if gain > 0.0 and (gain >= small * unit or way.is_trusted):
            if gain < small * unit:
                break
        elif not way.is_fresh:  # the slopes are worn: take them anew, once for each place
            way.take_slopes()
            first = min(max(first, tried + 1 + FIRST_STEPS), patience)
        else:
            way.hold_back()
            if foreseen < RAGGED * unit or way.damping > MOST_DAMPING:
                break
    return way.end()


@dataclass(frozen=True, eq=False)
class _Problem:
    """What a fit asks and what bounds it, as of ``fit``."""

    predict: Predict
    measured: np.ndarray
    whiten: Callable[[np.ndarray], np.ndarray]
    steps: np.ndarray
    low: np.ndarray
    high: np.ndarray
    beside: Beside


class _Way:
    """Where a fit has come to: values (p,), residual (m,), slopes (m, p), and how far the slopes are trusted.

    ``good`` are the slopes with which it came here, ``lost`` (m,) what the model does not predict here. Slopes are
    trusted where they are fresh, or as given, or the last step gained what they promised, for the most part.
    """

    def __init__(self, problem: _Problem, values: np.ndarray, slopes: np.ndarray | None, are_fresh: bool) -> None:
        self.problem, self.values = problem, values
        residual = problem.measured - problem.predict(values)
        self.lost = np.isnan(residual)
        self.residual = np.where(self.lost, 0.0, residual)
        self.chi2 = _square(problem.whiten(self.residual))
        self.slopes = np.zeros((len(residual), len(values))) if slopes is None else slopes.copy()
        self.good, self.is_fresh, self.is_trusted, self.damping = self.slopes, are_fresh, True, 0.0

    def take_slopes(self, lasting: int = 0) -> None:
        """Take the slopes of the parameters after the first so many anew; what cannot move keeps its own."""
        p, values = self.problem, self.values
        free = np.flatnonzero(p.high > p.low)
        new = free[free >= lasting]
        taken = take_slopes(p.predict, values, p.predict(values), p.steps, p.low, p.high, new, p.beside)
        self.slopes[:, new] = taken[:, new]
        self.good, self.is_fresh, self.is_trusted = self.slopes, self.is_fresh or lasting == 0, True

    def step(self) -> tuple[np.ndarray, float, bool]:
        """The next step (p,), what it promises of chi-square, and whether it is whole."""
        p = self.problem
        seen = p.whiten(self.slopes)
        # as a locking angle that no shear reaches: its slope is rounding, and would send it to the end of its range
        moves = np.linalg.norm(seen, axis=0) * p.steps > UNSEEN
        step = _step(seen, p.whiten(self.residual), self.damping, self.values, p.low, p.high, moves)
        share = min(1.0, FARTHEST / max(float(np.abs(step / p.steps).max()), 1e-300))
        step *= share
        foreseen = self.chi2 - _square(p.whiten(self.residual - self.slopes @ step))
        return step, foreseen, share == 1.0 and self.damping == 0.0

    def go(self, step: np.ndarray, foreseen: float) -> float:
        """Take a step (p,), if it gains anything, and correct the slopes by it. What it gains of chi-square."""
        p = self.problem
        there = p.predict(self.values + step)
        new = p.measured - there
        new = np.where(np.isnan(new), self.residual, new)
        new_chi2 = _square(p.whiten(new))
        # Broyden's correction: what the step really changed, less what the slopes foretold
        scaled = step / p.steps
        off = self.residual - new - self.slopes @ step
        self.slopes = self.slopes + np.outer(off / (scaled @ scaled), scaled / p.steps)
        gain = self.chi2 - new_chi2
        if gain > 0.0:
            self.values, self.residual, self.chi2 = self.values + step, new, new_chi2
            self.damping = EASED * self.damping if EASED * self.damping > LEAST_DAMPING else 0.0
            self.lost = np.isnan(there)
            self.good, self.is_fresh, self.is_trusted = self.slopes, False, gain > KEPT * foreseen
        return gain

    def hold_back(self) -> None:
        """Shorten what comes. What a refused step has shown, beyond a threshold it may be, is no slope here."""
        self.slopes = self.good
        self.damping = max(4.0 * self.damping, 0.3)

    def end(self) -> Fit:
        """The fit, as if it ended here."""
        left = np.where(self.lost, 0.0, self.residual)
        residual = np.where(self.lost, np.nan, self.residual)
        return Fit(self.values, residual, self.slopes, _square(self.problem.whiten(left)))


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
