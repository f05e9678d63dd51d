"""A model of the ply: the fishnet, laid down somewhere, with some effects; and the search for its parameters."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.criticism.fit import FIRST_STEPS, LOOSE, STEPS, Fit, fit, take_slopes
from geomdrap.criticism.likelihood import is_noise, square_beside
from geomdrap.criticism.start import LEAST_GAIN, TURNS, Glance, as_meant, glance, is_astray, start_values
from geomdrap.effects import make
from geomdrap.errors import GeomdrapError, PluginError

if TYPE_CHECKING:
    from geomdrap.criticism.experiment import Experiment
    from geomdrap.fishnet import Effect, Parameter

Whiten = Callable[[np.ndarray], np.ndarray]

STEP = 0.1  # of a parameter's typical size: the differences with which slopes are taken
NEAR = 0.2  # of these: where slopes are taken to first order
LEAST = 0.01  # of its typical size: the least value of what acts at once
FEW_STEPS = 7  # of a fit whose every drape is costly
CREEP = 2e-3  # of its chi-square, likewise: steps that gain less do not make it another one
PROMISE, LEAST_PROMISE = 0.02, 4.0  # of the misfit, and of chi-square: less is not worth a fit
SURELY = 0.5  # of that promise: what rough slopes foresee less of is not worth finer ones
NEARLY = 0.02  # of the misfit: a model that leaves less, and little beside the noise, has explained nearly all of it
HOPELESS = 0.5  # of the way from the best model back to the base
HALF, MOSTLY = 0.5, 0.1  # of the misfit: what the best model leaves of it
NO_RIVAL = 0.85, 0.35  # the same, of a look in these: true effects left up to a fifth, with a threshold a half
FAR_ASTRAY = (5.0, 5.0, 5.0)  # mm, mm, degrees: no careful lay-up is as far off
FAR = 0.1  # the same, where the best model leaves next to nothing and a few values were probed


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
        """Least and greatest values (p,); at the least ones of what acts at once it still acts."""
        low = [
            q.neutral + LEAST * (q.typical - q.neutral) if make(name).acts_at_once and q.low == q.neutral else q.low
            for name, q in self.parameters
        ]
        return np.array(low), np.array([q.high for _, q in self.parameters])

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
class Look:
    """An effect on top of a base, before it is fitted.

    ``predict`` remembers what it has predicted; ``seen`` is what one look showed, None for an effect that takes no
    time.
    """

    effect: str
    model: Model
    predict: Predictor
    seen: Glance | None = None


@dataclass(frozen=True, eq=False)
class Fitted:
    """A model fitted to an experiment: ``values`` (p,), and the fit's ``residual`` and ``slopes``, ``chi2``.

    ``doubt`` (p,): standard deviations that the pitch of the net or the facets of the part add to the values; None
    where that was not measured.
    ``looked_at_only``: the last effect was only looked at, and promised too little for more.
    """

    model: Model
    fit: Fit
    doubt: np.ndarray | None = None
    looked_at_only: bool = False

    @property
    def values(self) -> np.ndarray:
        """Values (p,) of the model's parameters."""
        return self.fit.values

    def only(self, rows: np.ndarray, noise: np.ndarray) -> Fitted:
        """The model compared with some values (m,) bool only, of which ``noise`` (k,) are the deviations."""
        residual = self.fit.residual[rows]
        chi2 = float(np.nansum((residual / noise) ** 2))
        return replace(self, fit=Fit(self.values, residual, self.fit.slopes[rows], chi2))

    def parameters_of(self, effect: str) -> list[tuple[Parameter, int]]:
        """Parameters of an effect with their numbers in the vector."""
        return [(p, k) for k, (name, p) in enumerate(self.model.parameters) if name == effect]


