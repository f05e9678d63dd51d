"""The search: where effects are looked at, in which order they are tried, and what is left out of a second search."""

from dataclasses import replace
from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest

from geomdrap.criticism import search
from geomdrap.criticism.cleaned import cleaned, spoilt
from geomdrap.criticism.diagnose import _teller, _verdict
from geomdrap.criticism.diagnosis import Value
from geomdrap.criticism.ended import at_an_end
from geomdrap.criticism.experiment import Experiment
from geomdrap.criticism.fit import Fit
from geomdrap.criticism.fitted_on import again, further
from geomdrap.criticism.model import Fitted, Look, Model, Predictor, _begun, add_effect
from geomdrap.criticism.start import Glance, glance, start_values
from geomdrap.criticism.words import misplaced, shortened
from geomdrap.measurement.outliers import Outlier

POINTS = 60
AT = np.random.default_rng(0).normal(size=(POINTS, 2))
PLACES = np.column_stack([np.ones(POINTS), AT])  # what the three values of a placement do


def whiten(a):
    return a / 0.1


def base_at(values, measured):
    return Fitted(Model(()), Fit(np.array(values), measured - PLACES @ values, PLACES, 1e9))


@pytest.mark.parametrize(("values", "seen"), [((0.0, 0.0, 10.0), True), ((0.0, 0.0, 0.5), False)])
def test_a_costly_effect_is_also_looked_at_from_where_the_ply_was_meant_to_lie(values, seen):
    # the effect acts only on a ply that lies as it was meant to
    shape = np.sin(5.0 * AT[:, 0])
    measured = shape.copy()

    def predict(v):
        acts = v[3] / 0.003 * (np.abs(v[:3]).max() < 0.1)
        return PLACES @ v[:3] + acts * shape + v[3] * AT[:, 1] ** 2

    experiment = SimpleNamespace(measured=measured, top_shear=30.0)
    looked = glance(experiment, predict, whiten, whiten, base_at(values, measured), "shear-stiffness")
    assert (looked.after < 1.0) == seen


def test_rounding_is_no_action_of_a_parameter_that_is_neutral_where_it_is_typical():
    # crossing-slip: alone the onset does nothing, and is as large as usual where it is neutral
    shape, rounding = np.sin(5.0 * AT[:, 0]), np.random.default_rng(1).normal(size=POINTS)
    measured = 0.3 * shape

    def predict(v):
        return PLACES @ v[:3] + v[3] * shape + 1e-4 * rounding

    experiment = SimpleNamespace(measured=measured, top_shear=30.0)
    start = start_values(experiment, predict, whiten, base_at((0.0, 0.0, 0.0), measured), "crossing-slip").values
    assert start[3] == pytest.approx(0.3, abs=0.01)
    assert np.isfinite(start).all()


def test_the_slow_effect_that_a_look_favours_is_tried_first(monkeypatch):
    after = {"bridging": 50.0, "locking": 5.0, "shear-stiffness": 20.0}

    def look_at(experiment, whiten, likely, base, name):
        value = after.get(name)
        return Look(name, Model((name,)), None, value and Glance(None, None, 9.0, value))

    monkeypatch.setattr(search, "look_at", look_at)
    told = []
    names = ("bridging", "steering", "locking", "shear-stiffness")
    order = [look.effect for look in search._looks(None, None, (whiten, whiten), names, told.append)]
    assert order == ["steering", "locking", "shear-stiffness", "bridging"]
    assert len(told) + len(order) == search.steps_of(names)


@pytest.mark.parametrize(
    ("best", "left", "tried"),
    [
        (0.4, 0.8, True),
        (0.4, 0.95, False),
        (0.6, 0.95, True),
        (0.05, 0.3, True),
        (0.05, 0.4, False),
        (0.0004, 0.3, True),
        (0.0004, 0.4, False),
        (1.0 + 1e-9, 0.5, True),
    ],
)
def test_the_more_another_effect_explains_the_more_a_look_must_promise(best, left, tried):
    """``best`` is what the best effect so far leaves of the misfit, ``left`` the look's share of the way to it."""
    measured = 10.0 * np.sin(5.0 * AT[:, 0])
    base = base_at((0.0, 0.0, 0.0), measured)
    beside = measured - PLACES @ np.linalg.lstsq(PLACES, measured, rcond=None)[0]
    before = float((whiten(beside) ** 2).sum())
    base = replace(base, fit=replace(base.fit, chi2=before))
    least = POINTS + best * (before - POINTS)
    asked = []

    def predict(v):
        asked.append(v)
        return PLACES @ v[:3] + v[3] * AT[:, 1]

    predict.beside = lambda at, step: None
    seen = Glance(np.array([0.003]), AT[:, 1], 100.0, least + left * (before - least))
    look = Look("shear-asymmetry", Model(("shear-asymmetry",)), predict, seen)
    experiment = SimpleNamespace(measured=measured, top_shear=30.0)
    found = add_effect(experiment, whiten, base, look, least)
    assert found.looked_at_only is not tried
    assert bool(asked) is tried


