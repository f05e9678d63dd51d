"""Are the files of a result folder of one run? A later run with fewer outputs leaves some of an earlier one."""

from __future__ import annotations

import csv
import json
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import Any

REPORT, TABLE = "drape.json", "nodes.csv"


def doubts(folder: Path, names: Iterable[str]) -> Iterator[str]:
    """Yield a sentence on each file of ``names`` in a folder that its drape.json shows to be of another run.

    It lists the files written with it, and counts the nodes. What cannot be read is left to the comparison.
    """
    report = _report(folder / REPORT)
    listed = report.get("files")
    here = [name for name in names if name != REPORT and (folder / name).exists()]
    if isinstance(listed, dict) and listed:
        for name in here:
            if name not in listed.values():
                yield f"{folder / name} was not written by the run that wrote {REPORT} beside it: clear the folder"
    count = report.get("nodes")
    if TABLE in here and isinstance(count, int) and (found := _nodes(folder / TABLE)) not in (None, count):
        yield f"{folder / TABLE} has {found} nodes, {REPORT} beside it says {count}: they are of different runs"


def _report(path: Path) -> dict[str, Any]:
    try:
        document = json.loads(path.read_bytes())
    except (OSError, ValueError, RecursionError):
        return {}
    return document if isinstance(document, dict) else {}


def _nodes(path: Path) -> int | None:
    """Number of nodes with a place in a node table; None where it is none."""
    try:
        with path.open(encoding="utf-8", newline="") as file:
            rows = csv.reader(file)
            column = next(rows).index("x")
            return sum(1 for row in rows if len(row) > column and row[column])
    except (OSError, ValueError, StopIteration, csv.Error):
        return None
