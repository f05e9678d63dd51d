"""A model of the ply: the fishnet, laid down somewhere, with some effects; and the search for its parameters."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.criticism.fit import STEPS, Fit, fit, take_slopes
from geomdrap.criticism.likelihood import square_beside
from geomdrap.effects import make
from geomdrap.errors import GeomdrapError

if TYPE_CHECKING:
    from geomdrap.criticism.experiment import Experiment
    from geomdrap.fishnet import Effect, Parameter

Whiten = Callable[[np.ndarray], np.ndarray]

STEP = 0.1  # of a parameter's typical size: the differences with which slopes are taken
GROWING = (
    0.3,
    1.0,
    3.0,
    8.0,
)  # times the typical size of a parameter that grows from 0: where the search looks first
FALLING = (0.3, 0.6, 0.9, 1.2, 1.5)  # of the way from a parameter's greatest value to its typical one, likewise
SHAPES = (0.05, 0.2, 0.4, 0.6)  # of the range of a parameter that does nothing alone
FEW_STEPS = 7  # of a fit whose every drape is costly
HALVINGS = 3  # of the gaps between probes
SAME = 3.0  # of chi-square: probes this close do equally well
PROMISE, LEAST_PROMISE = 0.02, 4.0  # of the misfit, and of chi-square: less is not worth a fit
HOPELESS = 0.5  # of the way from the best model back to the base
NOTHING = 1e-6  # of the noise: less is no signature


@dataclass(frozen=True)
class Model:
    """The fishnet with a placement and the effects named, in their order; its parameters as one vector."""

    effects: tuple[str, ...]

    @property
    def names(self) -> tuple[str, ...]:
        """Effects with the placement before them."""
        return ("placement", *self.effects)

    @property
    def parameters(self) -> tuple[tuple[str, Parameter], ...]:
        """Every parameter with its effect's name, the placement's three first."""
        return tuple((name, p) for name in self.names for p in make(name).parameters)

    @property
    def neutral(self) -> np.ndarray:
        """Values (p,) at which nothing acts."""
        return np.array([p.neutral for _, p in self.parameters])

    @property
    def steps(self) -> np.ndarray:
        """Differences (p,) with which slopes are taken."""
        return np.array([STEP * (abs(p.typical - p.neutral) or 0.2 * (p.high - p.low)) for _, p in self.parameters])

    @property
    def bounds(self) -> tuple[np.ndarray, np.ndarray]:
        """Least and greatest values (p,)."""
        return np.array([p.low for _, p in self.parameters]), np.array([p.high for _, p in self.parameters])

    def built(self, values: np.ndarray) -> list[Effect]:
        """The effects with these values (p,)."""
        out, k = [], 0
        for name in self.names:
            keys = [p.name for p in make(name).parameters]
            out.append(make(name, **dict(zip(keys, map(float, values[k : k + len(keys)]), strict=True))))
            k += len(keys)
        return out

    def with_effect(self, name: str) -> Model:
        """This model with one effect more."""
        return Model((*self.effects, name))


@dataclass(frozen=True, eq=False)
class Fitted:
    """A model fitted to an experiment: ``values`` (p,), and the fit's ``residual`` and ``slopes``, ``chi2``."""

    model: Model
    fit: Fit

    @property
    def values(self) -> np.ndarray:
        """Values (p,) of the model's parameters."""
        return self.fit.values

    def parameters_of(self, effect: str) -> list[tuple[Parameter, int]]:
        """Parameters of an effect with their numbers in the vector."""
        return [(p, k) for k, (name, p) in enumerate(self.model.parameters) if name == effect]


def predictor(experiment: Experiment, model: Model) -> Callable[[np.ndarray], np.ndarray]:
    """The prediction (m,) as a function of the model's values (p,); NaN where the drape is impossible."""
    kept: dict[bytes, np.ndarray] = {}

    def predict(values: np.ndarray) -> np.ndarray:
        key = values.tobytes()
        if key not in kept:
            try:
                kept[key] = experiment.predict(model.built(values))
            except GeomdrapError as error:  # as for a seed moved off the part: nothing is predicted, and that is said
                experiment.refused[model.names[-1]] = str(error)
                kept[key] = np.full(len(experiment.measured), np.nan)
        return kept[key]

    return predict


def unfitted(experiment: Experiment) -> Fitted:
    """The net as it was meant: nothing fitted."""
    model = Model(())
    residual = experiment.measured - predictor(experiment, model)(model.neutral)
    nothing = np.zeros((len(residual), 0))
    return Fitted(model, Fit(model.neutral, residual, nothing, float(np.nansum((residual / experiment.noise) ** 2))))


