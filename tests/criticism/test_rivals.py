"""Rivals on coarse nets, told apart by finer ones; what coarse nets left behind is heard there, too."""

from __future__ import annotations

from dataclasses import replace
from importlib import import_module
from types import SimpleNamespace

import numpy as np
import pytest
from without_part import POINTS, experiment, fitted

from geomdrap.criticism.evidence import Evidence
from geomdrap.criticism.likelihood import NO_SCATTER, Scatter
from geomdrap.criticism.search import Round

diagnose = import_module("geomdrap.criticism.diagnose")
ended = import_module("geomdrap.criticism.ended")
last = import_module("geomdrap.criticism.final")

@pytest.mark.parametrize(
    ("behind", "coarse", "left"),
    [
        (9.0, False, ["shear-asymmetry"]),
        (4.0, False, ["shear-asymmetry", "shear-stiffness"]),
        (9.0, True, ["shear-stiffness", "shear-asymmetry"]),
    ],
)
def test_rivals_on_a_coarse_net_are_told_apart_by_finer_ones(monkeypatch, behind, coarse, left):
    meant, finer = experiment((1.0, 8.0)), experiment((1.0, 4.0))
    names = ("shear-stiffness", "shear-asymmetry")
    evidence = tuple(Evidence(n, g, 1, 0.0, 0.0, 0.9, 0.5, True) for n, g in zip(names, (900.0, 899.0), strict=True))
    trials = tuple(fitted(n) for n in names)
    of = Round(fitted(), trials, evidence, (NO_SCATTER,) * 3, np.ones(POINTS, bool), None, 1.0, ())
    chi2 = {names[0]: 12.0 + behind, names[1]: 12.0}

    def final(experiment, model, scatter):
        residual = np.full(POINTS, np.sqrt(chi2[model.model.effects[0]] / POINTS))
        rested = experiment if coarse and model.model.effects == names[:1] else finer
        return rested, replace(model, fit=replace(model.fit, residual=residual))

    monkeypatch.setattr(last, "final", final)
    told = []
    ends, seen = last.told_apart(meant, of, names, told.append)
    assert told == list(names)
    assert list(ends) == left
    gains = {e.name: e.gain for e in seen.evidence}
    # confidence weighs by these
    assert gains[names[1]] - gains[names[0]] == pytest.approx(-1.0 if coarse else behind)


@pytest.mark.parametrize("left", [12.0, 18.0])
def test_more_of_what_leaves_but_noise_on_finer_nets_is_not_fitted_on(monkeypatch, left):
    """Yarn-bending of a small length is shear stiffness: it took longest, and could only say the same."""
    names = ("yarn-bending", "shear-stiffness")
    includes = {"yarn-bending": ("shear-stiffness",)}
    evidence = tuple(
        Evidence(n, g, 1, 0.0, 0.0, 0.9, 0.5, True, includes.get(n, ()))
        for n, g in zip((*names, "locking"), (940.0, 900.0, 910.0), strict=True)
    )
    trials = tuple(fitted(n) for n in names)
    of = Round(fitted(), trials, evidence, (NO_SCATTER,) * 3, np.ones(POINTS, bool), None, 1.0, ())
    told = []

    def final(experiment, model, scatter):
        residual = np.full(POINTS, np.sqrt(left / POINTS))
        return experiment.finer(), replace(model, fit=replace(model.fit, residual=residual))

    monkeypatch.setattr(last, "final", final)
    ends, seen = last.told_apart(experiment((1.0, 8.0)), of, names, told.append)
    assert told == ["shear-stiffness", "yarn-bending"][: 1 if left == 12.0 else 2]
    if left == 12.0:  # locking, which finer nets were not asked of, is not likelier than what they leave of the best
        assert list(ends) == ["shear-stiffness"]
        gains = {e.name: e.gain for e in seen.evidence}
        assert gains["yarn-bending"] == gains["shear-stiffness"] == 900.0  # else it would weigh in the confidence


