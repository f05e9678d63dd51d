"""What changed between two results: golden files for users' CI, and for our own tests.

Compared: drape.json (and any other JSON), nodes.csv, flat.dxf, flat.svg. Pictures and VTU files hold the same
numbers again and are left out.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from geomdrap.errors import GeomdrapError
from geomdrap.export.one_run import doubts

COMPARED = ("drape.json", "nodes.csv", "flat.dxf", "flat.svg")
SCHEMA = "geomdrap.diff/1"


@dataclass(frozen=True)
class Tolerance:
    """Differences up to ``mm`` and ``deg`` do not count; areas and shares follow from ``mm``."""

    mm: float = 1e-6
    deg: float = 1e-6
    # files hold six decimals: a change in the last one differs from 1e-6 by rounding of the binary numbers
    slack: float = 1e-9

    def exceeded(self, amount: float, unit: str) -> bool:
        """Tell whether a difference of ``amount`` in ``unit`` (``mm``, ``deg`` or another) is a change."""
        return not amount <= (self.deg if unit == "deg" else self.mm) + self.slack


@dataclass(frozen=True)
class Change:
    """One difference: in which file, where in it, what it is, and, if that is a number, by how much."""

    file: str
    where: str
    what: str
    amount: float | None = None
    unit: str = ""

    def __str__(self) -> str:
        """Give the change as one line."""
        size = "" if self.amount is None else f" by {self.amount:.6g} {self.unit}".rstrip()
        return f"{self.file}: {self.where}: {self.what}{size}"


@dataclass
class Comparison:
    """The changes between two results, the files that were compared, and notes that are no changes."""

    changes: list[Change] = field(default_factory=list)
    compared: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

    @property
    def changed(self) -> bool:
        """Tell whether anything changed."""
        return bool(self.changes)

    def as_dict(self) -> dict[str, Any]:
        """Give the comparison as a JSON object (schema ``geomdrap.diff/1``)."""
        changes = [
            {"file": c.file, "where": c.where, "what": c.what, "amount": c.amount, "unit": c.unit or None}
            for c in self.changes
        ]
        return {
            "schema": SCHEMA,
            "changed": self.changed,
            "changes": changes,
            "compared": self.compared,
            "notes": self.notes,
        }


def compare(old: Path, new: Path, tolerance: Tolerance | None = None) -> Comparison:
    """Compare two result folders, or two files of one kind, ``old`` the reference.

    A file of ``old`` that ``new`` lacks is a change; one that only ``new`` has is a note, and so is a folder whose
    files are of different runs. Raises
    `GeomdrapError` where there is nothing to compare or a file cannot be read as what it claims to be.
    """
    tolerance = tolerance or Tolerance()
    result = Comparison()
    for name, left, right in _pairs(Path(old), Path(new)):
        if left is None:
            result.notes.append(f"{name} is only in {new}, not compared")
        elif right is None:
            result.changes.append(Change(name, "file", f"missing in {new}"))
        else:
            result.compared.append(name)
            _compare_files(name, left, right, tolerance, result)
    for folder in (Path(old), Path(new)):
        if folder.is_dir():
            result.notes += doubts(folder, COMPARED)
    return result


def _compare_files(name: str, left: Path, right: Path, tolerance: Tolerance, result: Comparison) -> None:
    before, after = _read(left), _read(right)
    reader = _reader(left)  # also a pair of equal files must be of a kind that we know
    if before == after and before:
        return
    try:
        for finding in reader(before, after, tolerance):
            if isinstance(finding, Change):
                result.changes.append(Change(name, *_rest(finding)))
            else:
                result.notes.append(f"{name}: {finding}")
    except (ValueError, KeyError) as error:
        raise GeomdrapError(f"cannot compare {left} with {right}: {error}") from error


def _rest(change: Change) -> tuple[str, str, float | None, str]:
    return change.where, change.what, change.amount, change.unit


_Reader = Callable[[bytes, bytes, Tolerance], Iterator[Change | str]]


def _reader(path: Path) -> _Reader:
    from geomdrap.export import diff_drawing, diff_report, diff_table

    readers: dict[str, _Reader] = {
        ".json": diff_report.changes,
        ".csv": diff_table.changes,
        ".dxf": diff_drawing.dxf_changes,
        ".svg": diff_drawing.svg_changes,
    }
    if path.suffix.lower() not in readers:
        raise GeomdrapError(f"{path}: only {', '.join(readers)} files can be compared")
    return readers[path.suffix.lower()]


def _pairs(old: Path, new: Path) -> Iterator[tuple[str, Path | None, Path | None]]:
    """Give the name and both paths of each file to compare; None where one side lacks it."""
    for path in (old, new):
        if not path.exists():
            raise GeomdrapError(f"{path} does not exist; give two result folders or two result files")
    if old.is_dir() != new.is_dir():
        raise GeomdrapError(f"{old} and {new} are a folder and a file; give two folders or two files")
    if not old.is_dir():
        if old.suffix.lower() != new.suffix.lower():
            raise GeomdrapError(f"{old} and {new} are not of one kind; give two files with the same suffix")
        yield old.name, old, new
        return
    if not any((old / name).exists() for name in COMPARED):
        raise GeomdrapError(f"{old} holds no result; it should have one of {', '.join(COMPARED)}")
    for name in COMPARED:
        sides = tuple(folder / name if (folder / name).exists() else None for folder in (old, new))
        if any(sides):
            yield name, sides[0], sides[1]


def _read(path: Path) -> bytes:
    try:
        return path.read_bytes()
    except OSError as error:
        raise GeomdrapError(f"cannot read {path}: {error.strerror or error}") from error
