"""drape.json: the result in one JSON object, the same bytes for the same input."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from geomdrap import __version__
from geomdrap.export.whole import write_whole

if TYPE_CHECKING:
    from geomdrap.fields import Drape
    from geomdrap.fields.strips import Roll
    from geomdrap.fishnet import Effect

SCHEMA = "geomdrap.drape/1"
DECIMALS = 6
# Trimming to the boundary is second order in the pitch; a whole drape misses a few 0.01 % of its rim.
COMPLETE_COVERAGE = 0.995


def as_dict(result: Drape, files: Mapping[str, str | Path] | None = None) -> dict[str, Any]:
    """Give the JSON object of a drape (schema ``geomdrap.drape/1``): mm, mm², degrees, shares 0 to 1.

    ``files`` maps keys to file names or paths and is passed through. Numbers are rounded to six decimals;
    what is not a number becomes None. Keys come in a fixed order.
    """
    net = result.net
    roll = {} if result.roll is None else {"roll": roll_as_dict(result.roll)}
    return plain(
        {
            "schema": SCHEMA,
            "version": __version__,
            "part": Path(net.surface.source).name,
            "facets": len(net.surface.triangles),
            "origin": net.origin,
            "normal": net.normal0,
            "angle": net.angle,
            "pitch": net.pitch,
            "effects": effects_as_dicts(net.effects),
            "nodes": int(np.isfinite(net.points[..., 0]).sum()),
            "cells": int(np.sum(net.cell_valid)),
            "shear": _fields(result.statistics, "max", "p95", "mean"),
            "limit_angle": result.limit_angle,
            "share": _fields(result.statistics, "over_half_limit", "over_limit"),
            "area": _fields(result.area, "part", "draped", "fabric", "coverage"),
            "incomplete": is_incomplete(result),
            **roll,
            "bare": [_fields(region, "area", "center", "reason") for region in result.bare],
            "absent": absent_counts(result),
            "checks": _fields(result.checks, "edge_error", "off_surface", "curvature_residual"),
            "warnings": list(result.warnings),
            "notes": list(net.notes),
            "files": {key: str(name) for key, name in (files or {}).items()},
        }
    )


def roll_as_dict(roll: Roll) -> dict[str, Any]:
    """Give the JSON object of a pattern laid from strips of a roll."""
    return {
        **_fields(roll, "width", "overlap", "length", "waste"),
        "strips": [_fields(strip, "v", "u", "length", "area", "pieces") for strip in roll.strips],
        "seams": [
            {
                **_fields(seam, "v", "length"),
                "pieces": [piece[:, 0] for piece in seam.pieces],
                **_fields(seam, "max_shear", "max_shear_at", "on_part"),
            }
            for seam in roll.seams
        ],
    }


def write(result: Drape, path: Path, files: Mapping[str, str | Path] | None = None) -> None:
    """Write drape.json: no date, path or timing in it.

    ``files`` maps keys to the files beside it, of which only the names are kept.
    """
    names = {key: Path(file).name for key, file in (files or {}).items()}
    write_whole(path, as_text(as_dict(result, names)))


def as_text(document: Mapping[str, Any]) -> str:
    """Give a JSON document as text with a final line end; NaN is refused (ValueError)."""
    return json.dumps(document, indent=2, ensure_ascii=False, allow_nan=False) + "\n"


def is_incomplete(result: Drape) -> bool:
    """Tell whether less than 99.5 % of the part is covered: what ``--strict`` turns into exit code 1."""
    return not result.area.coverage >= COMPLETE_COVERAGE


def effects_as_dicts(effects: Iterable[Effect]) -> list[dict[str, Any]]:
    """Give the names and values of effects as result files hold them."""
    return [{"name": effect.title(), "values": getattr(effect, "values", {})} for effect in effects]


def absent_counts(result: Drape) -> dict[str, int]:
    """Count the nodes that were tried and are absent, by reason, in the order of the reasons' numbers."""
    from geomdrap.fishnet import Status

    net = result.net
    absent = net.status[~np.isfinite(net.points[..., 0]) & (net.status != Status.UNREACHED)]
    codes, counts = np.unique(absent, return_counts=True)
    return {Status(code).reason: int(count) for code, count in zip(codes.tolist(), counts, strict=True)}


def _fields(record: object, *names: str) -> dict[str, Any]:
    return {name: getattr(record, name) for name in names}


def _to_decimals(value: float) -> float:
    return round(value, DECIMALS)


def plain(value: Any, rounded: Callable[[float], float] = _to_decimals) -> Any:
    """Turn numpy values into JSON's own, floats ``rounded``, −0 gone, what is not a number None."""
    if isinstance(value, dict):
        return {str(key): plain(item, rounded) for key, item in value.items()}
    if isinstance(value, (list, tuple, np.ndarray)):
        return [plain(item, rounded) for item in value]
    if isinstance(value, (bool, np.bool_)):
        return bool(value)
    if isinstance(value, (int, np.integer)):
        return int(value)
    if isinstance(value, (float, np.floating)):
        return rounded(float(value)) + 0.0 if math.isfinite(value) else None
    return value