@pytest.mark.parametrize(("behind", "share", "asked"), [(60.0, 0.99, True), (5.0, 0.99, True), (60.0, 0.8, False)])
def test_what_the_best_comes_to_at_small_values_is_asked_of_finer_nets_too(behind, share, asked):
    """On a coarse net a little bending makes up for the pitch: shear stiffness was called yarn-bending."""
    best = Evidence("yarn-bending", 900.0, 1, 0.0, 0.0, 0.99, 0.5, True, ("shear-stiffness",))
    less = Evidence("shear-stiffness", 900.0 - behind, 1, 0.0, 0.0, share, 0.5, True)
    assert last.contenders((less, best)) == ("yarn-bending", "shear-stiffness")[: 1 + asked]
    assert last.contenders((less,)) == ("shear-stiffness",)
    assert last.contenders(()) == ()


def test_what_is_but_noise_under_a_large_scatter_of_its_own_is_not_enough(monkeypatch):
    """Bent yarns on a dome passed for stiffness with a millimetre of scatter, which they do not need."""
    meant, names = replace(experiment((1.0, 8.0)), channels=("along",)), ("yarn-bending", "shear-stiffness")
    best = Evidence(names[0], 900.0, 1, 0.0, 0.0, 0.99, 0.5, True, names[1:])
    less = Evidence(names[1], 700.0, 1, 0.0, 0.0, 0.95, 0.5, True)
    trials, scatter = tuple(map(fitted, names)), (NO_SCATTER, NO_SCATTER, Scatter(10.0, 60.0))
    of = Round(fitted(), trials, (best, less), scatter, np.ones(POINTS, bool), None, 1.0, ())

    def final(experiment, model, scatter):  # residuals four times the noise
        return experiment.finer(), replace(model, fit=replace(model.fit, residual=np.full(POINTS, 4.0)))

    monkeypatch.setattr(last, "final", final)
    told = []
    last.told_apart(meant, of, names, told.append)
    assert told == ["shear-stiffness", "yarn-bending"]


@pytest.mark.parametrize(("left", "heard"), [(1.0, False), (9.0, True)])
def test_what_coarse_nets_left_behind_is_heard_where_the_best_leaves_structure(monkeypatch, left, heard):
    """A saddle that resists shear was bent yarns to coarse nets."""
    meant = experiment((1.0, 8.0))
    shares = {"yarn-bending": 0.82, "shear-stiffness": 0.48, "shear-asymmetry": 0.3, "steering": 0.8}
    evidence = tuple(Evidence(n, 400.0 * s, 1, 0.0, 0.0, s, 0.5, True) for n, s in shares.items())
    of = Round(fitted(), tuple(map(fitted, shares)), evidence, (NO_SCATTER,) * 5, np.ones(POINTS, bool), None, 1.0, ())
    told = []

    def final(experiment, model, scatter):
        chi2 = left if model.model.effects == ("yarn-bending",) else 1.0
        residual = np.full(POINTS, np.sqrt(chi2 / POINTS))
        return experiment.finer(), replace(model, fit=replace(model.fit, chi2=chi2, residual=residual))

    monkeypatch.setattr(last, "final", final)
    monkeypatch.setattr(ended, "left_over", lambda *_: SimpleNamespace(structured=True))
    monkeypatch.setattr(ended, "leaves", lambda first, model, share: model.fit.chi2 > 5.0)
    seen = ended.heard(meant, of, of, told.append)
    assert told == ["yarn-bending", "shear-stiffness"][: 1 + heard]
    assert next(iter(seen.ends)) == told[-1]
    assert ended.heard(meant, of, seen, told.append) is seen  # it was heard