@pytest.mark.parametrize(("lost", "kept"), [(0, False), (15, True), (POINTS, True)])
def test_a_fit_from_where_the_ply_was_meant_to_lie_must_predict_as_much(lost, kept):
    """What is lost counts nothing in chi-square: a seed off the part, where nothing is predicted, was the best fit."""
    shape = np.sin(5.0 * AT[:, 0])
    truth = np.array([0.0, 0.3, 0.2])
    measured = PLACES @ truth + shape

    def predict(v):
        near = abs(v[0]) < 4.0
        out = PLACES @ (v[:3] if near else np.array([v[0] - 8.0, *v[1:3]])) + v[3] / 0.05 * shape * (
            1.0 if near else 0.9
        )
        out[: lost if near else 0] = np.nan
        return out

    predict.beside = lambda at, step: None
    base = base_at((8.0, 0.3, 0.2), measured)
    base = replace(base, fit=replace(base.fit, residual=measured - PLACES @ truth))
    experiment = SimpleNamespace(measured=measured, top_shear=30.0)
    found = add_effect(experiment, whiten, base, Look("slip", Model(("slip",)), predict))
    assert bool(found.values[0] > 4.0) is kept
    assert np.isfinite(found.fit.residual).all()


def test_progress_never_goes_back_whatever_the_number_of_rounds():
    shares = []
    for passed in range(4):
        tell = _teller(lambda share, _: shares.append(share), passed, 5)
        for _ in range(5):
            tell("x")
    assert shares == sorted(shares)
    assert 0.0 <= shares[0] < shares[-1] < 1.0


def test_an_outlier_spoils_the_position_or_all_but_it():
    channels = ("along", "normal", "shear", "warp")
    drop = spoilt(channels, (3, 4), [Outlier(0, 2, "position", 1.0, 9.0), Outlier(2, 4, "shear", 9.0, 9.0)])
    np.testing.assert_array_equal(drop, [[1, 1, 0, 0], [0, 0, 0, 0], [0, 0, 1, 1]])


def test_an_experiment_without_some_values_keeps_the_others_in_order():
    mask = np.array([[True, True], [True, False], [True, True]])
    table = np.array([[1.0, 10.0], [2.0, np.nan], [3.0, 30.0]])
    flat = table.T[mask.T]
    whole = Experiment(None, None, None, AT, None, ("normal", "shear"), mask, 0.1 * flat, flat, (1.0, 2.0))
    drop = np.array([[True, False], [False, False], [False, True]])
    less = whole.without(drop & mask)
    np.testing.assert_array_equal(less.measured, [2.0, 3.0, 10.0])
    np.testing.assert_allclose(less.noise, [0.2, 0.3, 1.0])
    assert less.mask.sum() == 3


@pytest.mark.parametrize(("left", "taken"), [(0.1, True), (0.13, False)])
def test_what_stands_out_is_taken_out_where_a_model_explains_all_else(monkeypatch, left, taken):
    mask = np.ones((POINTS, 1), bool)
    residual = np.full(POINTS, left)
    residual[3] = 5.0
    noise = np.full(POINTS, 0.1)
    whole = Experiment(None, None, None, AT, None, ("shear",), mask, noise, np.zeros(POINTS), (1.0, 2.0))
    model = Fitted(Model(()), Fit(np.zeros(3), residual, PLACES, 1e4))
    monkeypatch.setattr("geomdrap.criticism.cleaned.outliers_of", lambda *_: [Outlier(3, 5, "shear", 5.0, 50.0)])
    got = cleaned(whole, model)
    assert (got is not None) == taken
    if got is not None:
        assert not got.mask[3, 0]
        assert got.mask.sum() == POINTS - 1


def test_what_acts_at_once_is_never_fitted_to_nothing():
    low, high = Model(("shear-stiffness", "slip", "yarn-bending")).bounds
    assert (low[[3, 5]] > 0.0).all() and low[4] == 0.0
    assert (low < high).all()


def trial_at(name, values, chi2, residual=0.0):
    model = Model((name,))
    slopes = np.column_stack([PLACES, np.full((POINTS, len(values) - 3), 2.0)])
    return Fitted(model, Fit(np.array(values), np.full(POINTS, residual), slopes, chi2))


