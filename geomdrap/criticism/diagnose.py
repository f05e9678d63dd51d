"""``diagnose``: which physical effect the model lacks.

Placement first; every effect tried on top of it, and fitted together with it where a first look promises something
(see ``start``); the likeliest kept if it passes every test (see ``evidence``); then once more on top of that, if
something is left that needs a cause.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import count
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.criticism.cleaned import cleaned, outliers_of
from geomdrap.criticism.diagnosis import AMBIGUOUS, NONE, PLACEMENT, UNKNOWN, Diagnosis, Step
from geomdrap.criticism.ended import (
    UNEXPLAINED,
    WORTH,
    End,
    at_an_end,
    best_of,
    chosen,
    ended,
    explains_the_rest,
    heard,
    leaves,
    left_over,
)
from geomdrap.criticism.evidence import Evidence, says_the_same
from geomdrap.criticism.experiment import Experiment, flatten
from geomdrap.criticism.final import said_of_coarser
from geomdrap.criticism.fitted_on import refit
from geomdrap.criticism.layup import Layup
from geomdrap.criticism.leftover import Leftover
from geomdrap.criticism.likelihood import Scatter
from geomdrap.criticism.locked import locks
from geomdrap.criticism.model import Fitted, fit_placement, unfitted
from geomdrap.criticism.prepare import prepare
from geomdrap.criticism.search import Round, judge_of, steps_of, try_effects
from geomdrap.criticism.table import tried_of, values_of
from geomdrap.criticism.threads import one_blas_thread
from geomdrap.criticism.words import hints_for
from geomdrap.effects import available, make

if TYPE_CHECKING:
    from geomdrap.fishnet.seed import Origin
    from geomdrap.measurement import Measurement
    from geomdrap.surface import Surface

Progress = Callable[[float, str], None]

MOST_EFFECTS = 2
STRAIN = "yarn-extension"
SHIFTED = 0.5  # mm: a seed that lies further off than this is named
TURNED = 0.4  # degrees: likewise
SUSPECT = 0.75  # mm of scatter: few lay-ups have more, and what smooth effects leave looks like that
CERTAIN = 3.0  # standard deviations of the placement


def diagnose(
    surface: Surface,
    measurement: Measurement,
    *,
    origin: Origin = "centroid",
    angle: float = 0.0,
    pitch: float | None = None,
    sigma_xyz: float | None = None,
    sigma_shear: float | None = None,
    sigma_direction: float | None = None,
    reference: tuple[float, float, float] | None = None,
    project: bool = False,
    effects: Sequence[str] | None = None,
    progress: Progress = lambda share, text: None,
) -> Diagnosis:
    """Say which effect the geometric model lacks, by a measurement of the real ply.

    ``origin``, ``angle`` (degrees), ``reference``, ``project`` and ``pitch`` (mm) as in ``drape``: what the
    person who laid the ply believes. ``sigma_xyz`` mm, ``sigma_shear`` and ``sigma_direction`` degrees: noise of
    single readings where the table has none of its own. ``effects``: names to try, all of the library if None.
    ``progress`` is told the share done and the step.
    Raises MeasurementError where the measurement does not go with the part.
    """
    progress(0.0, "matching")
    layup = Layup(origin, angle, reference, pitch, project)
    asked = [name for name in (available() if effects is None else effects) if name != "placement"]
    names = [name for name in asked if make(name).parameters]
    bare = [f"{name} has no parameters to fit, and was not tried" for name in asked if name not in names]
    with one_blas_thread():
        experiment, notes = prepare(surface, measurement, layup, sigma_xyz, sigma_shear, sigma_direction)
        notes = (*notes, *bare)
        rounds = search(experiment, names, progress)
        passed, clean = 0, cleaned(experiment, rounds[-1].closest)
        if clean is not None:
            rows = flatten(clean.mask, experiment.mask)
            models = [rounds[0].base, *(trial for r in rounds for trial in r.trials)]
            known = [m.only(rows, clean.noise) for m in models]
            passed, experiment, rounds = len(rounds), clean, search(clean, names, progress, len(rounds), known)
        return conclude(experiment, rounds, notes, _refining(progress, passed + len(rounds)))


def search(
    experiment: Experiment,
    names: Sequence[str],
    progress: Progress,
    passed: int = 0,
    known: Sequence[Fitted] = (),
) -> list[Round]:
    """Rounds of the search: the first on the plain net, each further one on the model found before it.

    ``passed`` rounds have been told to ``progress`` before; ``known`` models were fitted before some values were
    dropped.
    """
    whiten = experiment.white
    base = refit(experiment, whiten, known[0]) if known else fit_placement(experiment, whiten)
    rounds: list[Round] = []
    certain = True  # that something is left to find
    while True:
        left = [name for name in names if name not in base.model.effects]
        told = _teller(progress, passed + len(rounds), steps_of(left))
        old = [m for m in known if m.model.effects[:-1] == base.model.effects and m.model.effects]
        rounds.append(try_effects(experiment, base, whiten, left, told, old))
        best = chosen(rounds)
        if not certain and not explains_the_rest(rounds[-1], best):
            return rounds[:-1]
        if best is None or len(rounds) == MOST_EFFECTS or locks(experiment, rounds[0]):
            return rounds
        base, scatter = rounds[-1].trial(best)
        scatter = _lesser(rounds[-1], scatter)
        model, rest = base, left_over(experiment, base, scatter)
        if _needs_more(rounds, model, rest, scatter) and make(best).costly:  # or so says a coarse net
            rounds[-1] = heard(experiment, rounds[0], rounds[-1], _between(progress, passed + len(rounds)))
            best, model, scatter, rest = best_of(experiment, rounds[-1])
            base = rounds[-1].trial(best)[0]
        if not _needs_more(rounds, model, rest, scatter):
            return rounds
        certain = rest.structured


def _lesser(last: Round, scatter: Scatter) -> Scatter:
    """The lesser of a scatter and what the closest model of a round leaves."""
    return min((scatter, last.left), key=last.judge.floor)


def _needs_more(rounds: Sequence[Round], model: Fitted, rest: Leftover, scatter: Scatter) -> bool:
    """Whether a model leaves enough, and perhaps no mere noise, for one more effect to be looked for.

    What would make the verdict ``unknown`` is enough; so large a ``scatter`` may itself be an effect.
    """
    doubtful = rest.doubtful or scatter.size > SUSPECT
    return doubtful and leaves(rounds[0], model, UNEXPLAINED if rest.structured else WORTH)


def _teller(progress: Progress, passed: int, count: int) -> Callable[[str], None]:
    told = iter(range(count))
    # how many rounds there will be is not known: each takes half of what is left
    return lambda name: progress(1.0 - 0.5**passed * (1.0 - 0.5 * next(told) / count), f"trying {name}")


def _between(progress: Progress, passed: int) -> Callable[[str], None]:
    """Likewise for what is fitted on between ``passed`` rounds and the next, if there is one."""
    return lambda name: progress(1.0 - 0.5**passed, f"refining {name}")


def _refining(progress: Progress, passed: int) -> Callable[[str], None]:
    """Likewise for what is fitted on at the end, after ``passed`` rounds."""
    told = count(passed + 1)
    return lambda name: progress(1.0 - 0.5 ** next(told), f"refining {name}")


def conclude(
    experiment: Experiment,
    rounds: Sequence[Round],
    notes: tuple[str, ...],
    done: Callable[[str], None] = lambda name: None,
) -> Diagnosis:
    """The verdict on a finished search. ``done`` is told the name of each effect that is fitted on."""
    end = ended(experiment, rounds, done)
    names, model, scatter, left, rounds = end.names, end.model, end.scatter, end.left, end.rounds
    meant, experiment = experiment, end.experiment
    verdict, candidates = _verdict(end)
    steps = _steps(experiment, rounds, names, model)
    placement = values_of(experiment, model, scatter, "placement")
    stretched = values_of(experiment, model, scatter, STRAIN) if STRAIN in verdict.split("+") else ()
    return Diagnosis(
        verdict=verdict,
        candidates=candidates,
        confidence=_confidence(verdict, rounds, names, left),
        experiment=experiment.at_the_end(),
        steps=steps,
        noise_floor=_floor(experiment, scatter),
        placement=placement,
        tried=tried_of(experiment, rounds, names, model, scatter, end.near),
        effects=tuple(model.model.built(model.values)),
        scatter=scatter,
        leftover=left,
        outliers=outliers_of(experiment, model),
        hints=hints_for(experiment, rounds, verdict, candidates, model, left, placement, stretched),
        notes=(*notes, *said_of_coarser(meant, experiment, model), *_failures(experiment, rounds)),
    )


def _failures(experiment: Experiment, rounds: Sequence[Round]) -> tuple[str, ...]:
    """What could not be tried, or not at all of the values that the search wanted."""
    failed, refused = rounds[0].failed, experiment.refused
    bare = [f"{n} could not be tried: no net with it covers these points" for n in failed if n not in refused]
    said = {n: "could not be tried" if n in failed else "was refused at some values" for n in refused}
    return (*bare, *(f"{n} {what}: {refused[n]}" for n, what in said.items()))


def _verdict(end: End) -> tuple[str, tuple[str, ...]]:
    """Verdict and candidates."""
    names = end.names
    if names and len(end.alike) > 1:
        return AMBIGUOUS, (*names[:-1], *end.alike)
    if end.unexplained:
        return UNKNOWN, () if at_an_end(end.model) else tuple(names)
    if names:
        return "+".join(names), tuple(names)
    if _misplaced(end.experiment, end.model, end.scatter):
        return PLACEMENT, ()
    return NONE, ()


def _misplaced(experiment: Experiment, model: Fitted, scatter: Scatter) -> bool:
    """Whether the ply certainly lies elsewhere than meant, by more than a good lay-up does."""
    limits = {"du": SHIFTED, "dv": SHIFTED, "dangle": TURNED}
    return any(
        abs(v.value) > max(limits[v.name], CERTAIN * v.sigma)
        for v in values_of(experiment, model, scatter, "placement")
    )


def _steps(experiment: Experiment, rounds: Sequence[Round], names: Sequence[str], last: Fitted) -> tuple[Step, ...]:
    from geomdrap.criticism.table import errors_of

    plain = unfitted(experiment)
    models = [plain, rounds[0].base, *(rounds[k].trial(name)[0] for k, name in enumerate(names))]
    if names:
        models[-1] = last
    added = [None, "placement", *names]
    return tuple(Step(name, *errors_of(experiment, model)) for name, model in zip(added, models, strict=True))


def _floor(experiment: Experiment, scatter: Scatter) -> float:
    """Error over the noise of a model that is right: the noise, and the scatter that no model foretells."""
    return judge_of(experiment, np.ones(len(experiment.noise), bool)).floor(scatter)


def _confidence(verdict: str, rounds: Sequence[Round], names: Sequence[str], left: Leftover) -> float:
    """Weight of the answer among all that were tried, 0 to 1 (G. Schwarz's criterion, 1978)."""
    if verdict == UNKNOWN:
        return 1.0 - min(left.p_value, 1.0)
    last = rounds[max(len(names) - 1, 0)]
    price = float(np.log(last.rows.sum()))
    others = [e for e in last.evidence if e.name in names or _says_another_thing(e, names, last.evidence)]
    scores = {e.name: e.gain - e.unknowns * price for e in others}
    own = scores.pop(names[-1]) if names else 0.0
    rest = [*scores.values(), 0.0] if names else list(scores.values())
    return float(1.0 / (1.0 + sum(np.exp(min(0.5 * (s - own), 50.0)) for s in rest)))


def _says_another_thing(one: Evidence, names: Sequence[str], all_of: Sequence[Evidence]) -> bool:
    """Whether an effect that was not found says another thing than those that were, with values that can be."""
    with_more = bool(names) and names[-1] in one.includes
    return one.in_range and not with_more and not says_the_same(one, all_of)
