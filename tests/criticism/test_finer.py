"""The finer net on which costly models are fitted to the end, and what its pitch leaves in doubt."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from itertools import chain, repeat
from types import SimpleNamespace

import numpy as np
import pytest
from without_part import POINTS, experiment, fitted

import geomdrap as gd
from geomdrap.criticism.evidence import Evidence
from geomdrap.criticism.fit import Fit
from geomdrap.criticism.fitted_on import doubted_for_facets, doubted_for_pitch, refined, settled
from geomdrap.criticism.layup import Layup
from geomdrap.criticism.likelihood import NO_SCATTER, Scatter
from geomdrap.criticism.model import Fitted, Model
from geomdrap.criticism.prepare import prepare
from geomdrap.criticism.search import Round
from geomdrap.surface import shapes

diagnose = import_module("geomdrap.criticism.diagnose")  # the package's own name for it is the function
ended = import_module("geomdrap.criticism.ended")
last = import_module("geomdrap.criticism.final")

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

    def record(coarser, finer, whiten, model):
        asked.append((model.model.effects, finer.pitches[1]))
        if len(asked) == 2:
            raise StopIteration  # the verdict is no matter here
        return finer, model

    monkeypatch.setattr(last, "refined", record)
    monkeypatch.setattr(last, "doubted_for_facets", lambda _, model: model)
    monkeypatch.setattr(last, "rests", lambda *_: True)
    monkeypatch.setattr(ended, "left_over", lambda *_: SimpleNamespace(structured=True, doubtful=False))
    monkeypatch.setattr(ended, "leaves", lambda *_: False)
    monkeypatch.setattr(ended, "locks", lambda *_: True)
    with pytest.raises(StopIteration):
        diagnose.conclude(experiment((1.0, 8.0)), [of], ())
    assert asked == [(("shear-stiffness",), 4.0), (("locking",), 4.0)]


@pytest.mark.parametrize(("worse", "kept"), [(1.2, False), (2.0, True)])
def test_a_finer_net_that_came_to_rest_elsewhere_tells_nothing_and_that_is_said(monkeypatch, worse, kept):
    meant, old = experiment((1.0, 8.0)), fitted("shear-stiffness")
    old = replace(old, fit=replace(old.fit, residual=np.full(POINTS, np.sqrt(100.0 / POINTS)), chi2=1.0))
    new = replace(old, fit=replace(old.fit, chi2=100.0 * worse))
    monkeypatch.setattr(last, "refined", lambda _, finer, *__: (finer, new))
    monkeypatch.setattr(last, "doubted_for_facets", lambda _, model: model)
    monkeypatch.setattr(last, "rests", lambda *_: True)
    final, model = last.final(meant, old, NO_SCATTER)
    assert (final is meant, model is old) == (kept, kept)
    said = last.said_of_coarser(meant, final, model)
    assert bool(said) == kept
    assert all("the values of shear-stiffness are those of a net of 8 mm" in one for one in said)


def test_a_finer_net_that_does_not_come_to_rest_is_not_fitted(monkeypatch):
    meant, old = experiment((1.0, 8.0)), fitted("shear-stiffness")
    monkeypatch.setattr(last, "rests", lambda *_: False)
    monkeypatch.setattr(last, "refined", None)
    monkeypatch.setattr(last, "doubted_for_facets", lambda _, model: model)
    final, model = last.final(meant, old, NO_SCATTER)
    assert final is meant and model is old
    assert "not at all" in last.said_of_coarser(meant, final, model)[0]


SLOPES = np.random.default_rng(1).normal(size=(POINTS, 4))  # of the placement and an offset
TRUTH, PER_PITCH = np.array([0.3, -0.2, 0.5, 2.0]), np.array([0.01, 0.02, -0.01, 0.03])


class WithoutNets:
    """An experiment that knows nothing but its predictions."""

    def beside(self, effects, others):
        return None

    def draping_anew(self):
        return self


class OfSecondOrder(WithoutNets):
    """An experiment whose net is off by PER_PITCH·pitch² in every value."""

    def __init__(self, pitch):
        self.pitch, self.pitches, self.measured, self.refused = pitch, (pitch, pitch), SLOPES @ TRUTH, {}

    def predict(self, effects):
        values = np.array([v for e in effects for v in e.values.values()])
        return SLOPES @ (values + PER_PITCH * self.pitch**2)


def found_at(pitch):
    """The best fit to a net of that pitch."""
    return Fitted(Model(("thickness",)), Fit(TRUTH - PER_PITCH * pitch**2, np.zeros(POINTS), SLOPES, 0.0))


@pytest.mark.parametrize(("coarse", "fine"), [(4.0, 2.0), (4.0, 3.0)])
def test_the_doubt_is_what_the_finer_net_is_still_off(coarse, fine):
    _, got = refined(OfSecondOrder(coarse), OfSecondOrder(fine), lambda a: a, found_at(coarse))
    np.testing.assert_allclose(got.values, found_at(fine).values)
    np.testing.assert_allclose(got.doubt, np.abs(got.values - TRUTH))


@pytest.mark.parametrize("effect", ["shear-stiffness", "thickness"])
def test_the_last_word_on_relaxed_nets_has_those_that_are_draped_anew(effect):
    """Nets that are taken along keep the cells that they were laid with; what does not relax is never taken along."""

    class Along(OfSecondOrder):
        def draping_anew(self):
            return OfSecondOrder(1.0)

    finer = Along(2.0)
    start = TRUTH if effect == "thickness" else np.array([0.0, 0.0, 0.0, 0.1])
    old = Fitted(Model((effect,)), Fit(start, np.zeros(POINTS), SLOPES, 0.0))
    ended_with, got = refined(OfSecondOrder(4.0), finer, lambda a: a, old)
    assert (ended_with is finer) == (effect == "thickness")
    built = old.model.built(got.values)
    np.testing.assert_allclose(got.fit.residual, SLOPES @ TRUTH - ended_with.predict(built), atol=1e-12)


def test_relaxed_nets_are_taken_along_by_small_steps_and_draped_anew_for_the_last_word():
    part, seed = shapes.sphere_cap(80.0, 60.0, 4.0), (3.0, 2.0, 79.9)
    net = gd.drape(part, seed, pitch=6.0, project=True)
    u, v = (a.ravel() for a in np.meshgrid(np.arange(-45.0, 46.0, 15.0), np.arange(-45.0, 46.0, 15.0)))
    measured = gd.Measurement("marks.csv", net.interpolate(u, v)[0], u, v)
    meant, _ = prepare(part, measured, Layup(seed, 0.0, pitch=None, project=True), 0.1, None, None)

    def effects(du, ratio):
        bent = gd.effects.make("springback", fraction=0.1)
        return [gd.effects.make("placement", du=du), gd.effects.make("shear-stiffness", ratio=ratio), bent]

    def laid(experiment, du, ratio):
        return experiment.draped(effects(du, ratio), experiment.pitches[1])

    first, near, far = laid(meant, 0.1, 0.01), laid(meant, 0.3, 0.0102), laid(meant, 0.3, 0.02)
    assert near.balance.laid is first.balance.laid
    assert far.balance.laid is not first.balance.laid
    assert [e.name for e in near.effects] == [e.name for e in first.effects]
    anew = meant.draping_anew()
    one, other = laid(anew, 0.1, 0.01), laid(anew, 0.3, 0.0102)
    assert one is not first
    assert other.balance.laid is not one.balance.laid
    assert not anew.coarseness
    # springback acts on both
    known = np.isfinite(other.shear) & np.isfinite(near.shear)
    assert np.median(np.abs(other.shear - near.shear)[known]) < 0.1
    assert known.mean() > 0.5


def test_without_a_finer_net_no_doubt_is_known():
    _, got = refined(OfSecondOrder(4.0), OfSecondOrder(4.0), lambda a: a, found_at(6.0))
    np.testing.assert_allclose(got.values, found_at(4.0).values)
    assert got.doubt is None


def test_where_the_finer_net_takes_no_step_no_doubt_is_known(monkeypatch):
    old, net = found_at(4.0), OfSecondOrder(2.0)
    here = net.predict(old.model.built(old.values))
    answers = chain([here], repeat(np.full(POINTS, np.nan)))
    monkeypatch.setattr(net, "predict", lambda effects: next(answers))
    _, got = refined(OfSecondOrder(4.0), net, lambda a: a, old)
    np.testing.assert_array_equal(got.values, old.values)
    assert got.doubt is None


class TwoValleys(WithoutNets):
    """An experiment whose misfit has a valley at a ratio of 0.009 that leaves something, and one at 0.003."""

    pitches, measured = (2.0, 2.0), np.zeros(POINTS)

    def __init__(self):
        self.refused, self.asked = {}, []

    def predict(self, effects):
        *placement, x = [v for e in effects for v in e.values.values()]
        self.asked.append(x)
        off = 1.0 + (x / 0.003 - 3.0) ** 2 if x > 0.006 else 2.0 * (x / 0.003 - 1.0)
        return SLOPES[:, :3] @ placement + off * SLOPES[:, 3]


@pytest.mark.parametrize(("noise", "ratio"), [(0.1, 0.003), (2.0, 0.009)])
def test_less_stiffness_is_tried_where_what_was_found_leaves_more_than_noise(noise, ratio):
    """A soft net on a double bump stayed at 0.0074 for 0.0022, since coarse nets had led there."""
    old = Fitted(Model(("shear-stiffness",)), Fit(np.array([0.0, 0.0, 0.0, 0.0088]), np.zeros(POINTS), SLOPES, 0.0))
    net = TwoValleys()
    _, got = refined(net, net, lambda a: a / noise, old)
    assert got.values[3] == pytest.approx(ratio, rel=0.05)
    assert (min(net.asked) < 0.005) == (ratio == 0.003)


class Smooth(WithoutNets):
    """An experiment whose net is 4 PER_PITCH off on facets, and PER_PITCH where these are rounded."""

    surface, noise = shapes.plane(10.0, 10.0, 5.0), np.full(POINTS, 0.1)

    def __init__(self, off=1.0, lost=0):
        self.off, self.refused, self.lost = off, {}, lost

    def unsmoothed(self):
        return Smooth(4.0, self.lost)

    def predict(self, effects):
        values = np.array([v for e in effects for v in e.values.values()])
        there = SLOPES @ (values + self.off * PER_PITCH)
        there[: self.lost if self.off > 1.0 else 0] = np.nan
        return there


def test_facets_leave_in_doubt_what_rounding_them_has_not_mended():
    got = doubted_for_facets(Smooth(), found_at(4.0))
    np.testing.assert_allclose(got.doubt, np.abs(PER_PITCH))
    more = doubted_for_facets(Smooth(lost=1), replace(found_at(4.0), doubt=np.full(4, 0.5)))
    np.testing.assert_allclose(more.doubt, np.hypot(PER_PITCH, 0.5))


def test_where_facets_predict_little_nothing_is_known_of_their_doubt():
    assert doubted_for_facets(Smooth(lost=POINTS // 2), found_at(4.0)).doubt is None


def test_a_net_is_relaxed_from_the_last_one_whatever_else_acts():
    part = shapes.sphere_cap(80.0, 50.0, 6.0)
    net = gd.drape(part, "centroid", 20.0, 8.0)
    known = np.isfinite(net.points[..., 0])
    u, v = (a[known] for a in np.meshgrid(net.u, net.v, indexing="ij"))
    marks = gd.Measurement("made", net.points[known], u=u, v=v)

    def prepared():
        return prepare(part, marks, Layup("centroid", 20.0, pitch=8.0), sigma_xyz=0.2)[0]

    def acting(offset, ratio):
        return [gd.effects.make("thickness", offset=offset), gd.effects.make("shear-stiffness", ratio=ratio)]

    warm = prepared()
    for effects in (acting(0.5, 0.003), acting(0.0, 0.003), acting(0.6, 0.0032)):
        got = warm.predict(effects)
        np.testing.assert_allclose(got, prepared().predict(effects), atol=1e-3)
    assert len(warm.last) == 2  # with thickness and without


class OfPitch(Smooth):
    """An experiment whose nets are PER_PITCH·pitch² off in every value, on facets or not."""

    def __init__(self, pitch=1.0):
        super().__init__(pitch**2)
        self.pitch, self.pitches = pitch, (pitch, pitch)

    def of_half_pitch(self):
        return OfPitch(0.5 * self.pitch)


def test_what_the_pitch_leaves_in_doubt_is_all_of_its_error():
    old = Fitted(Model(("thickness",)), Fit(TRUTH, np.zeros(POINTS), SLOPES, 0.0), np.full(4, 0.03))
    got = doubted_for_pitch(OfPitch(), old)
    np.testing.assert_allclose(got.doubt, np.hypot(0.03, np.abs(PER_PITCH)))


def test_scatter_on_finer_nets_is_found_anew_if_coarser_ones_had_any(monkeypatch):
    anew = Scatter(0.2, 30.0)
    judge = SimpleNamespace(best_scatter=lambda models, of: ([anew], np.zeros(1)))
    monkeypatch.setattr(last, "judge_of", lambda experiment, rows: judge)
    model, meant, before = fitted("crossing-slip"), experiment((2.0, 8.0)), Scatter(0.5, 20.0)
    assert ended._anew(meant, meant.finer(), model, before) is anew
    assert ended._anew(meant, meant.finer(), model, NO_SCATTER) is NO_SCATTER
    assert ended._anew(meant, meant, model, before) is before


def test_slopes_of_crossings_that_slide_are_of_the_ply_that_is_laid_and_of_what_slides():
    part = shapes.sphere_cap(80.0, 60.0, 4.0)
    seed = (3.0, 2.0, 79.9)
    net = gd.drape(part, seed, pitch=6.0, project=True)
    u, v = (a.ravel() for a in np.meshgrid(np.arange(-45.0, 46.0, 15.0), np.arange(-45.0, 46.0, 15.0)))
    at = net.interpolate(u, v)[0]
    measured = gd.Measurement("marks.csv", at, u, v)
    meant, _ = prepare(part, measured, Layup(seed, 0.0, pitch=None, project=True), 0.1, None, None)

    def effects(du, share):
        made = gd.effects.make
        return [made("placement", du=du), made("crossing-slip", share=share, onset=15.0)]

    here = effects(0.0, 0.3)
    for there in (effects(0.05, 0.3), effects(0.0, 0.31)):
        quick, full = meant.beside(here, there), meant.predict(there) - meant.predict(here)
        assert np.sqrt(np.nanmean((quick - full) ** 2)) < 0.15 * np.sqrt(np.nanmean(full**2))
    assert meant.beside(here, effects(0.05, 0.31)) is None  # one at a time
    skewed = [gd.effects.make("weave-skew", skew=0.2)]
    assert meant.beside(here, [*here, *skewed]) is None  # what changes the shear changes how crossings slide
    assert meant.beside(effects(0.0, 0.0), effects(0.05, 0.0)) is None  # nothing slides
    locks = gd.effects.make("locking", angle=90.0)
    assert meant.beside([*here, locks], [*effects(0.0, 0.31), locks]) is not None  # what is neutral does not count
    assert meant.beside([locks], [locks]) is None


def test_what_is_large_and_soon_made_again_is_not_kept_with_a_diagnosis():
    """Nets are kept: one that is relaxed anew, not from another, may come to rest elsewhere."""
    full = replace(experiment((2.0, 4.0)), surfaces={"": object()}, judges={b"": object()}, costly={"": object()})
    left = full.at_the_end()
    assert not left.surfaces
    assert not left.judges
    assert left.costly is full.costly


def test_a_model_is_settled_with_slopes_of_where_it_ends():
    """It begins several steps away, where the slopes are others."""

    def bent(p):
        return np.array([p[0] + 0.2 * p[0] ** 2, p[1], p[2], p[0] + p[1]])

    def predict(effects):
        return bent(np.array([effects[0].values[name] for name in ("du", "dv", "dangle")]))

    place = np.array([3.0, -1.0, 0.5])
    meant = SimpleNamespace(measured=bent(place), predict=predict, refused={}, beside=lambda *_: None)
    model = Model(())
    start = Fitted(model, Fit(model.neutral, np.zeros(4), np.zeros((4, 3)), 0.0))
    found = settled(meant, lambda a: a / 0.01, start)
    np.testing.assert_allclose(found.values, place, atol=1e-3)
    np.testing.assert_allclose(found.fit.slopes[:, 0], [1.0 + 0.4 * place[0], 0.0, 0.0, 1.0], atol=2e-2)
