"""What speaks for an effect, and when that is enough.

An effect is found where it passes all of these: it is likelier than chance, corrected for the number that was tried
(S. Holm, 1979); it foretells held-out blocks better; it explains a good share of the misfit; its size is possible and
its interval leaves out nothing. One test alone finds effects in noise.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

FAMILY = 0.02  # chance of finding anything where there is nothing
FORETELLS = 0.99  # of the held-out error without the effect
LEAST_SHARE = 0.15  # of the misfit above the noise: a smaller one is listed, not named
RIVAL = 6.0  # of 2 log-likelihood: effects this close to the best cannot be told from it
RIVAL_WITHIN = 20.0  # the same, of an effect that the best comes to at small values
RIVAL_SHARE = 0.01  # of what the best explains: nor those that explain all but this much of it
MOST, AS_MUCH = 0.9, 2.0  # share of the misfit that is nearly all of it, and times what the best leaves of it


@dataclass(frozen=True)
class Evidence:
    """What speaks for one effect.

    ``gain``: twice the log of how much likelier the measurement is with it; ``unknowns`` that it adds; ``p_value``
    of such a gain by chance, alone and (``p_family``) among all that were tried; ``share`` of the misfit above the
    noise that it explains; ``cv_ratio`` of held-out errors with and without it; ``in_range``: no parameter at a bound
    where physics ends, and not all of them as good as nothing; ``includes`` names effects that it comes to at small
    values.
    """

    name: str
    gain: float
    unknowns: int
    p_value: float
    p_family: float
    share: float
    cv_ratio: float
    in_range: bool
    includes: tuple[str, ...] = ()

    @property
    def found(self) -> bool:
        """Whether it passes every test."""
        return (
            self.p_family < FAMILY
            and self.gain > 2.0 + self.unknowns * math.log(10.0)
            and self.share >= LEAST_SHARE
            and self.cv_ratio < FORETELLS
            and self.in_range
        )


def chance(gain: float, unknowns: int) -> float:
    """Probability of a gain as large by chance (S. S. Wilks, 1938)."""
    from scipy.special import chdtrc

    return float(chdtrc(unknowns, max(gain, 0.0)))


def among_all(p_values: Sequence[float]) -> np.ndarray:
    """Probabilities (k,) corrected for the number of tests after Holm."""
    p = np.asarray(p_values, dtype=float)
    order = np.argsort(p)
    factors = len(p) - np.arange(len(p))
    corrected = np.minimum(np.maximum.accumulate(p[order] * factors), 1.0)
    out = np.empty(len(p))
    out[order] = corrected
    return out


def rivals(evidence: Sequence[Evidence], share: float = RIVAL_SHARE) -> tuple[str, ...]:
    """The best effect found, and those that cannot be told from it, the best first; empty if none was found.

    What does no better than the best, and comes to it at small values, is no rival: it says the same with more. If
    such an effect is the best, what it comes to must be clearly less likely to be no rival. Nor are those rivals that
    explain less than all but a ``share`` of what the best does.
    """
    found = sorted((e for e in evidence if e.found), key=lambda e: e.unknowns * 2.0 - e.gain)
    if not found:
        return ()
    best = found[0]
    margin = max(RIVAL, share * best.gain)
    near = []
    for e in found:
        behind = best.gain - 2.0 * best.unknowns - (e.gain - 2.0 * e.unknowns)
        enough = max(margin, RIVAL_WITHIN) if e.name in best.includes else margin
        if behind < enough and best.name not in e.includes:
            near.append(e.name)
    return tuple(near)


def alike_in_what_they_leave(evidence: Sequence[Evidence]) -> tuple[str, ...]:
    """Effects that explain nearly all of the misfit, and leave about as little of it as the best of them, best first.

    For where the best leaves structure: no model of it is exact then, and likelihood, which takes models at their
    word, tells effects apart by what the models lack.
    """
    found = sorted((e for e in evidence if e.found and e.share >= MOST), key=lambda e: -e.share)
    near = [e for e in found if 1.0 - e.share <= AS_MUCH * (1.0 - found[0].share)]
    return tuple(e.name for e in near if not says_the_same(e, near))


def says_the_same(one: Evidence, others: Sequence[Evidence]) -> bool:
    """Whether an effect comes to one of others at small values, and does no better or has such values."""
    return any(other.name in one.includes and (other.gain >= one.gain or not one.in_range) for other in others)
