"""The file to which rows are appended as they come: a line each, after one that says what they are rows of."""

from __future__ import annotations

import json
from collections.abc import Iterable
from itertools import count
from pathlib import Path
from typing import Any

from geomdrap import __version__
from geomdrap.errors import SweepError
from geomdrap.sweep.case import Job
from geomdrap.sweep.row import Row, as_json, from_json

FILE = "rows.jsonl"
SCHEMA = "geomdrap.rows/1"
WORDS = {
    "version": "version of geomdrap",
    "pitch": "pitch",
    "blank": "blank",
    "limit_angle": "limit angle",
    "effects": "effects",
    "reference": "reference direction",
}


class Record:
    """Appends rows to a file; whatever ends the run, what is in the file is good."""

    def __init__(self, path: Path, job: Job, rows: Iterable[Row] = ()):
        """Begin a file anew with the ``rows`` that there are. Raises SweepError where it cannot be written."""
        self.path = path
        fresh = path.with_name(f".{path.name}")
        try:
            path.parent.mkdir(parents=True, exist_ok=True)
            lines = [_line(header(job)), *(_line(as_json(row)) for row in rows)]
            fresh.write_text("".join(lines), encoding="utf-8")
            fresh.replace(path)  # the old file, or the new one with all its rows: never less
            self.file = path.open("a", encoding="utf-8")
        except OSError as error:
            raise _cannot_write(path, error) from error

    def append(self, row: Row) -> None:
        """Add a row; it is out of this process when the call returns. Raises SweepError where the disk is full."""
        try:
            self.file.write(_line(as_json(row)))
            self.file.flush()
        except OSError as error:
            raise _cannot_write(self.path, error) from error

    def close(self) -> None:
        """Close the file."""
        self.file.close()


def set_aside(path: Path) -> Path | None:
    """Rename a file that holds more than our first line, so that no row is lost; its new name, the first free one.

    None where there is no such file. Raises SweepError where it cannot be renamed.
    """
    try:
        lines = path.read_bytes().splitlines()
        if not lines or (len(lines) == 1 and lines[0].startswith(_line({"schema": SCHEMA}).encode()[:-2])):
            return None
        names = (path.with_name(f"{path.stem}-{number}{path.suffix}") for number in count(1))
        return path.rename(next(name for name in names if not name.exists()))
    except FileNotFoundError:
        return None
    except OSError as error:
        raise _cannot_write(path, error) from error


def header(job: Job) -> dict[str, Any]:
    """The first line: what later rows must share with earlier ones."""
    return {"schema": SCHEMA, "version": __version__, **job.settings()}


def read_record(path: Path, job: Job) -> tuple[Row, ...]:
    """Rows of an earlier run of the same job, each case once; none where there is no file.

    A last line that was not written to its end is left out. Raises SweepError for a file of another part or with
    other settings, and for one that is damaged.
    """
    try:
        lines = path.read_text(encoding="utf-8").splitlines(keepends=True)
    except FileNotFoundError:
        return ()
    except (OSError, UnicodeDecodeError) as error:
        raise SweepError(f"{path} cannot be read: {error}") from error
    if lines and not lines[-1].endswith("\n"):
        del lines[-1]
    if not lines:
        return ()
    _require_same(path, _parsed(path, 1, lines[0]), json.loads(_line(header(job))), job.surface.source)
    rows = [_row(path, number, line) for number, line in enumerate(lines[1:], 2)]
    return tuple({row.key: row for row in rows}.values())


def _require_same(path: Path, theirs: Any, ours: dict[str, Any], source: str) -> None:
    """Raise SweepError where the rows of a file are not to be compared with ours."""
    if not isinstance(theirs, dict) or theirs.get("schema") != SCHEMA:
        raise SweepError(f"{path} holds no rows of a sweep; use another folder (-o)")
    if theirs.get("part") != ours["part"]:
        raise SweepError(
            f"{path} holds rows of another part: its mesh is not that of {source} as it is read now; use another "
            "folder (-o), or begin anew without --resume"
        )
    for key, words in WORDS.items():
        if theirs.get(key) != ours[key]:
            raise SweepError(
                f"{path} holds rows with another {words} ({_said(theirs.get(key))}, not {_said(ours[key])}); use the "
                "same, another folder (-o), or begin anew without --resume"
            )


def _said(value: Any) -> str:
    return "none given" if value is None or value == [] else json.dumps(value, ensure_ascii=False)


def _parsed(path: Path, number: int, line: str) -> Any:
    try:
        return json.loads(line)
    except ValueError:
        raise SweepError(f"{path}, line {number}: not a row of a sweep; the file is damaged, begin anew") from None


def _row(path: Path, number: int, line: str) -> Row:
    try:
        return from_json(_parsed(path, number, line))
    except (KeyError, TypeError, ValueError):
        raise SweepError(f"{path}, line {number}: not a row of a sweep; the file is damaged, begin anew") from None


def _line(values: dict[str, Any]) -> str:
    return json.dumps(values, ensure_ascii=False, allow_nan=False) + "\n"


def _cannot_write(path: Path, error: OSError) -> SweepError:
    return SweepError(f"cannot write {path}: {error.strerror or error}")
