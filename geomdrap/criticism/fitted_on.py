"""Fitted models fitted on: further, under another noise, without some values, on finer nets; and their doubts."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.criticism.fit import LOOSE, Fit, fit
from geomdrap.criticism.likelihood import is_noise
from geomdrap.criticism.model import CREEP, NEARLY, Fitted, Model, Predictor, Whiten, relaxes
from geomdrap.criticism.smooth import note_on
from geomdrap.effects import make

if TYPE_CHECKING:
    from geomdrap.criticism.experiment import Experiment

REFINEMENTS = 5  # steps on a finer net
LAST_STEPS, PASSES = 3, 3  # of a fit that ends where it nearly was, and how often it may find that it did not
MORE_STEPS = 18  # of a costly fit, if it is the best
LESS, FEW = 3.0, 3  # times less than was found is tried, in a few steps
MOSTLY = 0.9  # of the values: a net that predicts fewer is not compared with another


def further(experiment: Experiment, whiten: Whiten, old: Fitted) -> Fitted:
    """A costly model fitted on, if it leaves more than noise.

    It may still have been on its way: heading and stiffness make up for each other along a bent valley.
    """
    model = old.model
    idle = old.looked_at_only or not make(model.effects[-1]).costly
    if idle or is_noise(old.fit.chi2, len(old.fit.residual)):
        return old
    way = old.values, model.steps, *model.bounds, old.fit.slopes, MORE_STEPS
    predict, small = Predictor(experiment, model), CREEP * len(old.fit.residual)
    found = fit(predict, experiment.measured, whiten, *way, small=small, beside=predict.beside)
    return Fitted(model, found) if found.chi2 < old.fit.chi2 else old


def refit(experiment: Experiment, whiten: Whiten, old: Fitted) -> Fitted:
    """A model fitted again, under another noise or without some points, from where it was and with its slopes."""
    model = old.model
    predict = Predictor(experiment, model)
    way = old.values, model.steps, *model.bounds, old.fit.slopes
    fitted = fit(predict, experiment.measured, whiten, *way, small=LOOSE, beside=predict.beside)
    return Fitted(model, fitted)


def settled(experiment: Experiment, whiten: Whiten, old: Fitted) -> Fitted:
    """A model that is not costly, fitted on under another noise, its slopes by central differences.

    Those of a fit are corrected as it goes; these are of where its last steps began, which short steps do not
    correct. After long ones they are taken again, ``PASSES`` times at most.
    """
    model, predict = old.model, Predictor(experiment, old.model)
    for _ in range(PASSES):
        slopes, before = _central_slopes(predict, old), old.values
        way = before, model.steps, *model.bounds, slopes, LAST_STEPS
        found = fit(predict, experiment.measured, whiten, *way, are_fresh=True)
        old = Fitted(model, replace(found, slopes=slopes))
        if (np.abs(found.values - before) <= model.steps).all():
            break
    return old


def _central_slopes(predict: Predictor, at: Fitted) -> np.ndarray:
    """Slopes (m, p) by central differences; those that it has where a value could not be predicted."""
    slopes, (low, high) = at.fit.slopes.copy(), at.model.bounds
    for k, step in enumerate(at.model.steps):
        ends = [at.values.copy(), at.values.copy()]
        ends[0][k] = max(at.values[k] - step, low[k])
        ends[1][k] = min(at.values[k] + step, high[k])
        change = (predict(ends[1]) - predict(ends[0])) / (ends[1][k] - ends[0][k])
        slopes[:, k] = np.where(np.isfinite(change), change, slopes[:, k])
    return slopes


def refined(coarser: Experiment, finer: Experiment, whiten: Whiten, old: Fitted) -> tuple[Experiment, Fitted]:
    """A costly model fitted on from where it was, on the finer nets of ``finer``; and the experiment with its nets.

    Nets are of second order in the pitch: of what a pitch ``ratio`` times smaller changed in the values,
    1/(ratio² - 1) is left, a third where it was halved. Where no step was taken, nothing is known of it.
    """
    model = old.model
    predict = Predictor(finer, model)
    relaxed = any(map(relaxes, model.effects))
    # slopes of the coarser ones, or worn ones, would hide how heading and stiffness make up for each other
    slopes, lasting = (None, 0) if relaxed else (old.fit.slopes, len(Model(()).neutral))
    way = model.steps, *model.bounds, slopes, REFINEMENTS
    found = fit(predict, finer.measured, whiten, old.values, *way, beside=predict.beside, lasting=lasting)
    less = _from_less(model, predict, finer.measured, whiten, found)
    if less.chi2 < found.chi2:
        found = fit(predict, finer.measured, whiten, less.values, *way, beside=predict.beside)
    if relaxed:  # nets taken along keep the cells that they were laid with
        finer = finer.draping_anew()
        predict, way = Predictor(finer, model), (model.steps, *model.bounds, found.slopes, LAST_STEPS)
        found = fit(predict, finer.measured, whiten, found.values, *way, beside=predict.beside)
    ratio, moved = coarser.pitches[1] / finer.pitches[1], np.abs(found.values - old.values)
    return finer, Fitted(model, found, moved / (ratio**2 - 1.0) if ratio > 1.0 and moved.any() else None)


def _from_less(model: Model, predict: Predictor, measured: np.ndarray, whiten: Whiten, found: Fit) -> Fit:
    """The ply placed anew with less of what acts at once, where a fit with that leaves more than noise.

    The softer a net, the more it turns: coarse nets leave stiffness too large, along a valley that no slope shows.
    """
    kind = make(model.effects[-1])
    if not kind.acts_at_once or kind.includes or is_noise(found.chi2, len(measured)):
        return found
    start, (low, high) = found.values.copy(), model.bounds
    own = slice(-len(kind.parameters), None)
    start[own] = np.maximum(start[own] / LESS, low[own])
    low[own] = high[own] = start[own]
    return fit(predict, measured, whiten, start, model.steps, low, high, found.slopes, FEW, beside=predict.beside)


def again(experiment: Experiment, whiten: Whiten, base: Fitted, known: Sequence[Fitted]) -> list[Fitted]:
    """Models with one effect more than the base that were fitted before some values were dropped.

    Only those near the best are fitted again: the others predict what they did.
    """
    least = min((t.fit.chi2 for t in known), default=base.fit.chi2)
    out = []
    for trial in known:
        better = trial.fit.chi2 < base.fit.chi2 and not trial.looked_at_only
        if better and trial.fit.chi2 - least <= NEARLY * (base.fit.chi2 - least):
            out.append(refit(experiment, whiten, trial))
        elif better:
            out.append(trial)
        else:
            own = slice(len(base.values), None)
            values = np.append(base.values, trial.model.neutral[own])
            slopes = np.hstack([base.fit.slopes, trial.fit.slopes[:, own]])
            out.append(replace(trial, fit=Fit(values, base.fit.residual, slopes, base.fit.chi2)))
    return out


def doubted_for_facets(experiment: Experiment, model: Fitted) -> Fitted:
    """The model with what the facets of the part leave in doubt of its values, beside other doubts that it has.

    Chords are of second order: what is left after every facet was split in four and rounded is a third of what that
    changed. Nothing is known of it where facets are not rounded, or a net on them does not predict what was measured.
    """
    return model if note_on(experiment.surface) else _doubted(experiment, model, experiment.unsmoothed(), 1.0 / 3.0)


def doubted_for_pitch(experiment: Experiment, model: Fitted) -> Fitted:
    """The model with what the pitch leaves in doubt of its values, where no relaxed net comes in.

    Nets are of second order: what half the pitch changes is three quarters of that. A weft side that grows with the
    shear of its cell grows with that of a cell of some size.
    """
    return _doubted(experiment, model, experiment.of_half_pitch(), 4.0 / 3.0)


def _doubted(experiment: Experiment, model: Fitted, other: Experiment, share: float) -> Fitted:
    """The model with a share of what another experiment's prediction changes in its values, were that measured."""
    here, there = (Predictor(e, model.model)(model.values) for e in (experiment, other))
    known = np.isfinite(here - there)
    if known.mean() < MOSTLY:
        return model
    slopes = (model.fit.slopes / experiment.noise[:, None])[known]
    norm = np.linalg.norm(slopes, axis=0) + 1e-300
    change = ((here - there) / experiment.noise)[known]
    doubt = share * np.abs(np.linalg.lstsq(slopes / norm, change, rcond=1e-9)[0] / norm)
    return replace(model, doubt=doubt if model.doubt is None else np.hypot(model.doubt, doubt))
