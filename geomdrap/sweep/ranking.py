"""Rows in the order of an objective, and those that no other row beats in everything."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from geomdrap.sweep.objective import CRITERIA, Objective
from geomdrap.sweep.row import Row


def ranked(rows: Sequence[Row], objective: Objective) -> tuple[Row, ...]:
    """The rows, the best first; equal ones in the order in which they come, failed ones at the end."""
    return tuple(sorted(rows, key=objective.score))


def pareto_front(rows: Sequence[Row], names: Sequence[str]) -> tuple[Row, ...]:
    """The rows, in their order, than which none is better in one of the criteria and as good in all others.

    Differences that nobody could measure make no row better: 0.1 degrees, 0.1 per cent, 0.1 % of the part's area.
    Of rows that are the same by that all are kept.
    """
    good = [row for row in rows if row.reason is None]
    if not good:
        return ()
    criteria = [CRITERIA[name] for name in names]
    values = np.round(np.array([[c.of(row) / c.same(row) for c in criteria] for row in good]))
    beaten = [bool(((values <= v).all(axis=1) & (values < v).any(axis=1)).any()) for v in values]
    return tuple(row for row, is_beaten in zip(good, beaten, strict=True) if not is_beaten)


def best_of_origins(rows: Sequence[Row]) -> list[Row]:
    """The best of ``rows``, ranked, at each origin at which one could be draped."""
    found: dict[object, Row] = {}
    for row in rows:
        if row.reason is None:
            found.setdefault(row.asked, row)
    return list(found.values())
