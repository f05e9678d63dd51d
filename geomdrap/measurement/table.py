"""A text table as cells: encodings, separators, comments, ragged rows."""

from __future__ import annotations

import csv
import math
import re
from dataclasses import dataclass
from pathlib import Path

from geomdrap.errors import MeasurementError

SEPARATORS = {";": "semicolon", "\t": "tab", ",": "comma"}
"""In the order in which they are looked for: a comma may be a decimal sign where there are semicolons."""

OPEN = ("", "-", "–", "—", "n/a", "#n/a", "na")
"""What people write where nothing was measured, in lower case."""

CONTROL = re.compile("[\x00-\x08\x0b\x0c\x0e-\x1f\x7f]")


@dataclass(frozen=True)
class Table:
    """Cells of a text table: ``header`` names as written, ``rows`` of as many cells, ``lines`` they stand in."""

    source: str
    header: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]
    lines: tuple[int, ...]
    separator: str


def read_table(path: Path) -> Table:
    """Read a table with a header line. Raises MeasurementError, naming file and line, where it is none."""
    source = path.name
    lines = _content(_text(path), source)
    number, first = lines[0]
    separator = next((s for s in SEPARATORS if s in first), "")
    if not separator:
        raise MeasurementError(
            f"{source}, line {number}: '{_short(first)}' is not a header with commas, semicolons or tabs between "
            "the names of the columns, such as x,y,z"
        )
    header = tuple(_cells(first, separator, source, number))
    _require_header(header, source, number)
    rows = [_row(header, _cells(text, separator, source, n), source, n) for n, text in lines[1:]]
    if not rows:
        raise MeasurementError(f"{source} has a header but no rows: it needs a row per point")
    return Table(source, header, tuple(rows), tuple(n for n, _ in lines[1:]), separator)


def _text(path: Path) -> str:
    """The file's text; UTF-8, UTF-16 with its mark, or Latin-1."""
    if path.is_dir():
        raise MeasurementError(f"{path} is a folder; give a file with a table")
    try:
        raw = path.read_bytes()
    except FileNotFoundError:
        raise MeasurementError(f"there is no file {path}") from None
    except (OSError, ValueError) as error:
        raise MeasurementError(f"cannot read {path}: {getattr(error, 'strerror', None) or error}") from None
    try:
        text = raw.decode("utf-16" if raw[:2] in (b"\xff\xfe", b"\xfe\xff") else "utf-8-sig")
    except UnicodeDecodeError:
        text = raw.decode("latin-1")
    if CONTROL.search(text):
        raise MeasurementError(f"{path.name} is not a text table: export the points as CSV")
    return text


def _content(text: str, source: str) -> list[tuple[int, str]]:
    """Line numbers (from 1) and lines that are neither blank nor comments."""
    lines = enumerate(re.split("\r\n|\n|\r", text), start=1)
    kept = [(n, line) for n, line in lines if line.strip(" \t;,") and not line.lstrip().startswith("#")]
    if not kept:
        raise MeasurementError(f"{source} is empty: it needs a header line, such as x,y,z, and a row per point")
    return kept


def _cells(line: str, separator: str, source: str, number: int) -> list[str]:
    try:
        return [cell.strip() for cell in next(csv.reader([line], delimiter=separator))]
    except csv.Error as error:
        raise MeasurementError(f"{source}, line {number}: not a row of a table ({error})") from None


def _row(header: tuple[str, ...], cells: list[str], source: str, number: int) -> tuple[str, ...]:
    """The cells of a row; empty ones too many at its end are no fault."""
    while len(cells) > len(header) and not cells[-1]:
        cells.pop()
    if len(cells) != len(header):
        raise MeasurementError(
            f"{source}, line {number}: the row has {len(cells)} cells, but the header names {len(header)} columns"
        )
    return tuple(cells)


def _require_header(header: tuple[str, ...], source: str, number: int) -> None:
    if all(_is_number(name) for name in header if name):
        raise MeasurementError(
            f"{source}, line {number}: the header is missing; the first line must name the columns, as in x,y,z"
        )


def is_open(text: str) -> bool:
    """Whether a cell says that nothing was measured."""
    return text.lower() in OPEN


def number_of(text: str, decimal_comma: bool) -> float | None:
    """A number as people write it; NaN for an open cell, None for text."""
    if is_open(text):
        return math.nan
    if decimal_comma and text.count(",") == 1 and "." not in text:
        text = text.replace(",", ".")
    if "_" in text:
        return None
    try:
        return float(text.replace("−", "-"))
    except ValueError:
        return None


def _is_number(text: str) -> bool:
    try:
        float(text.replace(",", "."))
    except ValueError:
        return False
    return True


def _short(text: str) -> str:
    text = "".join(c if c.isprintable() else "?" for c in text.strip())
    return text if len(text) <= 40 else text[:40] + "…"
