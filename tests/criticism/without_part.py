"""Models fitted to distances off the tool, without a part."""

import numpy as np

from geomdrap.criticism.experiment import Experiment
from geomdrap.criticism.fit import Fit
from geomdrap.criticism.layup import Layup
from geomdrap.criticism.model import Fitted, Model

POINTS = 12


def experiment(pitches):
    """Distances off the tool, without a part."""
    return Experiment(
        surface=None,
        measurement=None,
        layup=Layup("centroid", 0.0),
        at=np.random.default_rng(0).uniform(-50.0, 50.0, (POINTS, 2)),
        frames=np.tile(np.eye(3), (POINTS, 1, 1)),
        channels=("normal",),
        mask=np.ones((POINTS, 1), bool),
        noise=np.ones(POINTS),
        measured=np.zeros(POINTS),
        pitches=pitches,
    )


def fitted(*effects):
    model = Model(effects)
    return Fitted(model, Fit(model.neutral, np.zeros(POINTS), np.zeros((POINTS, len(model.neutral))), 0.0))
