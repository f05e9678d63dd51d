"""Where a fit of a new effect begins: a few probes of it, weighed beside what the base model can move.

A linear step from nothing does for effects that act in proportion; others have thresholds, one sign, or no slope at
nothing, and are tried at some values first. What takes seconds a drape is looked at before that: where neither
the likely lay-up scatter leaves anything for it to explain, nor it could come near the best model known, it is done:
it is not fitted, and a diagnosis says that it was looked at only.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.criticism.likelihood import is_noise, square_beside
from geomdrap.effects import make

if TYPE_CHECKING:
    from geomdrap.criticism.experiment import Experiment
    from geomdrap.criticism.model import Fitted
    from geomdrap.fishnet import Parameter

Whiten = Callable[[np.ndarray], np.ndarray]

GROWING = (0.3, 1.0, 3.0, 8.0)  # of the typical size of what grows from 0: where the search looks first
FALLING = (0.3, 0.6, 0.9, 1.2, 1.5)  # of the way from a parameter's greatest value to its typical one, likewise
THRESHOLDS = (0.95, 0.8, 0.65, 0.5)  # of the largest shear
SHAPES = (0.05, 0.2, 0.4, 0.6)  # of the range of a parameter that does nothing alone
HALVINGS = 3  # of the gaps between probes
TURNS = (-16.0, -12.0, -8.0, -4.0, 0.0, 4.0, 8.0, 12.0, 16.0)  # degrees: headings that are tried
SAME, SAME_SHARE = 3.0, 0.02  # of chi-square, or of the misfit: probes this close do equally well
NOTHING = 1e-6  # of the noise: less is no signature
BELOW_TOP = (0.85, 0.6)  # of the largest shear: thresholds at which to look once
BELOW_SEEN = (0.5, 0.75)  # of a large value at which an effect shows: where it may begin to
TOO_SMALL = 0.1  # noises, over all values together: a look that shows less shows rounding
ASTRAY = (1.0, 1.0, 1.0)  # mm, mm, degrees: a base this far from where the ply was meant to lie
LEAST_GAIN = 4.0  # of chi-square under the likely scatter: less is not looked into


@dataclass(frozen=True, eq=False)
class Start:
    """Values (p,) of the base and a new effect; ``slopes`` (m, k) of the effect, where a linear fit led to them."""

    values: np.ndarray
    slopes: np.ndarray | None = None


@dataclass(frozen=True, eq=False)
class Glance:
    """One look at an effect: the best of a few ``values`` of its parameters and their ``signature`` (m,).

    ``gain`` is what any multiple of the signature explains under the likely scatter, of chi-square, or the effect
    itself from where the ply was meant to lie; ``after`` the chi-square under the noise alone that would be left.
    """

    values: np.ndarray
    signature: np.ndarray
    gain: float
    after: float


def glance(
    experiment: Experiment,
    predict: Callable[[np.ndarray], np.ndarray],
    whiten: Whiten,
    likely: Whiten,
    base: Fitted,
    effect: str,
) -> Glance:
    """Look at an effect at a few values.

    ``likely`` whitens with the base's likeliest scatter, ``whiten`` with the noise. A costly effect is also looked at
    from where the ply was meant to lie, if the base has gone astray from there.
    """
    residual = np.nan_to_num(base.fit.residual)
    there = experiment.measured - base.fit.residual
    slopes = base.fit.slopes
    before = square_beside(likely(residual), likely(slopes))
    meant = as_meant(base)
    astray = is_astray(base) and make(effect).costly
    seen = []
    for values in _first_looks(make(effect).parameters, experiment.top_shear):
        signature = np.nan_to_num(predict(np.append(base.values, values)) - there)
        both = np.column_stack([slopes, signature])
        gain = before - square_beside(likely(residual), likely(both))
        after = square_beside(whiten(residual), whiten(both))
        if np.linalg.norm(whiten(signature)) <= TOO_SMALL:
            gain = 0.0
        elif astray:
            left = experiment.measured - predict(np.append(meant, values))
            left = np.where(np.isnan(left), residual, left)
            gain = max(gain, before - square_beside(likely(left), likely(slopes)))
            after = min(after, square_beside(whiten(left), whiten(slopes)))
        seen.append(Glance(values, signature, gain, after))
    return max(seen, key=lambda one: one.gain)


def is_astray(base: Fitted, by: tuple[float, float, float] = ASTRAY) -> bool:
    """Whether a base lies elsewhere than the ply was meant to, ``by`` so many mm, mm or degrees."""
    return bool((np.abs(base.values[:3]) > by).any())


def as_meant(base: Fitted) -> np.ndarray:
    """Values (p,) of a base with the ply where it was meant to lie: without the effect it may have gone astray."""
    meant = base.values.copy()
    meant[:3] = 0.0
    return meant


def _first_looks(own: Sequence[Parameter], top: float) -> list[np.ndarray]:
    """Values at which to look once; ``top`` is the largest shear, degrees, below which thresholds act."""
    each = []
    for q in own:
        if q.neutral == q.typical or q.typical < q.neutral == q.high:
            each.append([_clip(f * top, q) for f in BELOW_TOP] if q.unit == "deg" else [q.typical])
        elif len(own) == 1 and q.low < q.neutral:
            each.append([q.typical, 2.0 * q.neutral - q.typical])
        elif len(own) == 1:  # what has a threshold, as a radius that the tool undercuts, shows when it is large
            each.append([q.typical, _clip(GROWING[-1] * q.typical, q)])
        else:
            each.append([q.typical])
    return [np.array(values) for values in product(*each)]


def start_values(
    experiment: Experiment,
    predict: Callable[[np.ndarray], np.ndarray],
    whiten: Whiten,
    base: Fitted,
    effect: str,
    seen: Glance | None = None,
    turns: Sequence[float] = TURNS,
) -> Start:
    """Where to begin: the best of a few probes of the new effect; ``seen``: what one look at it showed.

    ``turns`` are headings, degrees, at which nets that turn as a whole are tried.
    """
    kind = make(effect)
    own, probe = kind.parameters, _Probe(experiment, predict, whiten, base)
    alone = [probe.signature(_only(own, k)) for k in range(len(own))]
    # nets relaxed from other starts differ by rounding even where nothing acts
    sizes = [float(np.abs(whiten(s)).max()) for s in alone]
    acting = [k for k, q in enumerate(own) if sizes[k] > NOTHING and q.typical != q.neutral]
    if len(acting) == len(own) and (len(own) > 1 or own[0].low < own[0].neutral < own[0].high):
        # both signs, a slope at nothing: the linear fit is the start
        slopes = np.column_stack([s / (q.typical - q.neutral) for s, q in zip(alone, own, strict=True)])
        straight = probe.straight(own, slopes)
        if seen is None or not (kind.costly and is_astray(base)):
            return Start(np.append(*straight), slopes)
        turned = _turned(base, seen.values, turns)
        return Start(_best_start(experiment, predict, whiten, base, [straight, *turned]))
    if len(own) == 1:
        best = probe.narrowed(own[0], experiment.top_shear, seen, 1 if kind.costly else HALVINGS)
    else:
        best = min((probe.scaled(shape, own, acting) for shape in _shapes(own, acting)), key=probe.misfit)
    starts = [(base.values, best), (as_meant(base), best)]
    if kind.acts_at_once and not is_noise(base.fit.chi2, len(experiment.measured)):
        starts += _turned(base, np.array([q.typical for q in own]), turns)
    return Start(_best_start(experiment, predict, whiten, base, starts))


class _Probe:
    """What values of a new effect leave on top of a base, beside what the base can move."""

    def __init__(
        self, experiment: Experiment, predict: Callable[[np.ndarray], np.ndarray], whiten: Whiten, base: Fitted
    ) -> None:
        self.predict, self.whiten, self.base = predict, whiten, base
        self.residual = np.nan_to_num(base.fit.residual)
        self.there = experiment.measured - base.fit.residual
        self.shifts = whiten(base.fit.slopes)

    def signature(self, values: np.ndarray) -> np.ndarray:
        """What values (k,) of the effect change (m,)."""
        return np.nan_to_num(self.predict(np.append(self.base.values, values)) - self.there)

    def misfit(self, values: np.ndarray) -> float:
        """The chi-square that values (k,) of the effect leave."""
        return square_beside(self.whiten(self.residual - self.signature(values)), self.shifts)

    def straight(self, own: Sequence[Parameter], slopes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Values of the base and of the effect that fit best, were it linear with these slopes (m, k)."""
        columns = np.column_stack([self.shifts, self.whiten(slopes)])
        step = np.linalg.lstsq(columns, self.whiten(self.residual), rcond=1e-9)[0]
        (low, high), p = self.base.model.bounds, len(self.base.values)
        more = [_clip(q.neutral + s, q) for q, s in zip(own, step[p:], strict=True)]
        return np.clip(self.base.values + step[:p], low, high), np.array(more)

    def narrowed(self, q: Parameter, top: float, seen: Glance | None, halvings: int) -> np.ndarray:
        """The best of a few values (1,) of a parameter; ``top`` as of ``_probes``, ``seen`` what one look showed."""
        now = square_beside(self.whiten(self.residual), self.shifts)
        probes = _probes(q, top)
        if seen is not None and seen.values[0] > q.typical > q.neutral:
            probes = sorted({*probes, *(f * float(seen.values[0]) for f in BELOW_SEEN)})
        same = max(SAME, SAME_SHARE * (now - len(self.residual)))
        return np.array([_narrowed(lambda x: self.misfit(np.array([x])), probes, now, same, halvings)])

    def scaled(self, shape: np.ndarray, own: Sequence[Parameter], acting: Sequence[int]) -> np.ndarray:
        """Values with the acting ones as large as the residual wants them, were their signature linear."""
        columns = np.column_stack([self.shifts, self.whiten(self.signature(shape))])
        factor = float(np.linalg.lstsq(columns, self.whiten(self.residual), rcond=1e-9)[0][-1])
        out = shape.copy()
        for k in acting:
            out[k] = _clip(own[k].neutral + factor * (shape[k] - own[k].neutral), own[k])
        return out


