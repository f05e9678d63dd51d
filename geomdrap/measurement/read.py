"""``read_measurement``: a table of measured points from a file."""

from __future__ import annotations

import math
from collections.abc import Mapping
from difflib import get_close_matches
from pathlib import Path

import numpy as np

from geomdrap.errors import MeasurementError
from geomdrap.measurement.columns import ANGLES, COLUMNS, LENGTHS, Chosen, choose_columns
from geomdrap.measurement.measurement import Measurement
from geomdrap.measurement.table import Table, is_open, number_of, read_table

UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}
SIGMAS = ("sigma_xyz", "sigma_shear", "sigma_direction")
OPTIONAL = ("shear", *SIGMAS, "warp_x", "warp_y", "warp_z", "weft_x", "weft_y", "weft_z")
"""Quantities that may be open (an empty cell, nan, -, n/a) in some rows."""
ABOUT_RIGHT = 30.0
"""Degrees about 90: half of the angles between yarns lie there."""


def _unused(heading: str) -> str:
    """The heading of a column that is not used, with the name that it is perhaps to have."""
    near = get_close_matches(heading.strip().lower(), [name for name in COLUMNS if len(name) > 1], 1, 0.7)
    return f"{heading} (is that {near[0]}?)" if near else heading


def read_measurement(
    path: str | Path,
    *,
    columns: Mapping[str, str] | None = None,
    unit: str = "mm",
    mark_spacing: tuple[float, float] | None = None,
    mark_origin: tuple[float, float] = (0.0, 0.0),
) -> Measurement:
    """Read a measured table: CSV with commas, semicolons or tabs, a header, # comments.

    Parameters: ``columns`` maps quantities (see ``COLUMNS``) to other headings of the file; ``unit`` is that of its
    lengths; ``mark_spacing`` mm turns mark numbers i, j into u = (i - i0) · spacing, with ``mark_origin`` (i0, j0)
    the numbers of the mark on the origin.
    Raises MeasurementError, in a sentence that names file, line and column, for whatever is wrong.
    """
    if unit not in UNITS:
        raise MeasurementError(f"'{unit}' is not a unit of length; known are {', '.join(UNITS)}")
    table = read_table(Path(path))
    chosen = choose_columns(table, columns or {}, unit)
    table, notes = _without_lost(table, chosen)
    cells = {name: _numbers(table, chosen, name) for name in chosen.place}
    for name in set(cells).intersection(LENGTHS):
        cells[name] = cells[name] * UNITS[unit]
    u, v, said = _fabric_coordinates(table.source, cells, mark_spacing, mark_origin)
    if chosen.unused:
        notes += (f"{table.source}: columns not used: {', '.join(map(_unused, chosen.unused))}",)
    return Measurement(
        source=table.source,
        points=np.column_stack([cells["x"], cells["y"], cells["z"]]),
        u=u,
        v=v,
        shear=_shear(table, chosen, cells),
        warp=_directions(table, cells, "warp"),
        weft=_directions(table, cells, "weft"),
        sigma_xyz=_sigma(table, chosen, cells, "sigma_xyz"),
        sigma_shear=_sigma(table, chosen, cells, "sigma_shear"),
        sigma_direction=_sigma(table, chosen, cells, "sigma_direction"),
        replicate=_replicate(table, chosen, cells),
        row=np.array(table.lines, np.int64),
        notes=notes + said,
    )


def _without_lost(table: Table, chosen: Chosen) -> tuple[Table, tuple[str, ...]]:
    """The table without rows that have no position at all: marks that were lost. How many is said."""
    places = [chosen.place[name] for name in "xyz"]
    kept = [k for k, cells in enumerate(table.rows) if not all(is_open(cells[p]) for p in places)]
    lost = len(table.rows) - len(kept)
    if not kept:
        raise MeasurementError(f"{table.source}: x, y and z are empty in all {lost} rows: nothing is measured in it")
    if not lost:
        return table, ()
    rows, lines = tuple(table.rows[k] for k in kept), tuple(table.lines[k] for k in kept)
    first = min(set(table.lines).difference(lines))
    note = f"{table.source}: {lost} rows have no position (x, y, z empty, first in line {first}) and were left out"
    return Table(table.source, table.header, rows, lines, table.separator), (note,)


