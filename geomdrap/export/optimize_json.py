"""optimize.json: the best drape, what the sweep alone found, and the way of the search, in one JSON object."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geomdrap.export.report_json import plain
from geomdrap.export.sweep_json import COLUMNS, said, settings

if TYPE_CHECKING:
    from geomdrap.fields import Drape
    from geomdrap.sweep import Optimum, Row

SCHEMA = "geomdrap.optimize/1"


def as_dict(
    optimum: Optimum, best: Drape, files: Mapping[str, str | Path] | None = None, notes: Iterable[str] = ()
) -> dict[str, Any]:
    """The JSON object of an optimum (schema ``geomdrap.optimize/1``): mm, mm², degrees, shares 0 to 1.

    ``score`` is the value of the objective, with what is bare; ``sweep`` is the best row of the global sweep alone.
    ``warnings``, and ``notes`` after those given, are of the best drape, ``best``.
    """
    sweep = optimum.sweep

    def row_as_dict(row: Row) -> dict[str, Any]:
        numbers = {name: getattr(row, name) for name in COLUMNS if name != "reason"}
        return {"score": sweep.objective.score(row), "origin": list(row.origin), **numbers}

    return plain(
        {
            "schema": SCHEMA,
            **settings(sweep, best),
            "best": row_as_dict(optimum.best),
            "sweep": row_as_dict(optimum.of_sweep),
            "path": [row_as_dict(row) for row in optimum.path],
            "swept": optimum.swept,
            "drapes": len(sweep.rows),
            "converged": optimum.converged,
            **said(best, files, notes),
        }
    )
