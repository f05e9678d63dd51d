"""The finer net on which costly models are fitted to the end, and what its pitch leaves in doubt."""

from __future__ import annotations

from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

from geomdrap.criticism.evidence import Evidence
from geomdrap.criticism.experiment import Experiment, Layup
from geomdrap.criticism.fit import Fit
from geomdrap.criticism.likelihood import NO_SCATTER
from geomdrap.criticism.model import Fitted, Model
from geomdrap.criticism.search import Round

diagnose = import_module("geomdrap.criticism.diagnose")  # the package's own name for it is the function
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


@pytest.mark.parametrize(
    ("pitches", "finer"), [((2.0, 8.0), (2.0, 4.0)), ((3.0, 4.0), (3.0, 3.0)), ((4.0, 4.0), (4.0, 4.0))]
)
def test_the_net_for_what_is_costly_is_halved_down_to_the_other_one(pitches, finer):
    assert experiment(pitches).finer().pitches == finer


def test_locking_in_place_of_another_costly_effect_is_fitted_on_a_net_of_half_the_pitch(monkeypatch):
    base, trials = fitted(), (fitted("shear-stiffness"), fitted("locking"))
    evidence = tuple(
        Evidence(n, g, 1, 0.0, 0.0, 0.9, 0.5, True) for n, g in (("shear-stiffness", 900.0), ("locking", 9.0))
    )
    of = Round(base, trials, evidence, (NO_SCATTER,) * 3, np.ones(POINTS, bool), None, 1.0, ())
    asked = []

    def refined(finer, whiten, model, *ratio):
        asked.append((model.model.effects, finer.pitches[1]))
        if len(asked) == 2:
            raise StopIteration  # the verdict is no matter here
        return model

    monkeypatch.setattr(diagnose, "refined", refined)
    monkeypatch.setattr(diagnose, "left_over", lambda *_: SimpleNamespace(structured=True))
    monkeypatch.setattr(diagnose, "_locks", lambda *_: True)
    with pytest.raises(StopIteration):
        diagnose.conclude(experiment((1.0, 8.0)), [of], ())
    assert asked == [(("shear-stiffness",), 4.0), (("locking",), 4.0)]
