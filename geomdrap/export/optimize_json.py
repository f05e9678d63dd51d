"""optimize.json: the best drape, what the sweep alone found, and the way of the search, in one JSON object."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geomdrap import __version__
from geomdrap.export.report_json import plain
from geomdrap.export.sweep_json import COLUMNS

if TYPE_CHECKING:
    from geomdrap.sweep import Optimum, Row

SCHEMA = "geomdrap.optimize/1"


def as_dict(optimum: Optimum, files: Mapping[str, str | Path] | None = None) -> dict[str, Any]:
    """The JSON object of an optimum (schema ``geomdrap.optimize/1``): mm, mm², degrees, shares 0 to 1.

    ``score`` is the value of the objective, with what is bare; ``sweep`` is the best row of the global sweep alone.
    """
    sweep = optimum.sweep

    def row_as_dict(row: Row) -> dict[str, Any]:
        numbers = {name: getattr(row, name) for name in COLUMNS if name != "reason"}
        return {"score": sweep.objective.score(row), "origin": list(row.origin), **numbers}

    return plain(
        {
            "schema": SCHEMA,
            "version": __version__,
            "part": Path(sweep.job.surface.source).name,
            "facets": len(sweep.job.surface.triangles),
            "objective": str(sweep.objective),
            "effects": [{"name": e.title(), "values": getattr(e, "values", {})} for e in sweep.job.effects],
            "best": row_as_dict(optimum.best),
            "sweep": row_as_dict(optimum.of_sweep),
            "path": [row_as_dict(row) for row in optimum.path],
            "swept": optimum.swept,
            "drapes": len(sweep.rows),
            "converged": optimum.converged,
            "files": {key: str(name) for key, name in (files or {}).items()},
        }
    )
