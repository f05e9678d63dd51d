"""A diagnosis in words: what to look at, what to do, what to measure next."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.criticism.diagnosis import AMBIGUOUS, UNKNOWN, Value
from geomdrap.criticism.experiment import Experiment
from geomdrap.criticism.leftover import Leftover
from geomdrap.criticism.locked import LOCKING, first_stop
from geomdrap.criticism.model import FAR_ASTRAY, Fitted
from geomdrap.measurement.marks import mark_spacing

if TYPE_CHECKING:
    from geomdrap.criticism.search import Round

SHORTER = 0.001  # strain of yarns that are not as long as they were
ABOUT_A_MARK = 0.35  # of the spacing of the marks: a ply that far off may have its labels off by one
SEEN = {
    "along": "along the warp",
    "across": "across the warp",
    "normal": "off the tool",
    "shear": "in the shear",
    "warp": "in the warp's direction",
    "weft": "in the weft's direction",
}


def hints_for(
    experiment: Experiment,
    rounds: Sequence[Round],
    verdict: str,
    candidates: Sequence[str],
    model: Fitted,
    left: Leftover,
    placement: Sequence[Value],
    stretched: Sequence[Value] = (),
) -> tuple[str, ...]:
    """Sentences for the user; ``stretched`` are the strains of yarns, if the verdict names them."""
    hints = []
    if verdict == AMBIGUOUS and len(candidates) > 1:
        tried = round_with(rounds, candidates[-2:])
        ends = tried.ends or {}
        pair = [ends.get(n, (experiment, tried.trial(n)[0])) for n in candidates[-2:]]
        hints.append(where_they_differ(*pair))
    places = ", ".join(SEEN[c] for c in left.channels) or "everywhere a little"
    if verdict == AMBIGUOUS and left.structured:
        hints.append(f"none of the candidates explains all of it: {left.size:.1f} times the noise is left, {places}")
    stop = first_stop(experiment, rounds[0]) if LOCKING in candidates else None
    if stop is not None:
        hints.append(
            f"the measured shear stops at {stop.angle:.1f}°, where the net without effects shears up to "
            f"{experiment.top_shear:.0f}°"
        )
    if LOCKING in candidates and verdict not in (AMBIGUOUS, UNKNOWN) and left.structured:
        hints.append(
            f"{left.size:.1f} times the noise is left, {places}: a ply whose yarns buckled as it locked rests in one "
            "of many states of like energy, and no model foretells which"
        )
    if LOCKING not in candidates and verdict not in (AMBIGUOUS, UNKNOWN) and left.doubtful:
        hints.append(f"{left.size:.1f} times the noise is left, {places}, {_of_what(left)}")
    if verdict == UNKNOWN:
        hints.append(
            f"something is left that no effect of the library explains, {left.size:.1f} times the noise, {places}"
        )
        hints += trends(experiment, model)
    hints += [*misplaced(experiment, placement), *shortened(stretched)]
    if experiment.measurement.shear is None:
        hints.append("the table has no shear angles: springback and other effects on shear alone cannot be seen")
    if not experiment.measurement.labelled:
        hints.append(
            "the table has no u, v: where marks moved cannot be seen, so yarn-extension and other effects that "
            "hardly change the shear are seen only where they are large; draw a grid on the flat fabric to see them"
        )
    return tuple(f"{hint}." for hint in hints)


def _of_what(left: Leftover) -> str:
    """What a small leftover may be."""
    if left.structured:
        return "which is no noise, but little beside what is explained"
    return (
        f"more than noise and scatter leave as a rule (by chance {left.p_value:.1g}): more points would show whether "
        "that has a cause"
    )


def shortened(stretched: Sequence[Value]) -> list[str]:
    """What yarns that are shorter than they were may stand for, if both families certainly are."""
    if not stretched or not all(v.value + 1.96 * v.sigma < -SHORTER for v in stretched):
        return []
    return [
        "warp and weft are both shorter than they were, which no tension does: a ply or tool that has shrunk, or a "
        "table in a slightly other scale, looks like this"
    ]


def misplaced(experiment: Experiment, placement: Sequence[Value]) -> list[str]:
    """What to check where the ply seems to lie further from its place than a careful lay-up leaves it."""
    limits = zip(placement, FAR_ASTRAY, strict=True)
    # at the end of its range a value is not seen, and as far off as can be
    far = [v for v, most in limits if abs(v.value) > most + (1.96 * v.sigma if np.isfinite(v.sigma) else 0.0)]
    if not far:
        return []
    where = " and ".join(
        f"{v.name} = {v.value:.3g} {v.unit}" if np.isfinite(v.sigma) else f"{v.name} further than can be told"
        for v in far
    )
    marks = (mark_spacing(experiment.measurement.u), mark_spacing(experiment.measurement.v), None)
    pairs = zip(placement, marks, strict=True)
    spacing = [m for v, m in pairs if v in far and m and abs(abs(v.value) / m - 1.0) < ABOUT_A_MARK]
    labels = f", and that no label is off by a mark (they are {spacing[0]:g} mm apart)" if spacing else ""
    check = f"check the origin and the heading that were given{labels}"
    if not experiment.measurement.labelled:
        check += "; without u, v this is less certain than its interval says, as a placement and an effect can make "
        check += "up for each other: a few marks with u, v would show"
    return [f"the model lays the ply {where} off its place: {check}"]


def round_with(rounds: Sequence[Round], names: Sequence[str]) -> Round:
    """The last round in which all these effects were tried: a later one stands on one of them."""
    return next(r for r in reversed(rounds) if {t.model.effects[-1] for t in r.trials} >= set(names))


def where_they_differ(*pair: tuple[Experiment, Fitted]) -> str:
    """What to measure to tell two models, each with its experiment, apart: the place where they differ most."""
    nets = [e.draped(m.model.built(m.values), e.pitches[1]) for e, m in pair]
    u = np.intersect1d(np.round(nets[0].u, 6), np.round(nets[1].u, 6))
    v = np.intersect1d(np.round(nets[0].v, 6), np.round(nets[1].v, 6))
    grid = [(a.ravel()) for a in np.meshgrid(u, v, indexing="ij")]
    (p, g), (q, h) = (net.interpolate(*grid) for net in nets)
    away = np.linalg.norm(p - q, axis=1)
    names = " and ".join(m.model.effects[-1] for _, m in pair)
    if not np.isfinite(away).any():
        return f"{names} explain the measurement equally well"
    k = int(np.nanargmax(away))
    return (
        f"{names} explain the measurement equally well; they differ most at u = {grid[0][k]:.0f}, "
        f"v = {grid[1][k]:.0f} mm, by {away[k]:.2g} mm and {abs(g[k] - h[k]):.2g}° of shear: measure there"
    )


def trends(experiment: Experiment, model: Fitted) -> list[str]:
    """What the leftover goes with."""
    from geomdrap.criticism.compare import compare_net
    from geomdrap.criticism.compare_trends import AGAINST

    net = experiment.draped(model.model.built(model.values))
    comparison = compare_net(net, experiment.measurement, **experiment.noise_told())
    names = {place: words.partition(",")[0] for place, words in AGAINST.items()}
    return [
        f"the {t.kind} residual {'grows' if t.rho > 0 else 'falls'} with {names[t.against]} (rho {t.rho:.2f})"
        for t in comparison.trends
        if t.rho is not None and t.p is not None and t.p < 0.01
    ]
