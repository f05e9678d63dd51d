"""The readable summary of a sweep: the best cases in a table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from geomdrap.sweep import Row, Sweep

SHOWN = 10
HEAD = "rank  angle  origin                          max    95 %    over    cover    fabric      blank   waste"


def summary(sweep: Sweep, files: Mapping[str, Path]) -> str:
    """Give the summary as text: the best cases, the front, the failures; mm, mm², degrees."""
    return "\n".join(_lines(sweep, files))


def _lines(sweep: Sweep, files: Mapping[str, Path]) -> Iterator[str]:
    failures = [row for row in sweep.rows if row.reason is not None]
    ranked = sweep.ranked[: len(sweep.rows) - len(failures)]
    said = f", {len(failures)} failed" if failures else ""
    yield f"{sweep.job.surface.source}, {len(sweep.rows)} cases{said}, ranked by {sweep.objective}"
    yield f"{HEAD}  [°, mm, %, mm²]"
    front = {row.key for row in sweep.front}
    for rank, row in enumerate(ranked[:SHOWN], 1):
        yield f"{rank:4d}{'*' if row.key in front else ' '} {cells(row)}"
    if len(ranked) > SHOWN:
        yield f"      ... and {len(ranked) - SHOWN} more"
    yield f"* {len(front)} cases that none beats in one of {', '.join(sweep.criteria)} and equals in the rest"
    for reason in dict.fromkeys(row.reason for row in failures):
        yield f"failed: {sum(row.reason == reason for row in failures)} cases: {reason}"
    if files:
        yield f"files: {', '.join(str(path) for path in files.values())}"


def cells(row: Row) -> str:
    """The numbers of a row under ``HEAD``, without the rank."""
    where = "(" + ", ".join(f"{round(x, 1) + 0.0:.1f}" for x in row.origin) + ")"
    return (
        f"{row.angle:6.4g}  {where:<26}{row.max_shear:9.2f}{row.p95_shear:8.2f}{100 * row.over_limit:8.2f}"
        f"{100 * row.coverage:9.2f}{row.fabric_area:10.0f}{row.blank_area:11.0f}{100 * row.waste:8.1f}"
    )
