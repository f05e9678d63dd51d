"""The list of result files: what `geomdrap drape --outputs` can write, and in which order."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from geomdrap.export.whole import whole_folder

if TYPE_CHECKING:
    from geomdrap.criticism import Comparison
    from geomdrap.export.map_onto import ElementPly
    from geomdrap.fields import Drape


@dataclass(frozen=True)
class Extras:
    """What some formats take beside the drape.

    ``command``: the command line that the report shows. ``elements``: the ply on a finite element mesh; None: on the
    part's own facets. ``ply_thickness`` mm of the flat fabric, for decks that hold thicknesses. ``paper``: A4 or A3.
    """

    command: str = ""
    elements: ElementPly | None = None
    ply_thickness: float | None = None
    paper: str = "A4"


class Output(NamedTuple):
    """One result file: its key in the JSON's ``files``, its name, and the function that writes it.

    The result is a drape or a comparison. ``weight`` is about the time that it takes on a large part, against that of
    the others; ``takes`` says what the function takes: ``result``; ``progress``, the result and a ``progress`` of its
    own; ``files``, the result and the paths of all files; ``command``, the result and the command line; ``elements``,
    the ply on elements and its thickness; ``paper``, the result and the paper.
    """

    key: str
    file: str
    module: str
    weight: float = 1.0
    function: str = "write"
    takes: str = "result"

    def write(
        self,
        result: Drape | Comparison,
        path: Path,
        extras: Extras,
        files: Mapping[str, Path],
        progress: Callable[[float], None] = lambda _: None,
    ) -> None:
        """Write to ``path``; the format's libraries are loaded only now."""
        writer: Callable[..., None] = getattr(import_module(self.module), self.function)
        if self.takes == "elements":
            writer(extras.elements, path, extras.ply_thickness)
        elif self.takes == "files":
            writer(result, path, files)
        elif self.takes == "command":
            writer(result, path, extras.command)
        elif self.takes == "paper":
            writer(result, path, extras.paper)
        elif self.takes == "progress":
            writer(result, path, progress=progress)
        else:
            writer(result, path)


OUTPUTS: dict[str, tuple[Output, ...]] = {
    "json": (Output("json", "drape.json", "geomdrap.export.report_json", 0.01, takes="files"),),
    "csv": (Output("csv", "nodes.csv", "geomdrap.export.table", 0.3),),
    "vtu": (
        Output("net_vtu", "net.vtu", "geomdrap.export.vtu", 0.05, "write_net"),
        Output("part_vtu", "part.vtu", "geomdrap.export.vtu", 0.06, "write_part"),
    ),
    "png": (Output("png", "shear.png", "geomdrap.export.picture", 0.53, takes="progress"),),
    "dxf": (Output("dxf", "flat.dxf", "geomdrap.export.dxf", 0.04),),
    "svg": (Output("svg", "flat.svg", "geomdrap.export.svg", 0.01),),
    "html": (Output("html", "report.html", "geomdrap.export.report_html", 0.05, takes="command"),),
    "cut": (Output("cut", "cut.dxf", "geomdrap.export.cut_dxf", 0.04),),
    "pdf": (Output("pdf", "cut.pdf", "geomdrap.export.cut_pdf", 0.5, takes="paper"),),
    "abaqus": (Output("abaqus", "fe.inp", "geomdrap.export.fe_abaqus", 0.2, takes="elements"),),
    "nastran": (Output("nastran", "fe.bdf", "geomdrap.export.fe_nastran", 0.2, takes="elements"),),
    "optistruct": (Output("optistruct", "fe.fem", "geomdrap.export.fe_optistruct", 0.1, takes="elements"),),
    "radioss": (Output("radioss", "fe.inc", "geomdrap.export.fe_radioss", 0.1, takes="elements"),),
    "acp": (Output("acp", "acp.csv", "geomdrap.export.fe_acp", 0.2, takes="elements"),),
}

USUAL = ("json", "csv", "vtu", "png", "dxf", "svg", "html")
"""What is written if nothing else is asked for."""


def write_all(
    result: Drape,
    folder: Path,
    names: Iterable[str] = USUAL,
    progress: Callable[[float], None] = lambda _: None,
    extras: Extras | None = None,
) -> dict[str, Path]:
    """Write the outputs ``names`` of ``result`` to ``folder``; all of them appear together, or none does.

    Returns the path of each file by its key (those of `OUTPUTS`; ``vtu`` are ``net_vtu`` and ``part_vtu``).
    ``progress`` is called with the share done, 0 to 1. Raises `GeomdrapError` if the folder cannot be written.
    """
    wanted = list(names)
    chosen = [output for name in OUTPUTS if name in wanted for output in OUTPUTS[name]]
    if not chosen:
        return {}
    given = with_elements(result, chosen, extras or Extras())
    whole = sum(output.weight for output in chosen)
    files = {output.key: folder / output.file for output in chosen}
    with whole_folder(folder) as scratch:
        before = 0.0
        for output in chosen:
            within = partial(_part_of, progress, before / whole, output.weight / whole)
            output.write(result, scratch / output.file, given, files, within)
            within(1.0)
            before += output.weight
    return files


def with_elements(result: Drape, chosen: Iterable[Output], extras: Extras) -> Extras:
    """Fill in the ply on the part's own facets where an output needs elements and none are given."""
    if extras.elements is not None or not any(output.takes == "elements" for output in chosen):
        return extras
    from geomdrap.export.map_onto import map_onto

    return replace(extras, elements=map_onto(result))


def _part_of(progress: Callable[[float], None], before: float, weight: float, share: float) -> None:
    """Pass on the share of a part of the work that begins at ``before`` and is ``weight`` of it."""
    progress(before + weight * share)


def left_over(folder: Path, files: Iterable[Path], known: Iterable[str] | None = None) -> list[str]:
    """Name the result files in ``folder`` that are not among ``files``: they are of another, earlier run.

    ``known`` are the names that there can be; those of a drape if None.
    """
    written = {file.name for file in files}
    if known is None:
        known = [output.file for outputs in OUTPUTS.values() for output in outputs]
    return [name for name in known if name not in written and (folder / name).exists()]