def test_models_known_before_readings_were_dropped_are_fitted_again_only_near_the_best(monkeypatch):
    base = Fitted(Model(()), Fit(np.array([9.0, 0.0, 0.0]), np.full(POINTS, 0.7), PLACES, 1000.0))
    known = [
        trial_at("slip", [0.0, 0.0, 0.0, 0.1], 100.0),
        trial_at("shear-stiffness", [0.0, 0.0, 0.0, 0.003], 110.0),
        trial_at("locking", [0.0, 0.0, 0.0, 20.0], 600.0),
        trial_at("bridging", [3.0, 0.0, 0.0, 0.0], 1001.0),
    ]
    idle = replace(known[3], looked_at_only=True)
    fitted_again = []
    monkeypatch.setattr("geomdrap.criticism.fitted_on.refit", lambda _, __, old: fitted_again.append(old) or old)
    got = again(None, whiten, base, known)
    assert fitted_again == known[:2]
    assert got[2] is known[2]
    np.testing.assert_array_equal(got[3].values, [9.0, 0.0, 0.0, 0.0])  # what explains nothing is the base
    assert got[3].fit.chi2 == base.fit.chi2 and (got[3].fit.residual == 0.7).all()
    fitted_again.clear()
    assert again(None, whiten, base, [idle])[0].looked_at_only  # where nothing is found, all are as good as the base
    assert not fitted_again


def test_a_model_is_compared_with_the_values_that_are_left():
    residual = np.arange(POINTS, dtype=float)
    model = Fitted(Model(()), Fit(np.zeros(3), residual, PLACES, 1e9))
    rows = residual < 3.0
    less = model.only(rows, np.full(3, 0.5))
    assert less.fit.chi2 == pytest.approx((0.0 + 1.0 + 4.0) / 0.25)
    np.testing.assert_array_equal(less.fit.slopes, PLACES[:3])


@pytest.mark.parametrize(("astray", "looked"), [(5.0, True), (0.2, False)])
def test_a_two_sided_costly_effect_is_looked_for_at_other_headings_if_the_base_went_astray(astray, looked):
    shape = np.sin(5.0 * AT[:, 0])
    measured = PLACES @ [0.0, 0.0, 8.0] + 0.4 * shape
    headings = []

    def predict(v):
        headings.append(v[2])
        acts = v[3] * (abs(v[2] - 8.0) < 3.0 and abs(v[0]) < 0.5)  # the net lies like this only near its heading
        return PLACES @ v[:3] + acts * shape + 1e-3 * v[3] * AT[:, 1] ** 2

    experiment = SimpleNamespace(measured=measured, top_shear=30.0)
    seen = Glance(np.array([0.2]), shape, 9.0, 1.0)
    start = start_values(experiment, predict, whiten, base_at((astray, 0.0, 0.0), measured), "shear-asymmetry", seen).values
    assert ({-16.0, 8.0} <= set(headings)) == looked
    if looked:
        np.testing.assert_allclose(start, [0.0, 0.0, 8.0, 0.2], atol=0.5)


def test_what_was_only_looked_at_is_not_fitted_on():
    idle = replace(trial_at("shear-stiffness", [0.0, 0.0, 0.0, 0.0], 900.0), looked_at_only=True)
    assert further(None, whiten, idle) is idle


def test_a_second_search_knows_each_effect_once(monkeypatch):
    """The base of a second round is a trial of the first."""
    base, one = Fitted(Model(()), Fit(np.zeros(3), np.zeros(POINTS), PLACES, 1.0)), trial_at("slip", [0.0] * 4, 0.5)
    two = replace(one, model=Model(("slip", "locking")))
    rounds = [SimpleNamespace(base=base, trials=(one,)), SimpleNamespace(base=one, trials=(two,), closest=two)]
    mask = np.ones((POINTS, 1), bool)
    whole = Experiment(None, None, None, AT, None, ("shear",), mask, np.ones(POINTS), np.zeros(POINTS), (1.0, 2.0))
    asked = []

    def searched(experiment, names, progress, passed=0, known=()):
        asked.append([m.model.effects for m in known])
        return rounds

    module = import_module("geomdrap.criticism.diagnose")
    monkeypatch.setattr(module, "prepare", lambda *_: (whole, ()))
    monkeypatch.setattr(module, "search", searched)
    monkeypatch.setattr(module, "cleaned", lambda *_: whole.without(np.arange(POINTS)[:, None] < 2))
    monkeypatch.setattr(module, "conclude", lambda *_: None)
    module.diagnose(None, None)
    assert asked == [[], [(), ("slip",), ("slip", "locking")]]


