"""sweep.csv: the rows of a sweep as a table, the best first."""

from __future__ import annotations

import csv
import io
from typing import TYPE_CHECKING, Any

from geomdrap.export.report_json import plain
from geomdrap.export.sweep_json import COLUMNS, ranked_rows

if TYPE_CHECKING:
    from geomdrap.sweep import Sweep

HEADER = ("rank", "pareto", "x", "y", "z", *COLUMNS)


def as_text(sweep: Sweep) -> str:
    """The table as text: mm, mm², degrees, shares 0 to 1; six decimals, ``\\n`` line ends; empty where unknown."""
    out = io.StringIO()
    table = csv.writer(out, lineterminator="\n")
    table.writerow(HEADER)
    for row in ranked_rows(sweep):
        origin = [None] * 3 if isinstance(row["origin"], str) else row["origin"]
        table.writerow([_cell(v) for v in (row["rank"], int(row["pareto"]), *origin, *(row[c] for c in COLUMNS))])
    return out.getvalue()


def _cell(value: Any) -> Any:
    value = plain(value)
    return f"{value:.6f}" if isinstance(value, float) else value