def _numbers(table: Table, chosen: Chosen, name: str) -> np.ndarray:
    """The column as (n,) floats. Raises MeasurementError at the first cell that is no finite number."""
    place = chosen.place[name]
    comma = table.separator != ","
    values = np.empty(len(table.rows))
    for k, cells in enumerate(table.rows):
        text = cells[place]
        value = number_of(text.removesuffix("°").rstrip() if name in ANGLES else text, comma)
        if value is None:
            _refuse(table, k, chosen.heading[name], f"'{text[:40]}' is not a number; correct it")
        elif math.isinf(value):
            _refuse(table, k, chosen.heading[name], f"'{text}' is not finite")
        elif math.isnan(value) and name not in OPTIONAL:
            _refuse(table, k, chosen.heading[name], "there is no number; fill it in or take the row out")
        else:
            values[k] = value
    return values


def _refuse(table: Table, k: int, heading: str, why: str) -> None:
    raise MeasurementError(f"{table.source}, line {table.lines[k]}, column '{heading}': {why}")


def _fabric_coordinates(
    source: str,
    cells: Mapping[str, np.ndarray],
    spacing: tuple[float, float] | None,
    origin: tuple[float, float],
) -> tuple[np.ndarray | None, np.ndarray | None, tuple[str, ...]]:
    """u, v (n,) mm of the marks, from their columns or from the marks' numbers, and what there is to say."""
    if "u" in cells:
        told = f"{source}: the spacing of the marks (--mark-spacing) is not used, as the table has u and v"
        return cells["u"], cells["v"], (told,) if spacing is not None else ()
    if "i" not in cells:
        if spacing is not None:
            raise MeasurementError(
                f"{source} has no columns i and j with the numbers of the marks; name them: --columns i=NAME,j=NAME"
            )
        return None, None, ()
    if spacing is None:
        note = f"{source}: i and j are not used, as the spacing of the marks is not given (--mark-spacing)"
        return None, None, (note,)
    if not all(math.isfinite(s) and s > 0.0 for s in spacing):
        raise MeasurementError(f"the spacing of the marks must be above 0 mm, not {spacing[0]:g}, {spacing[1]:g}")
    return (cells["i"] - origin[0]) * spacing[0], (cells["j"] - origin[1]) * spacing[1], ()


def _shear(table: Table, chosen: Chosen, cells: Mapping[str, np.ndarray]) -> np.ndarray | None:
    shear = cells.get("shear")
    if shear is None or np.isnan(shear).all():
        return None
    beyond = np.flatnonzero(np.abs(shear) >= 90.0)
    if len(beyond):
        k = int(beyond[0])
        why = f"{shear[k]:g} is no shear angle: it must lie between -90 and 90 degrees"
        if np.nanmin(shear) > 0.0 and abs(np.nanmedian(shear) - 90.0) < ABOUT_RIGHT:
            why += "; if the column holds the angle between warp and weft, give 90 less it"
        _refuse(table, k, chosen.heading["shear"], why)
    return shear


def _directions(table: Table, cells: Mapping[str, np.ndarray], family: str) -> np.ndarray | None:
    """Unit directions (n, 3) of a yarn family, NaN where open. Raises for half-filled rows and zero vectors."""
    if f"{family}_x" not in cells:
        return None
    vectors = np.column_stack([cells[f"{family}_{axis}"] for axis in "xyz"])
    given = np.isfinite(vectors)
    for k in np.flatnonzero(given.any(axis=1) & ~given.all(axis=1))[:1]:
        _refuse(table, int(k), f"{family}_x, {family}_y, {family}_z", "a direction needs all three numbers, or none")
    size = np.linalg.norm(vectors, axis=1)
    for k in np.flatnonzero(size == 0.0)[:1]:
        _refuse(table, int(k), f"{family}_x, {family}_y, {family}_z", "0, 0, 0 has no direction; leave it empty")
    return None if np.isnan(size).all() else vectors / size[:, None]


def _sigma(table: Table, chosen: Chosen, cells: Mapping[str, np.ndarray], name: str) -> np.ndarray | None:
    sigma = cells.get(name)
    if sigma is None or np.isnan(sigma).all():
        return None
    for k in np.flatnonzero(sigma <= 0.0)[:1]:
        _refuse(table, int(k), chosen.heading[name], f"{sigma[k]:g} is no standard deviation: it must be above 0")
    return sigma


def _replicate(table: Table, chosen: Chosen, cells: Mapping[str, np.ndarray]) -> np.ndarray | None:
    numbers = cells.get("replicate")
    if numbers is None:
        return None
    for k in np.flatnonzero((numbers != np.round(numbers)) | (np.abs(numbers) > 1e9))[:1]:
        _refuse(table, int(k), chosen.heading["replicate"], f"{numbers[k]:g} is not a whole number")
    return numbers.astype(np.int64)
