"""``setup.toml``: how the ply was laid and measured, as far as the person who did it knows."""

from __future__ import annotations

import math
import tomllib
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Any

from geomdrap.errors import MeasurementError

Triple = tuple[float, float, float]


@dataclass(frozen=True)
class Setup:
    """Where the ply started and how well it was measured; None where it is not known.

    ``origin`` is ``"centroid"``, ``"vertex:N"`` or a point (3,) mm; ``angle`` the heading of the warp, degrees
    from ``reference`` (3,) (default the part's +x); ``pitch`` side of a cell, mm; ``sigma_xyz`` mm per
    coordinate, ``sigma_shear`` and ``sigma_direction`` degrees: standard deviations of the instrument;
    ``mark_spacing`` (2,) mm and ``mark_origin`` (2,) place the marks whose numbers the table has instead of u, v.
    """

    origin: str | Triple | None = None
    angle: float | None = None
    pitch: float | None = None
    sigma_xyz: float | None = None
    sigma_shear: float | None = None
    sigma_direction: float | None = None
    reference: Triple | None = None
    mark_spacing: tuple[float, float] | None = None
    mark_origin: tuple[float, float] | None = None


KEYS = tuple(f.name for f in fields(Setup))
ABOVE_ZERO = ("pitch", "sigma_xyz", "sigma_shear", "sigma_direction")


def read_setup(path: str | Path) -> Setup:
    """Read a set-up file. Raises MeasurementError, naming file and key, for what is wrong in it."""
    path = Path(path)
    document = _document(path)
    unknown = [key for key in document if key not in KEYS]
    if unknown:
        raise MeasurementError(f"{path.name}: '{unknown[0]}' is not a key of a set-up; known are {', '.join(KEYS)}")
    values = {key: _value(path.name, key, value) for key, value in document.items()}
    return Setup(**values)


def _document(path: Path) -> dict[str, Any]:
    if path.is_dir():
        raise MeasurementError(f"{path} is a folder; give the file setup.toml itself")
    try:
        return tomllib.loads(path.read_bytes().decode("utf-8-sig").replace("\r\n", "\n"))
    except FileNotFoundError:
        raise MeasurementError(f"there is no file {path}") from None
    except (OSError, ValueError) as error:  # TOMLDecodeError and UnicodeDecodeError are ValueErrors
        why = getattr(error, "strerror", None) or error
        raise MeasurementError(f"cannot read {path.name} as TOML: {why}") from None


def _value(source: str, key: str, value: Any) -> Any:
    if key == "origin" and isinstance(value, str):
        return value
    if key in ("origin", "reference"):
        return _numbers(source, key, value, 3)
    if key in ("mark_spacing", "mark_origin"):
        return _numbers(source, key, [value, value] if isinstance(value, (int, float)) else value, 2)
    number = _numbers(source, key, [value], 1)[0]
    if key in ABOVE_ZERO and number <= 0.0:
        raise MeasurementError(f"{source}: {key} must be above 0, not {number:g}")
    return number


def _numbers(source: str, key: str, values: Any, count: int) -> tuple[float, ...]:
    numeric = isinstance(values, list) and len(values) == count
    if not (numeric and all(_is_finite(value) for value in values)):
        wanted = "a finite number" if count == 1 else f"{count} finite numbers in brackets"
        shown = values[0] if count == 1 else values
        raise MeasurementError(f"{source}: {key} must be {wanted}, not {shown!r}")
    return tuple(float(value) for value in values)


def _is_finite(value: Any) -> bool:
    return isinstance(value, (int, float)) and not isinstance(value, bool) and math.isfinite(value)
