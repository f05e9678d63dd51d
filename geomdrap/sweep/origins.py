"""Origins as they are written: the centroid, points, vertices, a grid over the part, a table."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import MeasurementError, SweepError
from geomdrap.fishnet.pitch import choose_pitch
from geomdrap.fishnet.seed import heading_frame, locate
from geomdrap.measurement.table import number_of, read_table

if TYPE_CHECKING:
    from collections.abc import Sequence

    from geomdrap.surface import Surface

    Point = tuple[float, float, float]

MOST = 1_000_000  # points of a grid
ONE_SIDED = 0.1  # mean normal of a part that has an upper side


def locate_origins(
    surface: Surface, texts: Sequence[str], pitch: float | None = None, project: bool = False
) -> tuple[tuple[str | Point, ...], tuple[str, ...]]:
    """Origins on the part, each once, and notes on what was left out.

    A text is ``centroid``, ``x,y,z``, ``vertex:N``, ``grid:NxM`` or the name of a CSV file with columns x, y, z (mm).
    A point further than ``pitch`` (or what would be chosen) from the part is refused unless ``project``.
    Raises SweepError where a text cannot be read, a point lies off the part, or no point of a grid meets it.
    """
    found: list[str | Point] = []
    notes: list[str] = []
    for text in texts:
        if text == "centroid":
            found.append(text)
        elif text.startswith("grid:"):
            points, missed = _grid(surface, text)
            found += points
            if missed:
                notes.append(f"{missed} of {missed + len(points)} points of {text} miss the part and are left out")
        elif re.fullmatch(r"vertex:\d{1,18}", text):
            found.append(_point(locate(surface, text)[1]))
        else:
            found += _on_part(surface, *_points(text), pitch, project)
    return tuple(dict.fromkeys(found)), tuple(notes)


def _point(numbers: np.ndarray) -> Point:
    x, y, z = (float(c) + 0.0 for c in numbers)
    return x, y, z


def _points(text: str) -> tuple[np.ndarray, list[str]]:
    """Points (n, 3) that a text writes out or whose file it names, and what to call each in messages."""
    if text.count(",") == 2 and not Path(text).exists():
        name = f"origin {text}"
        return np.array([_numbers(text.split(","), False, name)]), [name]
    try:
        Path(text).open("rb").close()
    except (OSError, ValueError) as error:
        why = getattr(error, "strerror", None) or "is no name of a file"
        raise SweepError(
            f"origins {text!r}: write centroid, x,y,z, vertex:N, grid:NxM, or the name of a CSV file with columns "
            f"x, y, z ({why})"
        ) from error
    return _columns(Path(text))


def read_points(file: Path) -> np.ndarray:
    """Points (n, 3) mm of a CSV file with columns x, y, z. Raises SweepError where it cannot be read."""
    return _columns(file)[0]


def _columns(file: Path) -> tuple[np.ndarray, list[str]]:
    """The points (n, 3) of a table with columns x, y, z, and what to call each: its file and line."""
    try:
        table = read_table(file)
    except MeasurementError as error:
        raise SweepError(str(error)) from error
    header = [name.lower() for name in table.header]
    missing = [name for name in "xyz" if name not in header]
    if missing:
        raise SweepError(f"{table.source}: there is no column {', '.join(missing)}; the first line must name x, y, z")
    columns, comma = [header.index(name) for name in "xyz"], table.separator != ","
    names = [f"{table.source}, line {line}" for line in table.lines]
    cells = [[row[k] for k in columns] for row in table.rows]
    return np.array([_numbers(row, comma, name) for row, name in zip(cells, names, strict=True)]), names


def _numbers(cells: Sequence[str], comma: bool, name: str) -> list[float]:
    """Finite numbers in cells, in which a ``comma`` may be a decimal sign."""
    numbers = [value for cell in cells if (value := number_of(cell, comma)) is not None and math.isfinite(value)]
    if len(numbers) < len(cells):
        raise SweepError(f"{name}: '{(';' if comma else ',').join(cells)}' is not three finite numbers x, y, z")
    return numbers


def _on_part(
    surface: Surface, points: np.ndarray, names: list[str], pitch: float | None, project: bool
) -> list[Point]:
    """The points of the part nearest to ``points`` (n, 3), none of which may lie further off than a pitch."""
    near = surface.nearest(points)
    most = pitch if pitch is not None else choose_pitch(surface)[0]
    far = np.flatnonzero(~(near.distance <= most))
    if len(far) and not project:
        more = f" (and {len(far) - 1} more)" if len(far) > 1 else ""
        raise SweepError(
            f"{names[far[0]]}: lies {near.distance[far[0]]:.6g} mm from {surface.source}, more than the pitch of "
            f"{most:.6g} mm{more}; move it, or take the nearest points with --project"
        )
    return [_point(point) for point in near.point]


def _grid(surface: Surface, text: str) -> tuple[list[Point], int]:
    """Where the middles of N × M equal fields over the part's outline meet it from above; how many do not.

    Above is the side of its mean normal; N fields lie along the reference direction of the heading.
    """
    match = re.fullmatch(r"grid:(\d{1,9})[xX×](\d{1,9})", text)
    n, m = (int(match[1]), int(match[2])) if match else (0, 0)
    if n == 0 or m == 0 or n * m > MOST:
        raise SweepError(f"origins {text!r}: a grid is grid:NxM, as in grid:5x5, of up to {MOST:,} points")
    frame = plan_frame(surface)
    local = surface.points @ frame.T
    low, high = local.min(axis=0), local.max(axis=0)
    steps = (high - low)[:2] / [n, m]
    height = _heights((local[:, :2] - low[:2]) / steps - 0.5, local[:, 2], surface.triangles, (n, m))
    i, j = np.nonzero(np.isfinite(height))
    if len(i) == 0:
        raise SweepError(f"origins {text!r}: no point of the grid meets {surface.source}; use a finer one")
    plan = low[:2] + (np.column_stack([i, j]) + 0.5) * steps
    points = np.column_stack([plan, height[i, j]]) @ frame
    return [_point(point) for point in surface.nearest(points).point], n * m - len(i)


def plan_frame(surface: Surface) -> np.ndarray:
    """Unit vectors along, across and up (3, 3) of the plan in which grids lie; headings count from the first."""
    up = _upward(surface)
    along = heading_frame(up, None)
    return np.stack([along, np.cross(up, along), up])


def _upward(surface: Surface) -> np.ndarray:
    """The mean normal (3,), or for a part without an upper side the axis along which most of it is seen."""
    total = surface.areas @ surface.normals
    size = float(np.linalg.norm(total))
    if size > ONE_SIDED * surface.area:
        return np.asarray(total / size)
    return np.eye(3)[int((surface.areas @ np.abs(surface.normals)).argmax())]


def _heights(plan: np.ndarray, height: np.ndarray, triangles: np.ndarray, shape: tuple[int, int]) -> np.ndarray:
    """Greatest height (shape) of a mesh above the whole numbers of its plan (n, 2); −inf where there is nothing."""
    corners, z = plan[triangles], height[triangles]
    first = np.maximum(np.ceil(corners.min(axis=1)).astype(np.int64), 0)
    last = np.minimum(np.floor(corners.max(axis=1)).astype(np.int64), np.array(shape) - 1)
    out = np.full(shape, -np.inf)
    for f in np.flatnonzero((first <= last).all(axis=1)):
        a, b, c = corners[f]
        det = (b - a)[0] * (c - a)[1] - (b - a)[1] * (c - a)[0]
        if det == 0.0:
            continue
        i, j = (np.arange(first[f, k], last[f, k] + 1) for k in (0, 1))
        x, y = i[:, None] - a[0], j[None, :] - a[1]
        s = (x * (c - a)[1] - y * (c - a)[0]) / det
        t = (y * (b - a)[0] - x * (b - a)[1]) / det
        inside = (s >= 0.0) & (t >= 0.0) & (s + t <= 1.0)
        here = np.where(inside, z[f, 0] + s * (z[f, 1] - z[f, 0]) + t * (z[f, 2] - z[f, 0]), -np.inf)
        window = out[i[0] : i[-1] + 1, j[0] : j[-1] + 1]
        np.maximum(window, here, out=window)
    return out
