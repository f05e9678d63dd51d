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
from geomdrap.criticism.likelihood import Scatter, covariance, deviations
from geomdrap.criticism.model import Fitted
from geomdrap.criticism.search import judge_of

MOST = 2.0  # times larger


def widened(experiment: Experiment, model: Fitted, scatter: Scatter) -> Fitted:
    """The model with a doubt that makes its standard deviations those of the jackknife where these are larger."""
    rows = np.isfinite(model.fit.residual)
    sigma = deviations(judge_of(experiment, rows).whiten(scatter)(model.fit.slopes[rows]))
    spread = jackknifed(experiment, model, scatter)
    more = np.sqrt(np.maximum(spread**2 - np.where(np.isfinite(sigma), sigma, 0.0) ** 2, 0.0))
    return replace(model, doubt=more if model.doubt is None else np.hypot(model.doubt, more))


def jackknifed(experiment: Experiment, model: Fitted, scatter: Scatter) -> np.ndarray:
    """Standard deviations (p,) of the values by leaving out block after block, each by one step of the whole fit.

    A fit leaves less than the noise of a block that has a say in it: steps are made larger by as much as that makes
    them too small where the covariance is right, at most by ``MOST``. 0 for values of which nothing is seen.
    """
    rows = np.isfinite(model.fit.residual)
    whiten = judge_of(experiment, rows).whiten(scatter)
    block = blocks_of(experiment.at)[experiment.point_of()][rows]
    slopes, residual = whiten(model.fit.slopes[rows]), whiten(model.fit.residual[rows])
    spread = covariance(slopes)
    spread[~np.isfinite(spread)] = 0.0
    squares, expected = np.zeros(len(spread)), np.zeros(len(spread))
    for k in np.unique(block):
        own = slopes[block == k]
        said = own.T @ own
        squares += (spread @ (own.T @ residual[block == k])) ** 2
        expected += np.diag(spread @ (said - said @ spread @ said) @ spread)
    meant = np.diag(spread)
    return np.asarray(np.sqrt(squares * np.minimum(meant / np.maximum(expected, 1e-300), MOST**2)))