def _only(own: Sequence[Parameter], k: int) -> np.ndarray:
    """Values (p,) of which the k-th is typical and the others do nothing."""
    return np.array([q.typical if n == k else q.neutral for n, q in enumerate(own)])


def _turned(base: Fitted, values: np.ndarray, turns: Sequence[float]) -> list[tuple[np.ndarray, np.ndarray]]:
    """The ply where it was meant to lie, turned by ``turns`` (degrees), with ``values`` of a new effect.

    A relaxed net turns as a whole about its seed, and the heading of its first side holds it but softly.
    """
    meant = as_meant(base)
    return [(np.array([0.0, 0.0, turn, *meant[3:]]), values) for turn in turns]


def _best_start(
    experiment: Experiment,
    predict: Callable[[np.ndarray], np.ndarray],
    whiten: Whiten,
    base: Fitted,
    starts: Sequence[tuple[np.ndarray, np.ndarray]],
) -> np.ndarray:
    """The best of the ``starts``, values of the base and of a new effect, after the step that the base's slopes ask.

    The step is left out where it does no good. What a start does not predict counts as the base left it.
    """
    shifts = whiten(base.fit.slopes)
    low, high = base.model.bounds
    own = slice(None, len(base.values))

    def left(values: np.ndarray) -> np.ndarray:
        residual = experiment.measured - predict(values)
        return whiten(np.nan_to_num(np.where(np.isnan(residual), base.fit.residual, residual)))

    known = [(left(np.append(values, more)), np.append(values, more)) for values, more in starts]
    white, start = min(known, key=lambda one: square_beside(one[0], shifts))
    moved = start.copy()
    moved[own] = np.clip(moved[own] + np.linalg.lstsq(shifts, white, rcond=1e-9)[0], low, high)
    return moved if (left(moved) ** 2).sum() < (white**2).sum() else start


