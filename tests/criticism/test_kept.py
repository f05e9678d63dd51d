"""What is costly to make is made once while it is in use."""

from __future__ import annotations

import numpy as np
import pytest

import geomdrap as gd
from geomdrap.criticism.experiment import HARDLY_DIFFERENT, KEPT, Experiment
from geomdrap.criticism.kept import kept


def test_what_was_asked_for_longest_ago_goes_first():
    store: dict[str, int] = {}
    made = []
    for key in "abacab":  # a is in use throughout
        assert kept(store, key, lambda key=key: made.append(key) or ord(key), 2) == ord(key)
    assert made == ["a", "b", "c", "b"]
    assert set(store) == {"a", "b"}


def test_what_a_coarse_net_gets_wrong_is_taken_from_the_nearest_values_and_anew_beyond(monkeypatch):
    """One that is in use stays; an experiment without some values, or with finer nets, begins without any."""
    mask = np.ones((4, 1), bool)
    one = Experiment(None, None, None, np.zeros((4, 2)), None, ("shear",), mask, np.ones(4), np.zeros(4), (1.0, 8.0))
    made = []

    def draped(self, effects, pitch):
        made.append((pitch, *(e.values["du"] for e in effects)))
        return np.full(4, pitch * sum(e.values["du"] for e in effects))

    monkeypatch.setattr(Experiment, "draped", draped)
    monkeypatch.setattr(Experiment, "_flat", lambda self, net: net)

    def wrong_at(du, experiment=one):
        return experiment._coarseness([gd.effects.make("placement", du=du)])[0] / -7.0

    near, far = 0.9 * HARDLY_DIFFERENT * 2.0, 1.1 * HARDLY_DIFFERENT * 2.0  # 2 mm is usual
    assert wrong_at(1.0) == pytest.approx(1.0)
    assert wrong_at(1.0 + near) == pytest.approx(1.0)
    assert wrong_at(1.0 + far) == pytest.approx(1.0 + far)
    assert wrong_at(1.0 + near) == pytest.approx(1.0 + far)  # which is nearer now
    assert len(made) == 4
    for n in range(2 * KEPT):
        assert wrong_at(1.0) == pytest.approx(1.0)
        wrong_at(10.0 + n)
    drop = np.array([[True], [False], [False], [False]])
    assert not one.without(drop).coarseness and not one.finer().coarseness and one.coarseness
