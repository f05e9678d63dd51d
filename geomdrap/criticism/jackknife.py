"""How much the values of a model move from one part of the ply to the next: intervals that do not trust the scatter.

Standard deviations from a covariance are as good as that is. Left-out blocks of the fabric tell how the values really
vary; where that is more, the interval is as wide.

Source: the delete-a-group jackknife, J. W. Tukey, Ann. Math. Statist. 29 (1958), p. 614.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geomdrap.criticism.experiment import Experiment
from geomdrap.criticism.holdout import blocks_of
from geomdrap.criticism.likelihood import Scatter, deviations
from geomdrap.criticism.model import Fitted
from geomdrap.criticism.search import judge_of


def widened(experiment: Experiment, model: Fitted, scatter: Scatter) -> Fitted:
    """The model with a doubt that makes its standard deviations those of the jackknife where these are larger."""
    rows = np.isfinite(model.fit.residual)
    sigma = deviations(judge_of(experiment, rows).whiten(scatter)(model.fit.slopes[rows]))
    spread = jackknifed(experiment, model, scatter)
    more = np.sqrt(np.maximum(spread**2 - np.where(np.isfinite(sigma), sigma, 0.0) ** 2, 0.0))
    return replace(model, doubt=more if model.doubt is None else np.hypot(model.doubt, more))


def jackknifed(experiment: Experiment, model: Fitted, scatter: Scatter) -> np.ndarray:
    """Standard deviations (p,) of the values by leaving out block after block, to first order."""
    rows = np.isfinite(model.fit.residual)
    block = blocks_of(experiment.at)[experiment.point_of()]
    steps = []
    for k in np.unique(block[rows]):
        left = rows & (block != k)
        whiten = judge_of(experiment, left).whiten(scatter)
        slopes = whiten(model.fit.slopes[left])
        size = np.linalg.norm(slopes, axis=0)
        scale = np.where(size > 0.0, size, 1.0)
        step = np.linalg.lstsq(slopes / scale, whiten(model.fit.residual[left]), rcond=1e-6)[0]
        steps.append(step / scale)
    n, moves = len(steps), np.array(steps)
    return np.asarray(np.sqrt((n - 1) / n * ((moves - moves.mean(axis=0)) ** 2).sum(axis=0)))