def fit_placement(experiment: Experiment, whiten: Whiten, start: np.ndarray | None = None) -> Fitted:
    """The model without effects."""
    model = Model(())
    low, high = model.bounds
    begin = np.zeros(3) if start is None else start
    return Fitted(
        model,
        fit(predictor(experiment, model), experiment.measured, whiten, begin, model.steps, low, high),
    )


def add_effect(experiment: Experiment, whiten: Whiten, base: Fitted, effect: str, least: float = -math.inf) -> Fitted:
    """The base model with one effect more, fitted together with everything in the base.

    ``least`` is the chi-square of the best model known: a costly effect that promises to stay far above it is not
    fitted to the end, and where nothing is left to explain it is tried at its typical size only.
    """
    model = base.model.with_effect(effect)
    predict = predictor(experiment, model)
    if make(effect).costly and is_noise(least, len(experiment.measured)):
        start = np.append(base.values, [p.typical for p in make(effect).parameters])
    else:
        start = _start(experiment, predict, whiten, base, effect)
    low, high = model.bounds
    # what the base already has keeps its slopes; the fit mends them where they mislead it
    own = slice(len(base.values), None)
    slopes = take_slopes(predict, start, predict(start), model.steps, low, high, np.arange(len(start))[own])
    slopes[:, : len(base.values)] = base.fit.slopes
    residual = experiment.measured - predict(start)
    residual = np.where(np.isnan(residual), base.fit.residual, residual)
    enough = least if make(effect).costly else -math.inf
    if not _promises(whiten, base, residual, slopes, enough):
        chi2 = float((whiten(np.nan_to_num(residual)) ** 2).sum())
        if chi2 < base.fit.chi2:
            return Fitted(model, Fit(start, residual, slopes, chi2))
        neutral = np.append(base.values, [p.neutral for p in make(effect).parameters])
        return Fitted(model, Fit(neutral, base.fit.residual, slopes, base.fit.chi2))
    most = FEW_STEPS if make(effect).costly else STEPS
    return Fitted(model, fit(predict, experiment.measured, whiten, start, model.steps, low, high, slopes, most))


def is_noise(chi2: float, values: int) -> bool:
    """Whether a chi-square is what noise alone gives to so many values."""
    return chi2 < values + 3.0 * math.sqrt(2.0 * values)


def _promises(whiten: Whiten, base: Fitted, residual: np.ndarray, slopes: np.ndarray, least: float) -> bool:
    """Whether a fit could gain enough to be worth its drapes, by what its slopes promise.

    Slopes promise too little where the model is curved: HOPELESS is far from the chi-square ``least`` of the best.
    """
    before = square_beside(whiten(np.nan_to_num(base.fit.residual)), whiten(base.fit.slopes))
    after = square_beside(whiten(np.nan_to_num(residual)), whiten(slopes))
    if after - least > HOPELESS * (before - least):
        return False
    return before - after > max(PROMISE * max(before - len(residual), 0.0), LEAST_PROMISE)


def refit(experiment: Experiment, whiten: Whiten, old: Fitted) -> Fitted:
    """A model fitted again, under another noise or without some points, from where it was."""
    model = old.model
    low, high = model.bounds
    predict = predictor(experiment, model)
    return Fitted(model, fit(predict, experiment.measured, whiten, old.values, model.steps, low, high))


def _start(
    experiment: Experiment,
    predict: Callable[[np.ndarray], np.ndarray],
    whiten: Whiten,
    base: Fitted,
    effect: str,
) -> np.ndarray:
    """Values to begin with: the best of a few probes of the new effect."""
    own = make(effect).parameters
    p = len(base.values)
    neutral = np.array([q.neutral for q in own])
    residual = np.nan_to_num(base.fit.residual)
    there = experiment.measured - base.fit.residual
    shifts = whiten(base.fit.slopes)

    def signature(values: np.ndarray) -> np.ndarray:
        return np.nan_to_num(predict(np.append(base.values, values)) - there)

    alone = []
    for k, q in enumerate(own):
        values = neutral.copy()
        values[k] = q.typical
        alone.append(signature(values))
    sizes = [float(np.abs(whiten(s)).max()) for s in alone]
    acting = [k for k in range(len(own)) if sizes[k] > NOTHING]
    if len(acting) == len(own) and (len(own) > 1 or own[0].low < own[0].neutral < own[0].high):
        # both signs, a slope at nothing: the linear fit is the start
        slopes = np.column_stack([s / (q.typical - q.neutral) for s, q in zip(alone, own, strict=True)])
        step = np.linalg.lstsq(np.column_stack([shifts, whiten(slopes)]), whiten(residual), rcond=1e-9)[0]
        values = _within(neutral + step[p:], own)
        return np.append(base.values + step[:p], values)

    def misfit(values: np.ndarray) -> float:
        return square_beside(whiten(residual - signature(values)), shifts)

    if len(own) == 1:
        now = square_beside(whiten(residual), shifts)
        halvings = 1 if make(effect).costly else HALVINGS
        best = np.array([_narrowed(lambda x: misfit(np.array([x])), _probes(own[0]), now, halvings)])
    else:
        best = min(
            (_scaled(shape, own, acting, signature, whiten, residual, shifts) for shape in _shapes(own, acting)),
            key=misfit,
        )
    return _best_place(experiment, predict, whiten, base, best)


