"""Changes between two JSON reports, leaf by leaf, each with the tolerance of its unit."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from itertools import zip_longest
from typing import Any

from geomdrap.export.diff import Change, Tolerance

# which files were asked for, and which version wrote them, is not part of the result
_NOT_COMPARED = ("files", "version")
_DEGREES = ("shear", "max_shear", "angle", "limit_angle", "curvature_residual")
_SHARES = ("coverage", "share", "waste")
_AREAS = ("area",)
_MISSING = object()


def changes(old: bytes, new: bytes, tolerance: Tolerance) -> Iterator[Change | str]:
    """Yield what changed between two JSON documents; notes are plain strings."""
    before, after = _parse(old), _parse(new)
    if isinstance(before, dict) and isinstance(after, dict):
        versions = before.get("version"), after.get("version")
        if versions[0] != versions[1]:
            yield f"written by geomdrap {versions[0]} and {versions[1]}"
        before, after = ({k: v for k, v in d.items() if k not in _NOT_COMPARED} for d in (before, after))
    scale = _length_scale(before)
    for path, left, right in _leaves(before, after, ()):
        change = _leaf_change(path, left, right, tolerance, scale)
        if change:
            yield change


def _parse(data: bytes) -> Any:
    try:
        return json.loads(data)
    except UnicodeDecodeError as error:
        raise ValueError("not UTF-8 text") from error
    except RecursionError as error:
        raise ValueError("not a report: nested too deeply") from error


def _leaves(old: Any, new: Any, path: tuple[str, ...]) -> Iterator[tuple[tuple[str, ...], Any, Any]]:
    if isinstance(old, dict) and isinstance(new, dict):
        for key in dict.fromkeys((*old, *new)):
            yield from _leaves(old.get(key, _MISSING), new.get(key, _MISSING), (*path, key))
    elif isinstance(old, list) and isinstance(new, list):
        for number, (left, right) in enumerate(zip_longest(old, new, fillvalue=_MISSING)):
            yield from _leaves(left, right, (*path, str(number)))
    else:
        yield path, old, new


def _leaf_change(
    path: tuple[str, ...], old: Any, new: Any, tolerance: Tolerance, scale: float
) -> Change | None:
    where = ".".join(path) or "document"
    if old is _MISSING:
        return Change("", where, f"appeared: {_show(new)}")
    if new is _MISSING:
        return Change("", where, f"vanished: was {_show(old)}")
    what = f"{_show(old)} -> {_show(new)}"
    if not (_is_number(old) and _is_number(new)):
        return Change("", where, what) if old != new or type(old) is not type(new) else None
    amount, unit = abs(new - old), _unit(path, old, new)
    factor = {"mm²": 4 * scale, "": 4 / scale}.get(unit, 1.0)
    if unit == "count":
        return Change("", where, what, amount) if amount else None
    # an outline that moves by t changes an area A by about 4 t √A, and a share of it by 4 t / √A
    return Change("", where, what, amount, unit) if tolerance.exceeded(amount / factor, unit) else None


def _unit(path: tuple[str, ...], old: Any, new: Any) -> str:
    """Tell the unit of a number from the keys that lead to it."""
    if isinstance(old, int) and isinstance(new, int):
        return "count"
    keys = [key for key in path if not key.isdigit()]
    if any(key in _SHARES for key in keys):
        return ""
    if any(key in _DEGREES for key in keys):
        return "deg"
    return "mm²" if any(key in _AREAS for key in keys) else "mm"


def _length_scale(report: Any) -> float:
    """Give the root of the part's area, mm; 1 where the report has none."""
    try:
        return max(math.sqrt(report["area"]["part"]), 1.0)
    except (KeyError, TypeError, ValueError):
        return 1.0


def _is_number(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def _show(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 80 else text[:77] + "..."
