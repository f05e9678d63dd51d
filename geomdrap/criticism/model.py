"""A model of the ply: the fishnet, laid down somewhere, with some effects; and the search for its parameters."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.criticism.fit import Fit, fit, take_slopes
from geomdrap.criticism.likelihood import square_beside
from geomdrap.effects import make
from geomdrap.errors import GeomdrapError

if TYPE_CHECKING:
    from geomdrap.criticism.experiment import Experiment
    from geomdrap.fishnet import Effect, Parameter

Whiten = Callable[[np.ndarray], np.ndarray]

STEP = 0.1  # of a parameter's typical size: the differences with which slopes are taken
PROBES = (0.3, 1.0, 1.7)  # of the typical size of a one-sided parameter: where the search looks first
SHAPES = (0.1, 0.35, 0.6, 0.85)  # of the range of a parameter that does nothing alone
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
        return np.array([STEP * abs(p.typical - p.neutral) for _, p in self.parameters])

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
            except GeomdrapError:  # such as a seed moved off the part: this place predicts nothing
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


def add_effect(experiment: Experiment, whiten: Whiten, base: Fitted, effect: str) -> Fitted:
    """The base model with one effect more, fitted together with everything in the base."""
    model = base.model.with_effect(effect)
    predict = predictor(experiment, model)
    start = _start(experiment, predict, whiten, base, effect)
    low, high = model.bounds
    # what the base already has keeps its slopes; the fit mends them where they mislead it
    own = slice(len(base.values), None)
    slopes = take_slopes(predict, start, predict(start), model.steps, low, high, np.arange(len(start))[own])
    slopes[:, : len(base.values)] = base.fit.slopes
    return Fitted(model, fit(predict, experiment.measured, whiten, start, model.steps, low, high, slopes))


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
    candidates: list[tuple[float, np.ndarray]] = []
    if len(acting) == len(own) and (len(own) > 1 or own[0].low < own[0].neutral < own[0].high):
        # both signs, a slope at nothing: the linear fit is the start
        slopes = np.column_stack([s / (q.typical - q.neutral) for s, q in zip(alone, own, strict=True)])
        step = np.linalg.lstsq(np.column_stack([shifts, whiten(slopes)]), whiten(residual), rcond=1e-9)[0]
        values = _within(neutral + step[p:], own)
        return np.append(base.values + step[:p], values)
    for values in _probes(own, acting):
        left = whiten(residual - signature(values))
        candidates.append((square_beside(left, shifts), values))
    best = min(candidates, key=lambda c: c[0])[1] if candidates else neutral
    left = whiten(residual - signature(best))
    step = np.linalg.lstsq(shifts, left, rcond=1e-9)[0]
    return np.append(base.values + step, best)


def _probes(own: Sequence[Parameter], acting: Sequence[int]) -> list[np.ndarray]:
    """Combinations of values where the search looks first."""
    each = []
    for k, q in enumerate(own):
        if k not in acting:
            each.append([q.low + f * (q.high - q.low) for f in SHAPES])
        else:
            each.append([_clip(q.neutral + f * (q.typical - q.neutral), q) for f in PROBES])
    return [np.array(values) for values in product(*each)]


def _within(values: np.ndarray, own: Sequence[Parameter]) -> np.ndarray:
    return np.array([_clip(v, q) for v, q in zip(values, own, strict=True)])


def _clip(value: float, q: Parameter) -> float:
    return min(max(float(value), q.low), q.high)


def slopes_at(experiment: Experiment, model: Model, values: np.ndarray) -> np.ndarray:
    """Slopes (m, p) of the model's prediction."""
    predict = predictor(experiment, model)
    low, high = model.bounds
    return take_slopes(predict, values, predict(values), model.steps, low, high)
