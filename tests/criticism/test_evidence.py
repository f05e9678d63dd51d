"""What counts as found, and what cannot be told apart."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from geomdrap.criticism.evidence import Evidence, alike_in_what_they_leave, among_all, chance, rivals, says_the_same
from geomdrap.criticism.fit import Fit
from geomdrap.criticism.model import Fitted, Model
from geomdrap.criticism.search import _in_range
from geomdrap.criticism.words import round_with

GOOD = Evidence("slip", 60.0, 1, 1e-14, 1e-13, 0.9, 0.5, True)


def test_chances_are_corrected_as_holm_did():
    np.testing.assert_allclose(among_all([0.01, 0.04, 0.03]), [0.03, 0.06, 0.06])
    np.testing.assert_allclose(among_all([0.5, 0.9]), [1.0, 1.0])


def test_the_chance_of_a_gain_is_that_of_normal_numbers_squared():
    rng = np.random.default_rng(0)
    made = (rng.normal(size=(20000, 2)) ** 2).sum(axis=1)
    assert chance(6.0, 2) == pytest.approx((made > 6.0).mean(), abs=0.005)
    assert chance(-1.0, 2) == 1.0


@pytest.mark.parametrize(
    "weaker",
    [{"p_family": 0.03}, {"gain": 4.0}, {"share": 0.1}, {"cv_ratio": 1.0}, {"in_range": False}],
    ids=lambda w: next(iter(w)),
)
def test_an_effect_is_found_only_if_it_passes_every_test(weaker):
    assert GOOD.found
    assert not replace(GOOD, **weaker).found


def test_what_comes_to_the_best_at_small_values_and_does_no_better_is_no_rival():
    wider = replace(GOOD, name="wider", gain=GOOD.gain - 2.0, includes=("slip",))
    assert rivals([wider, GOOD]) == ("slip",)
    assert rivals([replace(wider, gain=GOOD.gain + 2.0), GOOD]) == ("wider", "slip")
    assert rivals([replace(wider, gain=GOOD.gain + 15.0), GOOD]) == ("wider", "slip")
    assert rivals([replace(wider, gain=GOOD.gain + 30.0), GOOD]) == ("wider",)
    assert alike_in_what_they_leave([wider, GOOD]) == ("slip",)
    assert says_the_same(wider, [wider, GOOD])
    assert says_the_same(replace(wider, gain=GOOD.gain + 30.0, in_range=False), [GOOD])
    assert not says_the_same(replace(wider, gain=GOOD.gain + 30.0), [GOOD])


def test_those_close_to_the_best_are_its_rivals_and_others_are_not():
    close, far = replace(GOOD, name="close", gain=56.0), replace(GOOD, name="far", gain=40.0)
    assert rivals([far, close, GOOD]) == ("slip", "close")
    assert rivals([replace(GOOD, share=0.0)]) == ()


def test_of_two_with_the_same_gain_the_one_with_fewer_unknowns_comes_first():
    wide = replace(GOOD, name="wide", unknowns=3, gain=61.0)
    assert rivals([wide, GOOD])[0] == "slip"


BESIDE = ("shear-stiffness",)


@pytest.mark.parametrize(
    ("effect", "includes", "acts"),
    [
        ("shear-stiffness", (), True),
        ("springback", (), False),
        ("yarn-bending", (), True),
        ("yarn-bending", BESIDE, False),
    ],
)
def test_only_what_acts_at_once_need_not_be_clearly_off_its_neutral_value(effect, includes, acts):
    model = Model((effect,))
    values = np.append(np.zeros(3), 1e-4)
    found = Fitted(model, Fit(values, np.zeros(1), np.zeros((1, 4)), 0.0))
    assert _in_range(found, np.full(4, 1e-3), includes) == acts
    assert _in_range(found, np.full(4, 1e-5), includes)
    assert not _in_range(replace(found, fit=replace(found.fit, values=model.neutral)), np.full(4, 1e-5), includes)


def test_effects_that_leave_as_little_as_the_best_are_alike_whatever_their_likelihood():
    best = replace(GOOD, share=0.993, gain=1600.0)
    close, far = replace(GOOD, name="close", share=0.988, gain=1500.0), replace(GOOD, name="far", share=0.95)
    assert rivals([far, close, best]) == ("slip",)
    assert alike_in_what_they_leave([far, close, best]) == ("slip", "close")
    assert alike_in_what_they_leave([replace(GOOD, share=0.6), replace(close, share=0.59)]) == ()
    assert alike_in_what_they_leave([best, replace(close, in_range=False)]) == ("slip",)


def test_candidates_are_compared_in_the_last_round_that_tried_them_all():
    def round_of(*names):
        return SimpleNamespace(trials=[SimpleNamespace(model=Model(("slip", name))) for name in names])

    rounds = round_of("locking", "shear-stiffness", "slip"), round_of("shear-stiffness", "slip")
    assert round_with(rounds, ["locking", "shear-stiffness"]) is rounds[0]  # the second stands on locking
    assert round_with(rounds, ["slip", "shear-stiffness"]) is rounds[1]
