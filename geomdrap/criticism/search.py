"""The search for missing effects: each tried on top of a base model, and what speaks for it."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from geomdrap.criticism.evidence import Evidence, among_all, chance
from geomdrap.criticism.experiment import Experiment
from geomdrap.criticism.fitted_on import again, further
from geomdrap.criticism.holdout import blocks_of, held_out_error
from geomdrap.criticism.kept import kept
from geomdrap.criticism.likelihood import Judge, Residuals, Scatter, deviations
from geomdrap.criticism.model import Fitted, Look, Whiten, add_effect, look_at, slow
from geomdrap.criticism.start import TURNS
from geomdrap.effects import make

CLEAR = 3.0  # standard deviations from nothing
TURN = 2  # of the parameters: the heading
JUDGES = 2  # kept: each some 100 MB at 400 points
CLIMB = 3  # models for which the likeliest scatter is searched: the base and the best two


@dataclass(frozen=True, eq=False)
class Round:
    """One round of the search: a base model, every effect tried on top of it, and the evidence.

    ``failed`` names effects that could not be tried on this part. ``rows`` (m,) bool are the values that all models
    predict; ``judge`` knows their noise. ``scatter`` holds the likeliest lay-up scatter of the base and of every
    trial, ``cv_base`` the base's held-out error. ``ends``: those told apart on finer nets, the best first, fitted to
    the end, each with its experiment; None before that.
    """

    base: Fitted
    trials: tuple[Fitted, ...]
    evidence: tuple[Evidence, ...]
    scatter: tuple[Scatter, ...]
    rows: np.ndarray
    judge: Judge
    cv_base: float
    failed: tuple[str, ...]
    ends: Mapping[str, tuple[Experiment, Fitted]] | None = None

    @property
    def closest(self) -> Fitted:
        """The model with the least chi-square, whether it is believed or not."""
        models = (self.base, *self.trials)
        return models[int(np.argmin(_squares(models, self.rows, self.judge.noise)))]

    @property
    def left(self) -> Scatter:
        """The scatter of the closest model: no more of it is in the ply, whatever other models call scatter."""
        return self.scatter[(self.base, *self.trials).index(self.closest)]

    def trial(self, effect: str) -> tuple[Fitted, Scatter]:
        """The trial of an effect and its scatter."""
        k = [t.model.effects[-1] for t in self.trials].index(effect)
        return self.trials[k], self.scatter[k + 1]


def _squares(models: Sequence[Fitted], rows: np.ndarray, noise: np.ndarray) -> np.ndarray:
    """Chi-squares (k,) of models on the ``rows`` (m,) bool that all of them predict, of which this is the noise."""
    return np.array([float(((m.fit.residual[rows] / noise) ** 2).sum()) for m in models])


def try_effects(
    experiment: Experiment,
    base: Fitted,
    whiten: Whiten,
    names: Sequence[str],
    done: Callable[[str], None],
    known: Sequence[Fitted] = (),
) -> Round:
    """Fit every effect on top of the base, and weigh what speaks for it. ``done`` is told each name.

    ``known`` are models with one effect more than the base that were fitted before some values were dropped.
    """
    trials, failed = again(experiment, whiten, base, known), []
    least = min([base.fit.chi2, *(t.fit.chi2 for t in trials)])
    names = [name for name in names if name not in [t.model.effects[-1] for t in trials]]
    turns: Sequence[float] = TURNS
    near, likely = _likely(experiment, base)
    for look in _looks(experiment, base, (whiten, likely), names, done):
        done(look.effect)
        trial = add_effect(experiment, whiten, base, look, least, turns)
        if not _predicts(trial):
            failed.append(look.effect)
            continue
        trials.append(trial)
        kind, noise = make(look.effect), len(trial.fit.residual)
        if kind.costly and kind.acts_at_once and trial.fit.chi2 - noise < 0.5 * (least - noise):
            turns = (float(trial.values[TURN]),)  # where one net has turned to, another will have
        least = min(least, trial.fit.chi2)
    if trials:
        first = int(np.argmin([t.fit.chi2 for t in trials]))
        if trials[first].fit.chi2 < base.fit.chi2:
            trials[first] = further(experiment, whiten, trials[first])
    models = [base, *trials]
    rows = np.all([np.isfinite(m.fit.residual) for m in models], axis=0)
    judge = judge_of(experiment, rows)
    linear = [Residuals(np.nan_to_num(m.fit.residual[rows]), m.fit.slopes[rows]) for m in models]
    white = _squares(models, rows, judge.noise)
    order = [0, *(1 + np.argsort(white[1:], kind="stable"))][:CLIMB]
    scatter, likelihood = judge.best_scatter(linear, order, near)
    block = blocks_of(experiment.at)[experiment.point_of()[rows]]
    errors = [held_out_error(r.residual, r.slopes, judge.noise, block) for r in linear]
    # shares are of the misfit above noise and the scatter that the closest model leaves: others call more scatter
    left = scatter[int(white.argmin())]
    squares = [judge.square(left, r) for r in linear]
    floor = float(rows.sum())
    spreads = [deviations(judge.whiten(s)(r.slopes)) for s, r in zip(scatter[1:], linear[1:], strict=True)]
    evidence = _weigh(models, likelihood, squares, errors, spreads, floor)
    return Round(base, tuple(trials), evidence, tuple(scatter), rows, judge, errors[0], tuple(failed))


def _looks(
    experiment: Experiment,
    base: Fitted,
    whiten: tuple[Whiten, Whiten],
    names: Sequence[str],
    done: Callable[[str], None],
) -> Iterator[Look]:
    """Effects in the order in which they are tried: slow ones last, when it is known what they have to match.

    Of these the one that a first look favours comes first; it may spare the others their fits. ``whiten`` by the
    noise, and with the likeliest scatter of the base.
    """
    slow_ones = [name for name in names if slow(name)]
    yield from (look_at(experiment, *whiten, base, name) for name in names if name not in slow_ones)
    seen = []
    for name in slow_ones:
        done(name)
        seen.append(look_at(experiment, *whiten, base, name))
    yield from sorted(seen, key=lambda look: look.seen.after)  # type: ignore[union-attr]


def steps_of(names: Sequence[str]) -> int:
    """How often ``try_effects`` tells a name."""
    return len(names) + sum(slow(name) for name in names)


def _likely(experiment: Experiment, base: Fitted) -> tuple[Scatter, Whiten]:
    """The likeliest scatter of the base, and whitening (of what the base predicts) by it."""
    rows = np.isfinite(base.fit.residual)
    judge = judge_of(experiment, rows)
    scatter = judge.best_scatter([Residuals(base.fit.residual[rows], base.fit.slopes[rows])], [0])[0][0]
    whiten = judge.whiten(scatter)
    return scatter, lambda a: whiten(a[rows])


def _predicts(model: Fitted) -> bool:
    """Whether a model has predictions for most values; one that has not cannot be compared."""
    return bool(np.isfinite(model.fit.residual).mean() > 0.7)


def judge_of(experiment: Experiment, rows: np.ndarray) -> Judge:
    """The judge of those values (m,) bool of an experiment."""

    def make() -> Judge:
        mask = np.zeros_like(experiment.mask)
        mask.T[experiment.mask.T] = rows
        return Judge(experiment.at, experiment.channels, mask, experiment.noise[rows], unit_of(experiment))

    return kept(experiment.judges, rows.tobytes(), make, JUDGES)


def unit_of(experiment: Experiment) -> float:
    """A length, mm, in which scatter is counted: the noise of positions, or what their turns mean over 20 mm."""
    positions = [c for c, name in enumerate(experiment.channels) if name in ("along", "across", "normal")]
    own = np.isin(experiment.channel_of(), positions)
    if "along" in experiment.channels and own.any():
        return float(np.median(experiment.noise[own]))
    return float(np.radians(np.median(experiment.noise[~own])) * 20.0) if (~own).any() else 0.1


def _weigh(
    models: Sequence[Fitted],
    likelihood: np.ndarray,
    squares: Sequence[float],
    errors: Sequence[float],
    spreads: Sequence[np.ndarray],
    floor: float,
) -> tuple[Evidence, ...]:
    """Evidence for every model after the first, which is the base."""
    base = models[0]
    gains = [2.0 * float(value - likelihood[0]) for value in likelihood[1:]]
    unknowns = [len(m.values) - len(base.values) + _shapes(m) for m in models[1:]]
    p_values = [chance(g, k) for g, k in zip(gains, unknowns, strict=True)]
    family = among_all(p_values)
    known = {name for model in models for name in model.model.effects}
    includes = [tuple(n for n in make(m.model.effects[-1]).includes if n in known) for m in models[1:]]
    misfit = max(squares[0] - floor, CLEAR * float(np.sqrt(2.0 * floor)))  # at least what noise may hide
    out = []
    for k, model in enumerate(models[1:]):
        out.append(
            Evidence(
                name=model.model.effects[-1],
                gain=gains[k],
                unknowns=unknowns[k],
                p_value=p_values[k],
                p_family=float(family[k]),
                share=0.0 if _does_nothing(model) else min((squares[0] - squares[k + 1]) / misfit, 1.0),
                cv_ratio=errors[k + 1] / errors[0],
                in_range=_in_range(model, spreads[k], includes[k]),
                includes=includes[k],
            )
        )
    return tuple(out)


def _does_nothing(model: Fitted) -> bool:
    """Whether the last effect was fitted, and to values at which it is absent: what its slopes promise cannot be."""
    own = model.parameters_of(model.model.effects[-1])
    return not model.looked_at_only and all(model.values[k] == p.neutral for p, k in own)


def _shapes(model: Fitted) -> int:
    """Unknowns more than parameters: a value that is searched over a range is worth about two."""
    own = model.parameters_of(model.model.effects[-1])
    return sum(1 for p, _ in own if p.neutral in (p.low, p.high))


def _in_range(model: Fitted, sigma: np.ndarray, includes: Sequence[str]) -> bool:
    """Whether the last effect certainly acts, and no value lies at a bound that is not its neutral one.

    ``sigma`` (p,): standard deviations of the model's values; ``includes``: effects tried, or in the base, that it
    comes to at small values.
    """
    own = model.parameters_of(model.model.effects[-1])
    values = [(p, float(model.values[k])) for p, k in own]
    kind = make(model.model.effects[-1])
    at_bound = [v in (p.low, p.high) and v != p.neutral and not _natural(p, v) for p, v in values]
    if kind.acts_at_once and not includes:  # else its smallest values are another effect's doing
        acts = any(v != p.neutral for p, v in values)
    else:
        acts = any(abs(v - p.neutral) > CLEAR * sigma[k] for (p, v), (_, k) in zip(values, own, strict=True))
    return not any(at_bound) and acts


def _natural(parameter: object, value: float) -> bool:
    """Whether a bound is a value that can be, such as a share of 1 or an onset of 0."""
    return value in (0.0, 1.0)
