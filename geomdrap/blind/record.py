"""The record of a blind set: the verdict, written before the truth is shown, then both side by side.

``solved.json`` holds the seal that the verdict was given for, when, and a hash of itself; ``revealed.json`` holds the
grade. A set that has been revealed takes no verdict any more.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

from geomdrap.blind.judge import GOOD, grade, parameters
from geomdrap.blind.seal import hashes, read_seal, unseal
from geomdrap.errors import GeomdrapError

SOLVED, REVEALED = "solved.json", "revealed.json"


def refuse_if_revealed(folder: Path) -> None:
    """Raise GeomdrapError if the truth of the set in ``folder`` has been shown, or if it is no set."""
    read_seal(folder)
    if (folder / REVEALED).exists():
        raise GeomdrapError(f"the truth of {folder} has been revealed, so solving it proves nothing; make a new set")


def write_solved(folder: Path, diagnosis: Mapping[str, Any], read: Mapping[str, str]) -> dict[str, Any]:
    """Write the ``diagnosis`` (schema geomdrap.diagnose/1) as the verdict on the set; gives what was written.

    ``read``: the ``hashes`` of its files when they were read.
    """
    refuse_if_revealed(folder)
    record = {
        "schema": "geomdrap.blind-solved/1",
        "seal": read_seal(folder),
        "files": dict(read),
        "solved_at": _now(),
        "verdict": diagnosis["verdict"],
        "candidates": list(diagnosis.get("candidates", ())),
        "confidence": diagnosis.get("confidence"),
        "diagnosis": dict(diagnosis),
    }
    record["digest"] = _digest(record)
    _write(folder / SOLVED, record)
    return record


def reveal(folder: Path, anyway: bool = False) -> dict[str, Any]:
    """Check the seal, show the truth and grade the verdict; written to revealed.json.

    GeomdrapError if the seal is broken or the verdict was given for another one, and, unless ``anyway``, if there is
    no verdict, if it is of an ``earlier`` version without a digest, if it was ``edited`` afterwards, or if a file
    that was solved is not the one that was sealed (``changed``): ``grade`` is None then. ``changed_since`` names
    files that have changed since they were solved, or sealed where they were not.
    """
    truth = unseal(folder)
    solved = _read_solved(folder)
    seen = solved.get("files", {}) if solved else {}
    earlier = solved is not None and "digest" not in solved
    told = solved is not None and not (earlier and "files" not in solved)
    changed = [name for name, sealed in truth.get("files", {}).items() if told and seen.get(name) != sealed]
    edited = solved is not None and not earlier and solved["digest"] != _digest(solved)
    if not anyway:
        _refuse_what_proves_nothing(folder, solved is not None, changed, earlier, edited)
    result: dict[str, Any] = {"schema": "geomdrap.blind-reveal/1", "seal": read_seal(folder), "truth": truth}
    result.update({"revealed_at": _now(), "verdict": None, "candidates": [], "grade": None, "right": None})
    result.update({"changed": changed, "edited": edited, "earlier": earlier})
    result["changed_since"] = _changed_since(folder, seen if solved else truth.get("files", {}))
    result["parameters"] = parameters(truth, solved["diagnosis"] if solved else {})
    if solved is not None and not (changed or edited or earlier):
        graded = grade(truth["answer"], solved["verdict"], solved["candidates"])
        found = {key: solved[key] for key in ("verdict", "candidates", "confidence", "solved_at")}
        result.update({**found, "grade": graded, "right": graded in GOOD})
    if not (folder / REVEALED).exists():
        _write(folder / REVEALED, result)
    return result


def _refuse_what_proves_nothing(
    folder: Path, is_solved: bool, changed: list[str], earlier: bool, edited: bool
) -> None:
    """Raise GeomdrapError for a set without a verdict, and for a verdict that is not one on what was sealed."""
    if not is_solved:
        raise GeomdrapError(f"{folder} is not solved yet; run geomdrap blind solve first, or reveal it --anyway")
    if changed:
        raise GeomdrapError(
            f"{folder / changed[0]} was not the file that was sealed when the set was solved, so the verdict proves "
            "nothing; put it back and solve the set again, or reveal it --anyway"
        )
    if earlier:
        raise GeomdrapError(
            f"{folder / SOLVED} was written by an earlier version, without a digest that shows edits; "
            "solve the set again, or reveal it --anyway"
        )
    if edited:
        raise GeomdrapError(
            f"{folder / SOLVED} was edited after it was written, so the verdict proves nothing; solve the set again, "
            "or reveal it --anyway"
        )


def _read_solved(folder: Path) -> dict[str, Any] | None:
    path = folder / SOLVED
    if not path.exists():
        return None
    try:
        solved: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
        seal = solved["seal"]
    except (OSError, ValueError, KeyError, TypeError):
        raise GeomdrapError(f"{path} cannot be read as a verdict; solve the set again") from None
    if seal != read_seal(folder):
        raise GeomdrapError(f"{path} was written for another seal; solve the set again")
    return solved


def _digest(record: Mapping[str, Any]) -> str:
    """SHA-256 of a record but for its own; as the seal it guards against accidents."""
    held = {key: value for key, value in record.items() if key != "digest"}
    return hashlib.sha256(json.dumps(held, sort_keys=True).encode()).hexdigest()


def _changed_since(folder: Path, seen: Mapping[str, str]) -> list[str]:
    """Files that are no longer what they were when the set was solved."""
    now = hashes(folder)
    return [name for name, then in seen.items() if now.get(name) != then]


def _now() -> str:
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def _write(path: Path, record: Mapping[str, Any]) -> None:
    half = path.with_name(f".{path.name}")  # a reader sees the old record or the new one
    half.write_text(json.dumps(record, indent=1) + "\n", encoding="utf-8")
    half.replace(path)
