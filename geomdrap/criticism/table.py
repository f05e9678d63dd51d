"""The numbers of a diagnosis: errors of models, values with intervals, and a row for every effect tried."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from geomdrap.criticism.diagnosis import Tried, Value
from geomdrap.criticism.evidence import FAMILY, Evidence
from geomdrap.criticism.experiment import Experiment
from geomdrap.criticism.holdout import blocks_of, held_out_error
from geomdrap.criticism.likelihood import Scatter, deviations
from geomdrap.criticism.model import Fitted
from geomdrap.criticism.search import Round, judge_of
from geomdrap.criticism.signature import ALIKE, beside_base, least_visible, look_alike

POSITION = ("along", "across", "normal")


def errors_of(experiment: Experiment, model: Fitted) -> tuple[float, float, float | None, float | None]:
    """Error and held-out error over the noise, rms of the positions (mm, as vectors) and of the shear (degrees)."""
    rows = np.isfinite(model.fit.residual)
    residual, noise = model.fit.residual[rows], experiment.noise[rows]
    block = blocks_of(experiment.at)[experiment.point_of()[rows]]
    error = float(np.sqrt(np.mean((residual / noise) ** 2)))
    slopes = model.fit.slopes[rows]
    if model.looked_at_only:  # it does nothing in the model, whatever a look has shown
        slopes = slopes[:, : -len(model.parameters_of(model.model.effects[-1]))]
    held_out = held_out_error(residual, slopes, noise, block)
    channel = np.array(experiment.channels)[experiment.channel_of()[rows]]
    place = np.isin(channel, POSITION)
    count = len(np.unique(channel[place]))
    rms_position = float(np.sqrt(count * np.mean(residual[place] ** 2))) if place.any() else None
    shear = channel == "shear"
    return error, held_out, rms_position, float(np.sqrt(np.mean(residual[shear] ** 2))) if shear.any() else None


def values_of(experiment: Experiment, model: Fitted, scatter: Scatter, effect: str) -> tuple[Value, ...]:
    """Fitted parameters of an effect with their standard deviations.

    Infinite ones where nothing was fitted, or where the 95 % interval is wider than all values that there can be.
    """
    rows = np.isfinite(model.fit.residual)
    sigma = deviations(judge_of(experiment, rows).whiten(scatter)(model.fit.slopes[rows]))
    if model.doubt is not None:
        sigma = np.hypot(sigma, model.doubt)
    own = model.parameters_of(effect)
    nothing = model.looked_at_only and effect == model.model.effects[-1]
    seen = [not nothing and 2.0 * 1.96 * sigma[k] < p.high - p.low for p, k in own]
    return tuple(
        Value(p.name, float(model.values[k]), float(sigma[k]) if known else np.inf, p.unit)
        for (p, k), known in zip(own, seen, strict=True)
    )


def tried_of(
    experiment: Experiment,
    rounds: Sequence[Round],
    names: Sequence[str],
    final: Fitted,
    scatter: Scatter,
    ends: Mapping[str, Fitted],
) -> tuple[Tried, ...]:
    """Every effect, the likeliest first; those of the final model, and rivals (``ends``), with their final values."""
    found = rounds[max(len(names) - 1, 0)]
    last = rounds[-1] if rounds[-1].base.model.effects == tuple(names) else found
    rows = []
    for k, name in enumerate(names):
        rows.append(_row(experiment, rounds[k], name, final, scatter, scatter, True))
    others = [t.model.effects[-1] for t in last.trials if t.model.effects[-1] not in names]
    others.sort(key=lambda name: -_evidence(last, name).gain)
    for name in others:
        of = found if name in ends else last
        trial, own = of.trial(name)
        rows.append(_row(experiment, of, name, ends.get(name, trial), own, scatter, False))
    return tuple(rows)


def _evidence(of: Round, name: str) -> Evidence:
    return next(e for e in of.evidence if e.name == name)


def _row(
    experiment: Experiment, of: Round, name: str, model: Fitted, scatter: Scatter, final: Scatter, selected: bool
) -> Tried:
    values = values_of(experiment, model, scatter, name)
    _, held_out, rms_position, rms_shear = errors_of(experiment, model)
    return Tried(
        name=name,
        values=values,
        evidence=_evidence(of, name),
        rms_position=rms_position,
        rms_shear=rms_shear,
        cv_error=held_out,
        confounded_with=_confounded(of, name, final),
        visible=_visible(experiment, of, name, final),
        selected=selected,
        looked_at_only=model.looked_at_only,
    )


def _confounded(of: Round, name: str, scatter: Scatter) -> tuple[str, ...]:
    names = [t.model.effects[-1] for t in of.trials]
    signatures = [beside_base(of.judge, scatter, of.rows, of.base, t) for t in of.trials]
    alike = look_alike(signatures)[names.index(name)]
    return tuple(n for n, cosine in zip(names, alike, strict=True) if n != name and cosine > ALIKE)


def _visible(
    experiment: Experiment, of: Round, name: str, scatter: Scatter
) -> tuple[tuple[str, float | None, str], ...]:
    trial = of.trial(name)[0]
    signature = beside_base(of.judge, scatter, of.rows, of.base, trial)
    sizes = least_visible(signature, len(of.trials), FAMILY)
    out: list[tuple[str, float | None, str]] = []
    for (p, _), size in zip(trial.parameters_of(name), sizes, strict=True):
        room = max(p.high - p.neutral, p.neutral - p.low)
        # a threshold of the shear does nothing above the largest
        least = p.neutral - experiment.top_shear if p.unit == "deg" and p.neutral == p.high else 0.0
        amount = max(float(size), least)
        out.append((p.name, amount if amount < room else None, p.unit))
    return tuple(out)