def test_a_slope_where_nothing_can_be_drawn_is_left_to_the_prediction():
    """A linear start may lie beyond what the placement can be: a diagnosis ended in an EffectError."""
    never = SimpleNamespace(beside=lambda effects, others: pytest.fail("such a ply cannot be"))
    predict = Predictor(never, Model(("shear-stiffness",)))
    assert predict.beside(np.array([0.0, 0.0, 83.0, 0.003]), np.array([0.0, 0.0, 0.1, 0.0])) is None


def test_a_linear_start_keeps_to_what_the_placement_can_be():
    measured = PLACES @ np.array([0.0, 0.0, 90.0]) + AT[:, 0] ** 2

    def predict(v):
        return PLACES @ v[:3] + v[3] * AT[:, 0] ** 2 + v[4] * AT[:, 1] ** 2

    experiment = SimpleNamespace(measured=measured, top_shear=30.0)
    start = start_values(experiment, predict, whiten, base_at((0.0, 0.0, 0.0), measured), "yarn-extension").values
    assert start[2] == 45.0


@pytest.mark.parametrize(("size", "drapes"), [(1e-3, 2), (1.0, 5)])
def test_finer_slopes_are_taken_only_of_what_rough_ones_promise(size, drapes):
    """On top of what is costly each slope is a relaxed net: of effects that explain nothing two are enough."""
    measured = size * AT[:, 0] ** 2
    asked = []

    def predict(v):
        asked.append(tuple(v))
        return PLACES @ v[:3] + 100.0 * v[3] * AT[:, 0] ** 2 + 100.0 * v[4] * AT[:, 1] ** 2

    experiment = SimpleNamespace(measured=measured, top_shear=30.0)
    predict.beside = lambda values, step: None
    base = base_at((0.0, 0.0, 0.0), measured)
    begun = _begun(experiment, whiten, base, Look("yarn-extension", Model(("yarn-extension",)), predict), (0.0,))
    assert len(set(asked)) == drapes
    if drapes == 2:
        np.testing.assert_array_equal(begun.values, np.zeros(5))
        np.testing.assert_allclose(begun.fit.slopes[:, 3], 100.0 * AT[:, 0] ** 2)
        assert begun.fit.chi2 == base.fit.chi2


@pytest.mark.parametrize(("dangle", "lost"), [(44.0, False), (45.0, True), (-45.0, True)])
def test_a_ply_at_the_end_of_where_it_is_looked_for_is_not_found(dangle, lost):
    """A ply that had turned by far more was called locked, at 167 times the noise."""
    model = Fitted(Model(("locking",)), Fit(np.array([1.0, 2.0, dangle, 20.0]), np.zeros(1), np.zeros((1, 4)), 0.0))
    assert at_an_end(model) is lost
    end = SimpleNamespace(names=["locking"], alike=(), unexplained=True, model=model)
    assert _verdict(end) == ("unknown", () if lost else ("locking",))
    placement = [Value("du", 1.0, 0.1, "mm"), Value("dv", 2.0, 0.1, "mm"), Value("dangle", dangle, np.inf, "deg")]
    for labelled in (False, True):
        bare = SimpleNamespace(measurement=SimpleNamespace(u=None, v=None, labelled=labelled))
        said = misplaced(bare, placement)[0]
        assert "dangle" in said
        assert ("less certain" in said) is not labelled  # of a shear-only table du was 12 ± 4 mm where it was 0


def test_yarns_that_are_all_shorter_are_said_to_be_no_matter_of_tension():
    def found(warp, weft, sigma=0.0003):
        return [Value("strain_warp", warp, sigma, ""), Value("strain_weft", weft, sigma, "")]

    assert "shrunk" in shortened(found(-0.009, -0.0094))[0]
    assert not shortened(found(-0.009, 0.002))
    assert not shortened(found(-0.009, -0.0094, 0.005))  # not for certain
    assert not shortened(())


@pytest.mark.parametrize(("value", "looked", "nothing"), [(0.0, False, True), (0.0, True, False), (0.01, False, False)])
def test_what_was_fitted_to_nothing_explains_nothing(value, looked, nothing):
    """Its slopes promise something with the other sign: stiffness below 0 was said to explain half of a misfit."""
    at = np.array([0.5, 0.0, 0.1, value])
    model = Fitted(Model(("shear-stiffness",)), Fit(at, np.zeros(4), np.zeros((4, 4)), 0.0), looked_at_only=looked)
    assert search._does_nothing(model) == nothing
