"""sweep.json: the rows of a sweep, ranked, in one JSON object."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geomdrap import __version__
from geomdrap.export.report_json import effects_as_dicts, plain

if TYPE_CHECKING:
    from geomdrap.fields import Drape
    from geomdrap.sweep import Row, Sweep

SCHEMA = "geomdrap.sweep/1"
COLUMNS = (
    "angle", "max_shear", "p95_shear", "mean_shear", "over_limit", "coverage", "draped_area", "fabric_area",
    "blank_length", "blank_width", "blank_area", "waste", "pitch", "reason",
)  # fmt: skip


def as_dict(
    sweep: Sweep, best: Drape, files: Mapping[str, str | Path] | None = None, notes: Iterable[str] = ()
) -> dict[str, Any]:
    """The JSON object of a sweep (schema ``geomdrap.sweep/1``), rows the best first: mm, mm², degrees, shares 0 to 1.

    ``rank`` counts from 1; it is None, as are the numbers, where ``reason`` says why the case failed. ``warnings``,
    and ``notes`` after those given, are of the best case, ``best``.
    """
    rows = ranked_rows(sweep)
    return plain(
        {
            "schema": SCHEMA,
            **settings(sweep, best),
            "pareto": list(sweep.criteria),
            "cases": len(rows),
            "failed": sum(row["rank"] is None for row in rows),
            "rows": rows,
            **said(best, files, notes),
        }
    )


def settings(sweep: Sweep, best: Drape) -> dict[str, Any]:
    """What all rows share: the part, the objective, and how plies are laid."""
    surface, job = sweep.job.surface, sweep.job
    return {
        "version": __version__,
        "part": Path(surface.source).name,
        "facets": len(surface.triangles),
        "objective": str(sweep.objective),
        "blank": None if job.reach is None else [2.0 * r for r in job.reach],
        "reference": job.reference,
        "limit_angle": best.limit_angle,
        "effects": effects_as_dicts(job.effects),
    }


def said(best: Drape, files: Mapping[str, str | Path] | None, notes: Iterable[str]) -> dict[str, Any]:
    """What is doubtful, what is to be known, and the files."""
    return {
        "warnings": list(best.warnings),
        "notes": [*notes, *best.net.notes],
        "files": {key: str(name) for key, name in (files or {}).items()},
    }


def ranked_rows(sweep: Sweep) -> list[dict[str, Any]]:
    """The rows, the best first, as they stand in sweep.json and sweep.csv."""
    front = {row.key for row in sweep.front}
    return [row_as_dict(row, rank, row.key in front) for rank, row in enumerate(sweep.ranked, 1)]


def row_as_dict(row: Row, rank: int, on_front: bool) -> dict[str, Any]:
    """One row: its rank, where and how the ply was laid, its numbers, whether it is a best compromise."""
    return {
        "rank": rank if row.reason is None else None,
        "origin": list(row.origin) if row.origin[0] == row.origin[0] else row.asked,
        **{name: getattr(row, name) for name in COLUMNS},
        "pareto": on_front,
    }