def _narrowed(
    misfit: Callable[[float], float], probes: Sequence[float], now: float, same: float, halvings: int
) -> float:
    """The best of the probes; where none is better than ``now`` by ``same``, after halving the gaps beside the best.

    Of probes that do equally well the last is taken: an effect that does nothing up to a threshold begins there.
    """
    known = {x: misfit(x) for x in probes}
    for _ in range(halvings):
        least = min(known.values())
        if least < now - same:
            break
        best = max(x for x, value in known.items() if value <= least + same)
        order = sorted(known)
        k = order.index(best)
        for a, b in ((k, k + 1), (k - 1, k)):
            if a >= 0 and b < len(order):
                middle = 0.5 * (order[a] + order[b])
                known[middle] = misfit(middle)
    return min(known, key=lambda x: known[x])


def _probes(own: Parameter, top: float) -> list[float]:
    """Values of a one-sided parameter where the search looks first; thresholds of shear lie below its ``top``."""
    if own.typical < own.neutral and own.unit == "deg":
        return sorted({_clip(f * top, own) for f in THRESHOLDS})
    factors = GROWING if own.typical > own.neutral else FALLING
    return sorted({_clip(own.neutral + f * (own.typical - own.neutral), own) for f in factors})


def _shapes(own: Sequence[Parameter], acting: Sequence[int]) -> list[np.ndarray]:
    """Values of the parameters that do nothing alone, over their ranges; the others at their typical sizes."""
    each = [[q.typical] if k in acting else [q.low + f * (q.high - q.low) for f in SHAPES] for k, q in enumerate(own)]
    return [np.array(values) for values in product(*each)]


def _clip(value: float, q: Parameter) -> float:
    return min(max(float(value), q.low), q.high)