class Predictor:
    """The prediction (m,) as a function of a model's values (p,), remembered; NaN where the drape is impossible."""

    def __init__(self, experiment: Experiment, model: Model) -> None:
        self.experiment, self.model = experiment, model
        self.kept: dict[bytes, np.ndarray] = {}

    def __call__(self, values: np.ndarray) -> np.ndarray:
        """The prediction at values (p,)."""
        key = values.tobytes()
        if key not in self.kept:
            try:
                self.kept[key] = self.experiment.predict(self.model.built(values))
            except PluginError:
                raise
            except GeomdrapError as error:  # as for a seed moved off the part: nothing is predicted, and it is said
                self.experiment.refused[self.model.names[-1]] = str(error)
                self.kept[key] = np.full(len(self.experiment.measured), np.nan)
        return self.kept[key]

    def beside(self, values: np.ndarray, step: np.ndarray) -> np.ndarray | None:
        """What a step (p,) from values (p,) changes to first order, None where that takes predictions."""
        try:
            change = self.experiment.beside(*(self.model.built(v) for v in (values, values + NEAR * step)))
        except PluginError:
            raise
        except GeomdrapError:  # the prediction says why
            return None
        return None if change is None else change / NEAR


def unfitted(experiment: Experiment) -> Fitted:
    """The net as it was meant: nothing fitted."""
    model = Model(())
    residual = experiment.measured - Predictor(experiment, model)(model.neutral)
    nothing = np.zeros((len(residual), 0))
    return Fitted(model, Fit(model.neutral, residual, nothing, float(np.nansum((residual / experiment.noise) ** 2))))


def fit_placement(experiment: Experiment, whiten: Whiten) -> Fitted:
    """The model without effects."""
    model = Model(())
    predict = Predictor(experiment, model)
    way = model.neutral, model.steps, *model.bounds
    return Fitted(model, fit(predict, experiment.measured, whiten, *way, small=LOOSE))


def look_at(experiment: Experiment, whiten: Whiten, likely: Whiten, base: Fitted, effect: str) -> Look:
    """Look at an effect on top of the base, if its drapes take long.

    ``whiten`` divides by the noise; ``likely`` whitens with the likeliest scatter of the base.
    """
    model = base.model.with_effect(effect)
    predict = Predictor(experiment, model)
    return Look(
        effect, model, predict, glance(experiment, predict, whiten, likely, base, effect) if slow(effect) else None
    )


def slow(effect: str) -> bool:
    """Whether a drape with an effect takes long."""
    kind = make(effect)
    return kind.slow or kind.costly or kind.stage == "surface"


def relaxes(effect: str) -> bool:
    """Whether nets with an effect are of least energy."""
    kind = make(effect)
    return kind.costly and kind.stage == "fabric"


def add_effect(
    experiment: Experiment,
    whiten: Whiten,
    base: Fitted,
    look: Look,
    least: float = -math.inf,
    turns: Sequence[float] = TURNS,
) -> Fitted:
    """The base model with one effect more, fitted together with everything in the base.

    ``least`` is the chi-square of the best model known: an effect that takes long and promises to stay far above it,
    or to explain nothing beside the likeliest scatter, is not fitted to the end. ``turns``, degrees, are headings at
    which a net that turns as a whole is looked for.
    """
    kind, seen, values = make(look.effect), look.seen, len(experiment.measured)
    explained = seen is not None and is_noise(least, values)
    nearly = explained or least - values < min(NEARLY * (base.fit.chi2 - values), 2.0 * values)
    if seen is not None:
        left = (least - values) / max(base.fit.chi2 - values, 1e-300)
        too_far = NO_RIVAL[nearly or left < MOSTLY]
        given_up = (nearly or left < HALF) and _hopeless(whiten, base, seen.after, least, too_far)
        if given_up or seen.gain < LEAST_GAIN:
            return _not_fitted(look.model, base, seen)
    begun = _begun(experiment, whiten, base, look, turns)
    known, far = least if kind.costly or explained else -math.inf, FAR if nearly else HOPELESS
    if not _promises(whiten, base, begun.fit.residual, begun.fit.slopes, known, far):
        if begun.fit.chi2 < base.fit.chi2:
            return begun
        neutral = np.append(base.values, [p.neutral for p in kind.parameters])
        return replace(begun, fit=replace(base.fit, values=neutral, slopes=begun.fit.slopes))
    # slopes may mislead a first step or two; what is still far off then stays so
    enough = least + far * (base.fit.chi2 - least) if seen is not None else math.inf
    return _fitted_from(experiment, whiten, base, look, begun, enough)


