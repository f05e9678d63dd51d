"""What makes one drape better than another."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple

from geomdrap.errors import SweepError
from geomdrap.sweep.row import Row

ENOUGH = 0.995  # of the part: a drape with less is incomplete, as in ``geomdrap drape --strict``
PER_PERCENT_BARE = 10.0  # by how much a per cent of the part left bare counts, in the criterion's own measure


class Criterion(NamedTuple):
    """A number to be small: its unit, words for it, how it is read from a row, below which difference it is the same,
    and what a per cent of the part left bare adds to it.
    """

    unit: str
    words: str
    of: Callable[[Row], float]
    same: Callable[[Row], float]
    per_percent: Callable[[Row], float]


def _plain(unit: str, words: str, of: Callable[[Row], float]) -> Criterion:
    return Criterion(unit, words, of, lambda row: 0.1, lambda row: PER_PERCENT_BARE)


def _area(words: str, of: Callable[[Row], float]) -> Criterion:
    return Criterion(
        "mm²", words, of, lambda row: 1e-3 * row.part_area, lambda row: 0.01 * PER_PERCENT_BARE * row.part_area
    )


CRITERIA = {
    "max-shear": _plain("°", "largest shear", lambda row: row.max_shear),
    "p95-shear": _plain("°", "shear, 95th percentile", lambda row: row.p95_shear),
    "mean-shear": _plain("°", "mean shear", lambda row: row.mean_shear),
    "over-limit": _plain("%", "over the limit angle", lambda row: 100.0 * row.over_limit),
    "coverage": _plain("%", "bare", lambda row: 100.0 * (1.0 - row.coverage))._replace(per_percent=lambda row: 0.0),
    "fabric-area": _area("fabric", lambda row: row.fabric_area),
    "blank-area": _area("rectangular blank", lambda row: row.blank_area),
    "waste": _plain("%", "waste of the blank", lambda row: 100.0 * row.waste),
}
DEFAULT = "max-shear"
PARETO = ("p95-shear", "coverage", "blank-area")


@dataclass(frozen=True)
class Objective:
    """A criterion, or a weighted sum of several, to be small; what is bare counts in each of them."""

    weights: tuple[tuple[str, float], ...]

    @classmethod
    def parse(cls, text: str) -> Objective:
        """An objective as written: ``p95-shear``, or ``p95-shear=1,waste=0.5``.

        Raises SweepError for unknown criteria, and for weights that are no positive numbers.
        """
        weights = [_weight(part.strip(), text) for part in text.split(",")]
        if len({name for name, _ in weights}) < len(weights):
            raise SweepError(f"objective {text!r}: name each criterion once")
        return cls(tuple(weights))

    def __str__(self) -> str:
        if len(self.weights) == 1 and self.weights[0][1] == 1.0:
            return self.weights[0][0]
        return ",".join(f"{name}={weight:g}" for name, weight in self.weights)

    def score(self, row: Row) -> float:
        """What is to be small; infinite for a case that failed.

        Each per cent of the part left bare beyond 0.5 % counts as 10 degrees, 10 points or 10 % of the part's area.
        """
        if row.reason is not None:
            return math.inf
        bare = 100.0 * max(0.0, ENOUGH - row.coverage)
        chosen = ((CRITERIA[name], weight) for name, weight in self.weights)
        return sum(weight * (c.of(row) + c.per_percent(row) * bare) for c, weight in chosen)


def _weight(part: str, whole: str) -> tuple[str, float]:
    name, equals, number = (piece.strip() for piece in part.partition("="))
    require_criterion(name, f"objective {whole!r}")
    try:
        weight = float(number) if equals else 1.0
    except ValueError:
        weight = math.nan
    if not (math.isfinite(weight) and weight > 0.0):
        raise SweepError(f"objective {whole!r}: {part!r} is not NAME=WEIGHT with a positive weight")
    return name, weight


def parse_criteria(text: str) -> tuple[str, ...]:
    """Names of criteria with commas between. Raises SweepError for unknown ones."""
    names = tuple(name.strip() for name in text.split(","))
    for name in names:
        require_criterion(name, f"criteria {text!r}")
    return names


def require_criterion(name: str, where: str) -> None:
    """Raise SweepError, with the names there are, for what is no criterion."""
    if name not in CRITERIA:
        raise SweepError(f"{where}: there is no criterion {name!r}; they are {', '.join(CRITERIA)}")
