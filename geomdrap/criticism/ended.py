"""How a search ends: the model found, fitted to the end, those that explain as much, and what it leaves."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import NamedTuple

import numpy as np

from geomdrap.criticism.evidence import MOST, alike_in_what_they_leave, rivals
from geomdrap.criticism.experiment import Experiment
from geomdrap.criticism.final import contenders, final, left_behind, likeliest_scatter, told_apart
from geomdrap.criticism.jackknife import widened
from geomdrap.criticism.leftover import Leftover, leftover
from geomdrap.criticism.likelihood import Residuals, Scatter
from geomdrap.criticism.locked import LOCKING, doubted, locks, shear_stops
from geomdrap.criticism.model import Fitted, Model
from geomdrap.criticism.search import Round, judge_of

WORTH = 0.03  # of the first misfit: what a further effect must explain
MUCH = 0.7  # of what the model before it leaves: a further one may explain this instead, if it needs a cause
UNEXPLAINED = 0.015  # of the first misfit: what the final model may leave where structure is in it


class End(NamedTuple):
    """The end of a search.

    ``experiment`` with the nets of the ``model``, which has the effects ``names`` and leaves ``left`` under its
    ``scatter``; ``alike`` are effects that explain as much as the last of these, itself first, and ``near`` models of
    the others; ``rounds`` as the finer nets see them; ``unexplained``: something is left that needs a cause.
    """

    experiment: Experiment
    rounds: Sequence[Round]
    names: list[str]
    alike: tuple[str, ...]
    near: Mapping[str, Fitted]
    model: Fitted
    scatter: Scatter
    left: Leftover
    unexplained: bool


def chosen(rounds: Sequence[Round]) -> str | None:
    """The effect that the last round adds, None for none: a further one must explain enough.

    That is a good part of the first misfit, or most of what the model before it leaves, if that needs a cause.
    """
    last = rounds[-1]
    found = rivals(last.evidence) if last.ends is None else tuple(last.ends)
    if not found:
        return None
    if len(rounds) > 1:
        first = rounds[0].base.fit.chi2 - len(rounds[0].rows)
        gain = last.base.fit.chi2 - last.trial(found[0])[0].fit.chi2
        explains = _explains(last, found[0], MUCH) and leaves(rounds[0], last.base, UNEXPLAINED)
        if gain < WORTH * first and not explains:
            return None
    return found[0]


def explains_the_rest(last: Round, effect: str | None) -> bool:
    """Whether an effect explains nearly all that a round had left: less may be what nets and facets make."""
    return _explains(last, effect, MOST)


def _explains(last: Round, effect: str | None, share: float) -> bool:
    """Whether an effect explains a share of what a round had left."""
    return any(e.name == effect and e.share >= share for e in last.evidence)


def found_by(rounds: Sequence[Round]) -> tuple[list[str], Fitted, Scatter]:
    """Names of the effects that a search has found, the model with them, and its scatter."""
    added = [chosen(rounds[: k + 1]) for k in range(len(rounds))]
    names = [name for name in added if name is not None]
    if names:
        return names, *rounds[len(names) - 1].trial(names[-1])
    return names, rounds[0].base, rounds[0].scatter[0]


def leaves(first: Round, model: Fitted, share: float) -> bool:
    """Whether a model leaves that share of the first misfit.

    A little is what facets, the pitch and other definitions of the same effect make.
    """
    white = [m.fit.residual[first.rows] / first.judge.noise for m in (first.base, model)]
    both = np.isfinite(white).all(axis=0)  # finer nets may reach less far
    before, after = (float(np.sum(w[both] ** 2 - 1.0)) for w in white)
    return not model.model.effects or not after < share * before


def left_over(experiment: Experiment, model: Fitted, scatter: Scatter) -> Leftover:
    """What a model leaves."""
    rows = np.isfinite(model.fit.residual)
    judge = judge_of(experiment, rows)
    return leftover(experiment, rows, judge, Residuals(model.fit.residual[rows], model.fit.slopes[rows]), scatter)


def _anew(meant: Experiment, experiment: Experiment, model: Fitted, before: Scatter) -> Scatter:
    """The likeliest scatter of a model on nets finer than meant, if there was some ``before``."""
    if before.size == 0.0 or experiment is meant:
        return before  # on coarse nets it also holds what these get wrong, so the search does not start from it
    return likeliest_scatter(experiment, model)


def _last_word(meant: Experiment, experiment: Experiment, model: Fitted, before: Scatter) -> tuple[Scatter, Leftover]:
    """The scatter of a model anew, as of ``_anew``, and what the model leaves under that."""
    scatter = _anew(meant, experiment, model, before)
    return scatter, left_over(experiment, model, scatter)


def _unexplained(first: Round, model: Fitted, left: Leftover) -> bool:
    """Whether a model leaves structure, and so much of it that it needs a cause."""
    return left.structured and leaves(first, model, UNEXPLAINED)


def heard(meant: Experiment, first: Round, last: Round, done: Callable[[str], None]) -> Round:
    """The last round as finer nets see it, with its ``ends``: as of ``told_apart``.

    Where the best leaves what needs a cause, what coarse nets left behind is heard, too.
    """
    if last.ends is not None:
        return last
    hearing = contenders(last.evidence)
    ends, seen = told_apart(meant, last, hearing, done)
    best, (experiment, model) = next(iter(ends.items()))
    behind = left_behind(last.evidence, best, hearing)
    if behind and _unexplained(first, model, _last_word(meant, experiment, model, seen.trial(best)[1])[1]):
        ends, seen = told_apart(meant, last, (*ends, *behind), done, ends)
    return replace(seen, ends=ends)


def best_of(meant: Experiment, last: Round) -> tuple[str, Fitted, Scatter, Leftover]:
    """The best of a round that was heard, fitted to the end, its scatter, and what it leaves."""
    assert last.ends is not None
    best, (experiment, model) = next(iter(last.ends.items()))
    return best, model, *_last_word(meant, experiment, model, last.trial(best)[1])


def ended(meant: Experiment, rounds: Sequence[Round], done: Callable[[str], None]) -> End:
    """The end of a search, in an experiment as it was ``meant``; ``done`` is told each effect that is fitted on."""
    names, model, scatter = found_by(rounds)
    alike: tuple[str, ...] = ()
    ends: Mapping[str, tuple[Experiment, Fitted]] = {}
    if names:
        k = len(names) - 1
        seen = heard(meant, rounds[0], rounds[k], done)
        ends = seen.ends or {}
        alike, rounds = tuple(ends), [*rounds[:k], seen, *rounds[k + 1 :]]
        names, scatter = [*names[:k], alike[0]], seen.trial(alike[0])[1]
    experiment, model = ends[alike[0]] if alike else final(meant, model, scatter)
    scatter, left = _last_word(meant, experiment, model, scatter)
    # a plateau that the model found does not foretell is no matter of chance: nothing else makes one
    if locks(experiment, rounds[0]) and (left.structured or shear_stops(experiment, model, scatter)):
        alike = (LOCKING,)
        if names != [LOCKING]:
            names = [LOCKING]
            model, scatter = rounds[0].trial(LOCKING)
            experiment, model = final(meant, model, scatter)
            scatter, left = _last_word(meant, experiment, model, scatter)
    if LOCKING in names:
        model = doubted(experiment, rounds[0], model)
    model = widened(experiment, model, scatter)
    coarse = {name: rounds[len(names) - 1].trial(name)[1] for name in alike[1:] if name in ends}
    near = {name: widened(*ends[name], _anew(meant, *ends[name], before)) for name, before in coarse.items()}
    unexplained = _unexplained(rounds[0], model, left) and names != [LOCKING]
    if unexplained and len(alike) == 1:
        others = alike_in_what_they_leave(rounds[len(names) - 1].evidence)
        alike = others if names[-1] in others else alike
    if at_an_end(model):
        alike, unexplained = (), True
    return End(experiment, rounds, names, alike, near, model, scatter, left, unexplained)


def at_an_end(model: Fitted) -> bool:
    """Whether the placement lies where its range ends: the ply is then not where this search can find it."""
    low, high = Model(()).bounds
    own = model.values[: len(low)]
    return bool(((own <= low) | (own >= high)).any())