def _begun(experiment: Experiment, whiten: Whiten, base: Fitted, look: Look, turns: Sequence[float]) -> Fitted:
    """Where a fit of an effect on top of the base begins, and the slopes there.

    What the base already has keeps its slopes; the fit mends them where they mislead it.
    """
    model, predict = look.model, look.predict
    begun = start_values(experiment, predict, whiten, base, look.effect, look.seen, turns)
    if begun.slopes is not None:
        both = np.hstack([base.fit.slopes, begun.slopes])
        if not _promises(whiten, base, base.fit.residual, both, -math.inf, HOPELESS, SURELY):
            neutral = np.array([p.neutral for p in make(look.effect).parameters])
            return Fitted(model, replace(base.fit, values=np.append(base.values, neutral), slopes=both))
    start = begun.values
    own = np.arange(len(base.values), len(start))
    slopes = take_slopes(predict, start, predict(start), model.steps, *model.bounds, own, predict.beside)
    slopes[:, : len(base.values)] = base.fit.slopes
    residual = experiment.measured - predict(start)
    residual = np.where(np.isnan(residual), base.fit.residual, residual)
    return Fitted(model, Fit(start, residual, slopes, float((whiten(np.nan_to_num(residual)) ** 2).sum())))


def _fitted_from(
    experiment: Experiment, whiten: Whiten, base: Fitted, look: Look, begun: Fitted, enough: float
) -> Fitted:
    """A model with an effect more than the base, fitted from where it has ``begun`` if it comes below ``enough``."""
    model, predict, kind = look.model, look.predict, make(look.effect)
    most, patience, small = STEPS, FIRST_STEPS, LOOSE
    if kind.costly:
        most, patience, small = FEW_STEPS, 2 * FIRST_STEPS, CREEP * len(experiment.measured)
    way = begun.values, model.steps, *model.bounds, begun.fit.slopes, most, enough, patience, small
    found = fit(predict, experiment.measured, whiten, *way, beside=predict.beside)
    if is_astray(base, FAR_ASTRAY) and not kind.costly:
        # without positions another valley of the placement, centimetres away, may have taken the effect's place
        there = np.append(as_meant(base), found.values[len(base.values) :])
        again = fit(predict, experiment.measured, whiten, there, model.steps, *model.bounds, small=LOOSE)
        found = again if _is_better(whiten, again, found) else found
    return Fitted(model, found)


def _is_better(whiten: Whiten, one: Fit, other: Fit) -> bool:
    """Whether a fit is closer to all that another predicts; what it does not predict itself speaks against it."""
    both = np.isfinite(one.residual) & np.isfinite(other.residual)
    squares = [float((whiten(np.where(both, f.residual, 0.0)) ** 2).sum()) for f in (one, other)]
    return both.sum() == np.isfinite(other.residual).sum() and squares[0] < squares[1]


def _not_fitted(model: Model, base: Fitted, seen: Glance) -> Fitted:
    """The base with an effect that does nothing, and the slopes that one look at it shows."""
    own = [p for name, p in model.parameters if name == model.effects[-1]]
    neutral = np.array([p.neutral for p in own])
    away = seen.values - neutral
    slopes = np.column_stack([seen.signature / a if a else np.zeros(len(seen.signature)) for a in away])
    fit = Fit(np.append(base.values, neutral), base.fit.residual, np.hstack([base.fit.slopes, slopes]), base.fit.chi2)
    return Fitted(model, fit, looked_at_only=True)


def _promises(
    whiten: Whiten,
    base: Fitted,
    residual: np.ndarray,
    slopes: np.ndarray,
    least: float,
    far: float,
    part: float = 1.0,
) -> bool:
    """Whether a fit could gain enough to be worth its drapes, by what its slopes promise.

    Slopes promise too little where the model is curved: only what is ``far`` from the chi-square ``least`` of the
    best is given up. ``part`` of what is asked for may do.
    """
    before = square_beside(whiten(np.nan_to_num(base.fit.residual)), whiten(base.fit.slopes))
    after = square_beside(whiten(np.nan_to_num(residual)), whiten(slopes))
    if _hopeless(whiten, base, after, least, far):
        return False
    return before - after > part * max(PROMISE * max(before - len(residual), 0.0), LEAST_PROMISE)


def _hopeless(whiten: Whiten, base: Fitted, after: float, least: float, far: float) -> bool:
    """Whether a chi-square that slopes foresee stays above the best by a share ``far`` of the way to the base."""
    before = square_beside(whiten(np.nan_to_num(base.fit.residual)), whiten(base.fit.slopes))
    return after - least > far * (before - least)