@pytest.mark.parametrize(
    ("effect", "finer", "tried", "refined"),
    [
        ("yarn-bending", False, 1, 1),  # the pitch was the doubt
        ("yarn-bending", True, 2, 1),
        ("slip", True, 2, 0),  # no net of it is too coarse
    ],
)
def test_a_doubt_that_a_coarse_net_leaves_is_settled_on_a_finer_one_first(
    monkeypatch, effect, finer, tried, refined
):
    """Bent yarns on a dome had a second round, ten seconds long, for what a net of half the pitch did not leave."""
    meant, rounds, told = experiment((1.0, 8.0)), [], []

    def try_effects(experiment, base, whiten, names, done, known):
        found = () if rounds else (Evidence(effect, 900.0, 1, 0.0, 0.0, 0.9, 0.5, True),)
        trials = () if rounds else (fitted(effect),)
        rows, scatter = np.ones(POINTS, bool), (NO_SCATTER,) * (1 + len(trials))
        judge = SimpleNamespace(floor=lambda scatter: scatter.size, noise=np.ones(POINTS))
        rounds.append(Round(base, trials, found, scatter, rows, judge, 1.0, ()))
        return rounds[-1]

    def final(experiment, model, scatter):
        return experiment.finer(), replace(model, fit=replace(model.fit, chi2=1.0))

    def left_over(experiment, model, scatter):
        doubt = finer or experiment is meant
        return SimpleNamespace(structured=doubt, doubtful=doubt)

    monkeypatch.setattr(last, "final", final)
    monkeypatch.setattr(diagnose, "fit_placement", lambda *_: fitted())
    monkeypatch.setattr(diagnose, "try_effects", try_effects)
    monkeypatch.setattr(diagnose, "locks", lambda *_: False)
    for module in (ended, diagnose):
        monkeypatch.setattr(module, "left_over", left_over)
        monkeypatch.setattr(module, "leaves", lambda *_: True)
    got = diagnose.search(meant, ["yarn-bending", "slip"], lambda share, text: told.append((share, text)))
    assert (len(rounds), len(got)) == (tried, tried)
    assert [text for _, text in told] == [f"refining {effect}"] * refined
    assert (got[0].ends is not None) == bool(refined)
    assert all(0.5 <= share < 1.0 for share, _ in told)


def test_values_that_a_model_does_not_predict_do_not_make_it_closer():
    """Its own chi-square is of the values that it predicts: the scatter of all was judged by it."""
    whole, part = fitted("slip"), fitted("locking")
    whole = replace(whole, fit=replace(whole.fit, residual=np.full(POINTS, 2.0), chi2=4.0 * POINTS))
    lost = np.where(np.arange(POINTS) < 3, np.nan, 2.1)
    part = replace(part, fit=replace(part.fit, residual=lost, chi2=2.1**2 * (POINTS - 3)))
    base = replace(fitted(), fit=replace(fitted().fit, residual=np.full(POINTS, 9.0), chi2=81.0 * POINTS))
    judge = SimpleNamespace(noise=np.ones(POINTS - 3))
    scatter = (NO_SCATTER, Scatter(0.1, 20.0), Scatter(0.9, 20.0))
    of = Round(base, (whole, part), (), scatter, np.isfinite(lost), judge, 1.0, ())
    assert of.closest is whole
    assert of.left is scatter[1]


@pytest.mark.parametrize(("left", "leaves"), [(1.0, False), (4.0, True)])
def test_values_that_only_a_finer_net_lacks_are_no_reason_for_a_further_effect(left, leaves):
    base = replace(fitted(), fit=replace(fitted().fit, residual=np.full(POINTS, 5.0)))
    judge = SimpleNamespace(noise=np.ones(POINTS))
    first = Round(base, (), (), (NO_SCATTER,), np.ones(POINTS, bool), judge, 1.0, ())
    residual = np.where(np.arange(POINTS) == 2, np.nan, left)
    model = fitted("slip")
    assert ended.leaves(first, replace(model, fit=replace(model.fit, residual=residual)), 0.1) is leaves
