"""The readable summary of an optimum."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

from geomdrap.cli.sweep_summary import HEAD, cells

if TYPE_CHECKING:
    from geomdrap.sweep import Optimum


def summary(optimum: Optimum, files: Mapping[str, Path]) -> str:
    """Give the summary as text: the best drape beside the best of the sweep; mm, mm², degrees."""
    return "\n".join(_lines(optimum, files))


def _lines(optimum: Optimum, files: Mapping[str, Path]) -> Iterator[str]:
    sweep, best = optimum.sweep, optimum.best
    yield (
        f"{sweep.job.surface.source}, {optimum.swept} cases swept, {len(sweep.rows) - optimum.swept} more searched, "
        f"for the least {sweep.objective}"
    )
    yield f"      {HEAD.removeprefix('rank  ')}  [°, mm, %, mm²]"
    yield f"best  {cells(best)}"
    yield f"swept {cells(optimum.of_sweep)}"
    score, before = sweep.objective.score(best), sweep.objective.score(optimum.of_sweep)
    yield f"objective {score:.4g}, of the sweep alone {before:.4g}"
    if not optimum.converged:
        yield "the budget ended the search before it came to rest; a larger --budget may find a better drape"
    if files:
        yield f"files: {', '.join(str(path) for path in files.values())}"
