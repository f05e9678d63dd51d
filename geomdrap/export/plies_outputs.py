"""The result files of a stack of plies: a folder per ply, and plies.json over all."""

from __future__ import annotations

import re
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geomdrap import __version__
from geomdrap.export.outputs import Extras, write_all
from geomdrap.export.report_json import as_dict as drape_as_dict
from geomdrap.export.report_json import as_text, is_incomplete, plain
from geomdrap.export.whole import write_whole

if TYPE_CHECKING:
    from geomdrap.export.map_onto import ElementPly
    from geomdrap.sweep import Ply

SCHEMA = "geomdrap.plies/1"
FILE = "plies.json"


def as_dict(
    plies: Sequence[Ply], thickness: float | None, files: Mapping[int, Mapping[str, Path]] | None = None
) -> dict[str, Any]:
    """The JSON object of a stack (schema ``geomdrap.plies/1``): that of each ply's drape, and what lies below it."""
    stack = [
        {
            "number": ply.number,
            "ply_angle": ply.angle,
            "below": {"mean": ply.below[0], "max": ply.below[1]},
            **drape_as_dict(ply.drape, (files or {}).get(ply.number)),
        }
        for ply in plies
    ]
    return plain(
        {
            "schema": SCHEMA,
            "version": __version__,
            "part": Path(plies[0].tool.source).name,
            "ply_thickness": thickness,
            "fabric": sum(ply.drape.area.fabric for ply in plies),
            "incomplete": any(is_incomplete(ply.drape) for ply in plies),
            "plies": stack,
        }
    )


def write_plies(
    plies: Sequence[Ply],
    extras: Extras,
    folder: Path,
    names: Iterable[str],
    progress: Callable[[float], None] = lambda _: None,
    elements: Sequence[ElementPly | None] = (),
) -> dict[int, dict[str, Path]]:
    """Write the outputs ``names`` of every ply to ``folder/ply-NUMBER``, and plies.json; the files of each ply.

    ``extras`` hold the thickness of a ply, and what some formats take; ``elements``: each ply on elements, where they
    are made already.
    Raises `GeomdrapError` if a folder cannot be written.
    """
    wanted = list(names)
    if not wanted:
        return {}
    files = {}
    for ply, on in zip(plies, elements or [None] * len(plies), strict=True):
        own = replace(extras, elements=on)
        files[ply.number] = write_all(ply.drape, folder / f"ply-{ply.number}", wanted, extras=own)
        progress(ply.number / len(plies))
    named = {
        number: {key: Path(path.parent.name, path.name) for key, path in own.items()} for number, own in files.items()
    }
    write_whole(folder / FILE, as_text(as_dict(plies, extras.ply_thickness, named)))
    return files


def left_over_plies(folder: Path, numbers: Collection[int]) -> list[str]:
    """Name the folders of plies in ``folder`` that are none of ``numbers``: they are of another, earlier run."""
    there = sorted(int(path.name[4:]) for path in folder.glob("ply-*") if re.fullmatch(r"ply-\d+", path.name))
    return [f"ply-{number}" for number in there if number not in numbers]
