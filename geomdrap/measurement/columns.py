"""Which column of a table is which quantity."""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass

from geomdrap.errors import MeasurementError
from geomdrap.measurement.table import Table

COLUMNS = {
    "x": "position, mm",
    "y": "position, mm",
    "z": "position, mm",
    "u": "mark's place along the warp in the flat fabric, mm from the origin",
    "v": "mark's place along the weft in the flat fabric, mm from the origin",
    "i": "number of the mark along the warp, with the spacing of the marks instead of u",
    "j": "number of the mark along the weft, with the spacing of the marks instead of v",
    "shear": "shear angle, degrees, positive where +u and +v close",
    "warp_x": "warp direction",
    "warp_y": "warp direction",
    "warp_z": "warp direction",
    "weft_x": "weft direction",
    "weft_y": "weft direction",
    "weft_z": "weft direction",
    "sigma_xyz": "standard deviation of each coordinate, mm",
    "sigma_shear": "standard deviation of the shear angle, degrees",
    "sigma_direction": "standard deviation of the yarns' directions, degrees",
    "replicate": "number of the repetition",
}
"""Names of the columns that are understood, and what they hold."""

TOGETHER = (("x", "y", "z"), ("u", "v"), ("i", "j"), ("warp_x", "warp_y", "warp_z"), ("weft_x", "weft_y", "weft_z"))
"""Columns that say nothing alone."""

ANGLES = ("shear", "sigma_shear", "sigma_direction")
"""Columns in degrees."""

LENGTHS = ("x", "y", "z", "u", "v", "sigma_xyz")
"""Columns that --unit-measured applies to."""


@dataclass(frozen=True)
class Chosen:
    """``place``: column number of each quantity found; ``heading``: its name as written; ``unused`` headings."""

    place: dict[str, int]
    heading: dict[str, str]
    unused: tuple[str, ...]


def choose_columns(table: Table, mapping: Mapping[str, str], unit: str) -> Chosen:
    """Find the columns by their own names or those of ``mapping`` (quantity -> heading).

    Upper and lower case are the same, and a unit in brackets after the name is left out. Raises MeasurementError for
    unknown quantities, headings that are missing or twice there, and units in brackets that are not ``unit``.
    """
    for name in mapping:
        if name not in COLUMNS:
            raise MeasurementError(f"'{name}' is not a quantity of a measured table; known are {', '.join(COLUMNS)}")
    place = {name: _find(table, wanted) for name, wanted in mapping.items()}
    for name in COLUMNS:
        if name not in place:
            taken = [k for k in _matches(table, name) if k not in place.values()]
            if len(taken) > 1:
                _refuse_twice(table, taken)
            if taken:
                place[name] = taken[0]
    _require_groups(table, place)
    heading = {name: table.header[k] for name, k in place.items()}
    _check_units(table.source, heading, unit)
    unused = tuple(name for k, name in enumerate(table.header) if name and k not in place.values())
    return Chosen(place, heading, unused)


def bare_name(heading: str) -> str:
    """A heading in lower case without the unit in brackets at its end."""
    return re.sub(r"\s*[\[(][^\])]*[\])]\s*$", "", heading).strip().lower()


def _matches(table: Table, wanted: str) -> list[int]:
    """Numbers of the columns with that name; an exact match goes before one in other case or without its unit."""
    exact = [k for k, name in enumerate(table.header) if name == wanted]
    return exact or [k for k, name in enumerate(table.header) if wanted.lower() in (name.lower(), bare_name(name))]


def _find(table: Table, wanted: str) -> int:
    found = _matches(table, wanted.strip())
    if not found:
        raise MeasurementError(f"{table.source} has no column '{wanted}'; its columns are {_listed(table)}")
    if len(found) > 1:
        _refuse_twice(table, found)
    return found[0]


def _refuse_twice(table: Table, places: list[int]) -> None:
    names = " and ".join(f"'{table.header[k]}'" for k in places)
    raise MeasurementError(
        f"{table.source}: the header names the same column twice, {names} (columns "
        f"{' and '.join(str(k + 1) for k in places)}); rename one"
    )


def _require_groups(table: Table, place: Mapping[str, int]) -> None:
    for group in TOGETHER:
        missing = [name for name in group if name not in place]
        if missing and (group[0] == "x" or len(missing) < len(group)):
            raise MeasurementError(
                f"{table.source} has no column {' and no '.join(missing)}: {', '.join(group)} are needed together; "
                f"its columns are {_listed(table)}; name others with --columns, as in --columns {missing[0]}=NAME"
            )


def _check_units(source: str, heading: Mapping[str, str], unit: str) -> None:
    """A length or angle whose heading says another unit is refused: it would be wrong by a factor, in silence."""
    for name in LENGTHS:
        found = re.search(r"[\[(]\s*(mm|cm|m|in|inch)\s*[\])]\s*$", heading.get(name, ""), flags=re.IGNORECASE)
        said = found[1].lower().replace("inch", "in") if found else unit
        if said != unit:
            raise MeasurementError(
                f"{source}: the heading '{heading[name]}' says {said}, but lengths are read as {unit}: use "
                f"--unit-measured {said}"
            )
    for name in ANGLES:
        found = re.search(r"[\[(]\s*(m?rad|radians?|gon|grad)\s*[\])]\s*$", heading.get(name, ""), re.IGNORECASE)
        if found:
            raise MeasurementError(
                f"{source}: the heading '{heading[name]}' says {found[1]}, but angles are read as degrees: convert "
                "the column"
            )


def _listed(table: Table) -> str:
    return ", ".join(name or "(no name)" for name in table.header)
