"""Points that stand out from what is predicted: slips of the instrument, which no model is to explain.

Beside the misfit of a model that lacks an effect some do not stand out; they do once the effect is in the model.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.criticism.experiment import flatten
from geomdrap.measurement.match import match
from geomdrap.measurement.outliers import find_outliers

if TYPE_CHECKING:
    from geomdrap.criticism.experiment import Experiment
    from geomdrap.criticism.model import Fitted
    from geomdrap.measurement.outliers import Outlier

MOST = 1.3  # times what noise leaves
POSITION = ("along", "across", "normal")


def outliers_of(experiment: Experiment, model: Fitted) -> tuple[Outlier, ...]:
    """Points that stand out from a model."""
    net = experiment.draped(model.model.built(model.values), experiment.pitches[1])
    found = match(net, experiment.measurement)
    n = len(experiment.measurement)
    noise = [None if sigma is None else np.full(n, sigma) for sigma in experiment.noise_by_kind()[:2]]
    return find_outliers(net, experiment.measurement, found, *noise)


def spoilt(channels: Sequence[str], shape: tuple[int, ...], outliers: Sequence[Outlier]) -> np.ndarray:
    """Which values (n, c) bool of points and ``channels`` outliers spoil: a position, or all but that."""
    of_position = np.isin(channels, POSITION)
    out = np.zeros(shape, bool)
    for outlier in outliers:
        out[outlier.row] |= of_position if outlier.kind == "position" else ~of_position
    return out


def cleaned(experiment: Experiment, model: Fitted) -> Experiment | None:
    """The experiment without the values that stand out from a model that explains all others.

    None where there are none among those used, or where so much else is left that they may be the model's own doing.
    """
    drop = spoilt(experiment.channels, experiment.mask.shape, outliers_of(experiment, model)) & experiment.mask
    others = ~flatten(drop, experiment.mask)
    left = float(np.nansum((model.fit.residual / experiment.noise)[others] ** 2))
    return experiment.without(drop) if drop.any() and left < MOST * others.sum() else None
