"""Readings of a test: a table of displacements, forces and shear."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import FormingError

Array = NDArray[np.float64]

COLUMNS = ("force", "force_warp", "force_weft", "shear")


def read_test(path: str | Path) -> dict[str, dict[str, Array]]:
    """Read a CSV table with the column ``displacement`` (mm) and any of ``COLUMNS`` (N, deg): columns by series.

    An optional column ``series`` names who or what read the row; without it the series is called ``test``. Empty
    cells are not read (NaN); lines with # are notes; other columns are left alone, but a column ``case`` must hold
    one case. FormingError names the file and what is wrong.
    """
    header, rows = _cells(path)
    if "displacement" not in header or not set(COLUMNS) & set(header):
        raise FormingError(
            f"{path} needs the column displacement and one of {', '.join(COLUMNS)} in its first line; "
            f"it has {', '.join(header)}"
        )
    wanted = [name for name in ("displacement", *COLUMNS) if name in header]
    table: dict[str, list[list[float]]] = {}
    cases: list[str] = []
    for number, row in rows:
        if len(row) != len(header):
            raise FormingError(
                f"{path}, line {number}, has {len(row)} cells under {len(header)} headings; correct it"
            )
        cells = dict(zip(header, row, strict=True))
        if "case" in cells and cells["case"] not in cases:
            cases.append(cells["case"])
        series = cells.get("series", "test") or "test"
        table.setdefault(series, []).append([_number(path, number, name, cells[name]) for name in wanted])
    if len(cases) > 1:
        raise FormingError(
            f"{path} holds {len(cases)} cases ({', '.join(cases)}), and a file is one test: keep the rows of one, "
            "and give the others as files of their own (--also)"
        )
    found = {}
    for series, lines in table.items():
        values = np.array(lines)
        if not np.all(np.isfinite(values[:, 0])) or np.any(values[:, 0] < 0.0):
            raise FormingError(
                f"{path}: a displacement is missing or below 0 mm in the series '{series}'; correct it"
            )
        order = np.argsort(values[:, 0], kind="stable")
        found[series] = {name: values[order, k] for k, name in enumerate(wanted)}
    if not found:
        raise FormingError(f"{path} has a header and no readings; add some")
    return found


def _cells(path: str | Path) -> tuple[list[str], list[tuple[int, list[str]]]]:
    """Headings, and the numbered rows of cells."""
    try:
        lines = Path(path).read_text(encoding="utf-8-sig").splitlines()
    except FileNotFoundError:
        raise FormingError(f"{path} does not exist; name a CSV file with the readings of a test") from None
    except (OSError, UnicodeDecodeError):
        raise FormingError(f"{path} cannot be read as a table of text; name a CSV file") from None
    rows = [(n, [cell.strip() for cell in line.split(",")]) for n, line in enumerate(lines, 1) if _counts(line)]
    if not rows:
        raise FormingError(f"{path} is empty; it needs a header and readings")
    return rows[0][1], rows[1:]


def _counts(line: str) -> bool:
    return bool(line.strip()) and not line.lstrip().startswith("#")


def _number(path: str | Path, line: int, name: str, cell: str) -> float:
    if not cell:
        return float("nan")
    try:
        value = float(cell)
    except ValueError:
        value = float("inf")
    if not np.isfinite(value):
        raise FormingError(f"{path}, line {line}: '{cell}' under {name} is not a number; correct it")
    return value
