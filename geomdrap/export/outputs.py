"""The list of result files: what `geomdrap drape --outputs` can write, and in which order."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from functools import partial
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from geomdrap.export import report_html, report_json
from geomdrap.export.whole import whole_folder

if TYPE_CHECKING:
    from geomdrap.fields import Drape


class Output(NamedTuple):
    """One result file: its key in the JSON's ``files``, its name, and the function that writes it.

    ``weight`` is about the time that it takes on a large part, of 1 for all; ``in_steps`` says that the function
    takes a ``progress`` of its own.
    """

    key: str
    file: str
    module: str
    weight: float
    function: str = "write"
    in_steps: bool = False

    def write(self, result: Drape, path: Path, progress: Callable[[float], None] = lambda _: None) -> None:
        """Write ``result`` to ``path``; the format's libraries are loaded only now."""
        writer: Callable[..., None] = getattr(import_module(self.module), self.function)
        if self.in_steps:
            writer(result, path, progress=progress)
        else:
            writer(result, path)


OUTPUTS: dict[str, tuple[Output, ...]] = {
    "json": (Output("json", "drape.json", "geomdrap.export.report_json", 0.01),),
    "csv": (Output("csv", "nodes.csv", "geomdrap.export.table", 0.3),),
    "vtu": (
        Output("net_vtu", "net.vtu", "geomdrap.export.vtu", 0.05, "write_net"),
        Output("part_vtu", "part.vtu", "geomdrap.export.vtu", 0.06, "write_part"),
    ),
    "png": (Output("png", "shear.png", "geomdrap.export.picture", 0.53, in_steps=True),),
    "dxf": (Output("dxf", "flat.dxf", "geomdrap.export.dxf", 0.04),),
    "svg": (Output("svg", "flat.svg", "geomdrap.export.svg", 0.01),),
    "html": (Output("html", "report.html", "geomdrap.export.report_html", 0.05),),
}


def write_all(
    result: Drape,
    folder: Path,
    names: Iterable[str] = tuple(OUTPUTS),
    progress: Callable[[float], None] = lambda _: None,
    command: str = "",
) -> dict[str, Path]:
    """Write the outputs ``names`` of ``result`` to ``folder``; all of them appear together, or none does.

    Returns the path of each file by its key (``json``, ``csv``, ``net_vtu``, ``part_vtu``, ``png``,
    ``dxf``, ``svg``, ``html``). ``progress`` is called with the share done, 0 to 1; ``command`` is the command line
    that the report shows. Raises `GeomdrapError` if the folder cannot be written.
    """
    wanted = list(names)
    chosen = [output for name in OUTPUTS if name in wanted for output in OUTPUTS[name]]
    if not chosen:
        return {}
    whole = sum(output.weight for output in chosen)
    files = {output.key: folder / output.file for output in chosen}
    with whole_folder(folder) as scratch:
        before = 0.0
        for output in chosen:
            within = partial(_part_of, progress, before / whole, output.weight / whole)
            if output.key == "json":
                report_json.write(result, scratch / output.file, files)
            elif output.key == "html":
                report_html.write(result, scratch / output.file, command)
            else:
                output.write(result, scratch / output.file, within)
            within(1.0)
            before += output.weight
    return files


def _part_of(progress: Callable[[float], None], before: float, weight: float, share: float) -> None:
    """Pass on the share of a part of the work that begins at ``before`` and is ``weight`` of it."""
    progress(before + weight * share)


def left_over(folder: Path, files: Iterable[Path]) -> list[str]:
    """Name the result files in ``folder`` that are not among ``files``: they are of another, earlier run."""
    written = {file.name for file in files}
    known = [output.file for outputs in OUTPUTS.values() for output in outputs]
    return [name for name in known if name not in written and (folder / name).exists()]