def _best_place(
    experiment: Experiment,
    predict: Callable[[np.ndarray], np.ndarray],
    whiten: Whiten,
    base: Fitted,
    best: np.ndarray,
) -> np.ndarray:
    """Values of the base to go with values ``best`` of a new effect: from its own, or from the placement as meant.

    A base without the effect may have gone far astray to make up for it.
    """
    shifts = whiten(base.fit.slopes)
    meant = base.values.copy()
    meant[:3] = 0.0
    starts = []
    for values in (base.values, meant):
        left = whiten(np.nan_to_num(experiment.measured - predict(np.append(values, best))))
        step = np.linalg.lstsq(shifts, left, rcond=1e-9)[0]
        starts.append((square_beside(left, shifts), np.append(values + step, best)))
    return min(starts, key=lambda start: start[0])[1]


def _narrowed(misfit: Callable[[float], float], probes: Sequence[float], now: float, halvings: int) -> float:
    """The best of the probes; where none is better than ``now``, after halving the gaps beside the best.

    Of probes that do equally well the last is taken: an effect that does nothing up to a threshold begins there.
    """
    known = {x: misfit(x) for x in probes}
    for _ in range(halvings):
        least = min(known.values())
        if least < now - SAME:
            break
        best = max(x for x, value in known.items() if value <= least + SAME)
        order = sorted(known)
        k = order.index(best)
        for a, b in ((k, k + 1), (k - 1, k)):
            if a >= 0 and b < len(order):
                middle = 0.5 * (order[a] + order[b])
                known[middle] = misfit(middle)
    return min(known, key=lambda x: known[x])


def _probes(own: Parameter) -> list[float]:
    """Values of a one-sided parameter where the search looks first."""
    factors = GROWING if own.typical > own.neutral else FALLING
    return sorted({_clip(own.neutral + f * (own.typical - own.neutral), own) for f in factors})


def _shapes(own: Sequence[Parameter], acting: Sequence[int]) -> list[np.ndarray]:
    """Values of the parameters that do nothing alone, over their ranges; the others at their typical sizes."""
    each = [[q.typical] if k in acting else [q.low + f * (q.high - q.low) for f in SHAPES] for k, q in enumerate(own)]
    return [np.array(values) for values in product(*each)]


def _scaled(
    shape: np.ndarray,
    own: Sequence[Parameter],
    acting: Sequence[int],
    signature: Callable[[np.ndarray], np.ndarray],
    whiten: Whiten,
    residual: np.ndarray,
    shifts: np.ndarray,
) -> np.ndarray:
    """The values with the acting ones as large as the residual wants them, were their signature linear."""
    column = whiten(signature(shape))
    factor = float(np.linalg.lstsq(np.column_stack([shifts, column]), whiten(residual), rcond=1e-9)[0][-1])
    out = shape.copy()
    for k in acting:
        out[k] = _clip(own[k].neutral + factor * (shape[k] - own[k].neutral), own[k])
    return out


def _within(values: np.ndarray, own: Sequence[Parameter]) -> np.ndarray:
    return np.array([_clip(v, q) for v, q in zip(values, own, strict=True)])


def _clip(value: float, q: Parameter) -> float:
    return min(max(float(value), q.low), q.high)


def slopes_at(experiment: Experiment, model: Model, values: np.ndarray) -> np.ndarray:
    """Slopes (m, p) of the model's prediction."""
    predict = predictor(experiment, model)
    low, high = model.bounds
    return take_slopes(predict, values, predict(values), model.steps, low, high)
