"""The model found, fitted to the end: on finer nets, if its drapes are costly, which also tell rivals apart.

On a coarse net a model of another effect may do as well, for what it makes up of the pitch.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from geomdrap.criticism.evidence import MOST, RIVAL_SHARE, Evidence, rivals
from geomdrap.criticism.experiment import Experiment, restless
from geomdrap.criticism.fitted_on import doubted_for_facets, doubted_for_pitch, refined, settled
from geomdrap.criticism.likelihood import Residuals, Scatter
from geomdrap.criticism.model import Fitted, relaxes
from geomdrap.criticism.search import Round, judge_of
from geomdrap.effects import make

ELSEWHERE = 1.5  # of the chi-square on the coarser net: a finer one that fits worse came to rest elsewhere
NOT_FAR = 0.5  # of what the best explains on coarse nets: what explains as much may do better on finer ones
FINER = 4.0  # times smaller are the errors of a net of half the pitch


def final(experiment: Experiment, model: Fitted, scatter: Scatter) -> tuple[Experiment, Fitted]:
    """The model fitted to the end, under the scatter that it leaves, and the experiment with the nets for that.

    A finer net that fits much worse came to rest in another place, and tells nothing of the values; nor does one that
    does not come to rest.
    """
    rows = np.isfinite(model.fit.residual)
    whole = bool(rows.all())
    whiten = judge_of(experiment, rows).whiten(scatter) if whole else experiment.white
    if any(make(name).costly for name in model.model.effects):
        finer = experiment.finer()
        if not rests(finer, model):
            return experiment, doubted_for_facets(experiment, model)
        finer, better = refined(experiment, finer, whiten, model)
        before = float((whiten(np.nan_to_num(model.fit.residual)) ** 2).sum())
        kept, model = (finer, better) if better.fit.chi2 <= ELSEWHERE * before else (experiment, model)
        return kept, doubted_for_facets(experiment, model)
    model = doubted_for_facets(experiment, settled(experiment, whiten, model))
    return experiment, doubted_for_pitch(experiment, model) if model.model.effects else model


def said_of_coarser(meant: Experiment, last: Experiment, model: Fitted) -> tuple[str, ...]:
    """A sentence where values had to be left to the coarser net."""
    if last is not meant or not any(make(name).costly for name in model.model.effects):
        return ()
    return (
        f"the values of {' and '.join(model.model.effects)} are those of a net of {meant.pitches[1]:g} mm: a finer "
        "one came to rest elsewhere or not at all, so their intervals are too narrow",
    )


def rests(experiment: Experiment, model: Fitted) -> bool:
    """Whether the net of a costly model comes to rest."""
    return not restless(experiment.draped(model.model.built(model.values), experiment.pitches[1]))


def contenders(evidence: Sequence[Evidence]) -> tuple[str, ...]:
    """The rivals, the best first, and what that comes to at small values, where it explains nearly all.

    The pitch of a coarse net looks like a little more of the best, as of yarns that resist bending: finer nets tell.
    """
    near = rivals(evidence)
    of = {e.name: e for e in evidence}
    less = [of[name] for name in (of[near[0]].includes if near else ()) if name in of and name not in near]
    return (*near, *(e.name for e in less if e.found and e.share >= MOST))


def left_behind(evidence: Sequence[Evidence], best: str, heard: Collection[str]) -> tuple[str, ...]:
    """Effects on relaxed nets, not ``heard`` yet, that coarse nets left behind another one of them, the ``best``.

    A saddle that resisted shear was bent yarns to coarse nets, seven hundred of chi-square better; on finer ones
    these left structure, and stiffness nothing.
    """
    of = {e.name: e for e in evidence}
    near = [e for e in evidence if e.found and e.name not in heard and e.share >= NOT_FAR * of[best].share]
    return tuple(e.name for e in near if relaxes(e.name)) if relaxes(best) else ()


def told_apart(
    experiment: Experiment,
    last: Round,
    alike: Sequence[str],
    done: Callable[[str], None],
    known: Mapping[str, tuple[Experiment, Fitted]] = MappingProxyType({}),
) -> tuple[dict[str, tuple[Experiment, Fitted]], Round]:
    """The contenders ``alike`` that finer nets leave, the best first, fitted to the end; the round as those see it.

    ``last`` is the round of the search that found them. What nets on which costly ones could not be fitted do not
    tell apart stays as it was. What comes to another one at small values is not fitted on where that leaves but
    noise, under the scatter of the other. ``done`` is told each name; ``known`` were fitted to the end before.
    """
    ends = dict(known)
    new = [name for name in alike if name not in known]
    for name in sorted(new, key=lambda name: not set(alike).isdisjoint(make(name).includes)):
        scatter = last.trial(name)[1]
        if not any(_is_enough(experiment, *ends[less], scatter) for less in make(name).includes if less in ends):
            done(name)
            ends[name] = final(experiment, *last.trial(name))
    last = replace(last, evidence=_no_better(last.evidence, [name for name in alike if name not in ends]))
    costly = [name for name in ends if make(name).costly]
    if len(ends) < 2 or not costly or any(ends[name][0] is experiment for name in costly):
        return {name: ends[name] for name in rivals([e for e in last.evidence if e.name in ends])}, last
    rows = np.all([np.isfinite(model.fit.residual) for _, model in ends.values()], axis=0)
    whiten = judge_of(experiment, rows).whiten(last.trial(alike[0])[1])
    square = {name: float((whiten(model.fit.residual[rows]) ** 2).sum()) for name, (_, model) in ends.items()}
    seen = replace(last, evidence=_as_seen(last.evidence, square))
    margin = RIVAL_SHARE / FINER
    return {name: ends[name] for name in rivals([e for e in seen.evidence if e.name in square], margin)}, seen


def _is_enough(experiment: Experiment, finer: Experiment, model: Fitted, scatter: Scatter) -> bool:
    """Whether a model leaves but noise on nets finer than those of the experiment: more of it would say no more.

    Under the ``scatter`` that more of it leaves on coarse nets, or its own if that is less: the larger one may hide
    what it lacks. And by one standard deviation, since three of them have room for a parameter.
    """
    if finer is experiment:
        return False
    rows = np.isfinite(model.fit.residual)
    judge = judge_of(finer, rows)
    if scatter.size > 0.0:
        scatter = min((scatter, likeliest_scatter(finer, model)), key=judge.floor)
    white = judge.whiten(scatter)(model.fit.residual[rows])
    count = int(rows.sum())
    return float((white**2).sum()) < count + math.sqrt(2.0 * count)


def likeliest_scatter(experiment: Experiment, model: Fitted) -> Scatter:
    """The likeliest lay-up scatter of a model alone."""
    rows = np.isfinite(model.fit.residual)
    residuals = Residuals(model.fit.residual[rows], model.fit.slopes[rows])
    return judge_of(experiment, rows).best_scatter([residuals], [0])[0][0]


def _no_better(evidence: Sequence[Evidence], names: Sequence[str]) -> tuple[Evidence, ...]:
    """Evidence in which effects are no likelier than what they come to at small values."""
    of = {e.name: e for e in evidence}
    return tuple(
        replace(e, gain=min([e.gain, *(of[less].gain for less in e.includes if less in of)]))
        if e.name in names
        else e
        for e in evidence
    )


def _as_seen(evidence: Sequence[Evidence], square: Mapping[str, float]) -> tuple[Evidence, ...]:
    """Evidence with the rivals' gains and shares as far apart as their chi-squares ``square`` on finer nets are."""
    of = {e.name: e for e in evidence}
    best = of[min(square, key=lambda name: square[name] + 2.0 * of[name].unknowns)]
    gain, share = (max(getattr(of[name], what) for name in square) for what in ("gain", "share"))
    behind = {name: square[name] - square[best.name] for name in square}
    return tuple(
        replace(e, gain=gain - behind[e.name], share=share * (1.0 - behind[e.name] / gain)) if e.name in behind else e
        for e in evidence
    )
