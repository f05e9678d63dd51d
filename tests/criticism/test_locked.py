"""How sharply a locking angle is known: by the net that fits, and by where the measured shear stops."""

from types import SimpleNamespace

import numpy as np
import pytest

from geomdrap.criticism.evidence import Evidence
from geomdrap.criticism.experiment import Experiment
from geomdrap.criticism.fit import Fit
from geomdrap.criticism.layup import Layup
from geomdrap.criticism.likelihood import NO_SCATTER
from geomdrap.criticism.locked import doubted, locks
from geomdrap.criticism.model import Fitted, Model

PREDICTED = np.linspace(5.0, 35.0, 60)  # by the net without effects, degrees
NOISE, STOP, FOUND, OVER = 0.3, 20.0, 22.5, 0.4


def of_shear(measured):
    """An experiment that measured shear alone, without a part."""
    return Experiment(
        surface=None,
        measurement=None,
        layup=Layup("centroid", 0.0),
        at=np.zeros((60, 2)),
        frames=np.tile(np.eye(3), (60, 1, 1)),
        channels=("shear",),
        mask=np.ones((60, 1), bool),
        noise=np.full(60, NOISE),
        measured=measured,
        pitches=(4.0, 8.0),
    )


def first_round(measured, share, cv_ratio=0.7, rival=10.0, acts=True):
    """What a search sees of measured shear: an experiment and its first round."""
    experiment = of_shear(measured)
    base = Fitted(Model(()), Fit(np.zeros(3), measured - PREDICTED, np.zeros((60, 3)), 0.0))
    evidence = (
        Evidence("locking", 50.0, 3, 1e-9, 1e-8, share, cv_ratio, acts),
        Evidence("steering", rival, 2, 0.5, 1.0, 0.01, 1.0, False),
    )
    return experiment, SimpleNamespace(base=base, scatter=(NO_SCATTER,), evidence=evidence)


def test_shear_that_stops_is_locking_where_that_explains_most_or_more_than_all_else():
    stopped, grown = noisy(np.minimum(PREDICTED, STOP)), noisy(0.9 * PREDICTED)
    assert locks(*first_round(stopped, 0.5))
    assert not locks(*first_round(grown, 0.5))  # it does not stop
    assert locks(*first_round(stopped, 0.05))  # as buckled yarns leave it
    assert not locks(*first_round(stopped, 0.05, rival=60.0))
    assert not locks(*first_round(stopped, 0.05, cv_ratio=1.0))
    assert not locks(*first_round(grown, 0.05))
    experiment, seen = first_round(stopped, 0.26)
    nearly_all = Evidence("springback", 900.0, 1, 0.0, 0.0, 0.95, 0.5, True)
    seen.evidence = (*seen.evidence, nearly_all)
    assert not locks(experiment, seen)
    assert not locks(*first_round(stopped, 0.5, acts=False))  # only looked at, since another effect explains far more


def doubt_of_the_angle(measured, monkeypatch, pitch_doubt=None):
    experiment = of_shear(measured)
    # of the net that was fitted, some cells are sheared beyond its angle, others are not
    shear = np.array([[FOUND + OVER, -FOUND - OVER], [10.0, np.nan]])
    monkeypatch.setattr(Experiment, "draped", lambda *_: SimpleNamespace(cell_shear=shear))
    base = Fitted(Model(()), Fit(np.zeros(3), measured - PREDICTED, np.zeros((60, 3)), 0.0))
    doubt = None if pitch_doubt is None else np.array([0.0, 0.0, 0.0, pitch_doubt])
    model = Fitted(Model(("locking",)), Fit(np.array([0.0, 0.0, 0.0, FOUND]), measured, np.zeros((60, 4)), 0.0), doubt)
    got = doubted(experiment, SimpleNamespace(base=base, scatter=(NO_SCATTER,)), model).doubt
    np.testing.assert_array_equal(got[:3], 0.0)
    return got[3]


def noisy(shear):
    return shear + NOISE * np.random.default_rng(0).normal(size=60)


def test_what_the_net_and_the_plateau_differ_by_is_in_the_doubt(monkeypatch):
    got = doubt_of_the_angle(noisy(np.minimum(PREDICTED, STOP)), monkeypatch)
    assert got == pytest.approx(np.hypot(OVER, FOUND - STOP), abs=0.15)
    more = doubt_of_the_angle(noisy(np.minimum(PREDICTED, STOP)), monkeypatch, pitch_doubt=3.0)
    assert more == pytest.approx(np.hypot(got, 3.0))


def test_without_a_plateau_the_doubt_is_how_far_the_net_shears_beyond_its_angle(monkeypatch):
    assert doubt_of_the_angle(noisy(0.8 * PREDICTED), monkeypatch) == pytest.approx(OVER)
