"""The list of result files: what `geomdrap drape --outputs` can write, and in which order."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from importlib import import_module
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from geomdrap.export import report_json
from geomdrap.export.whole import whole_folder

if TYPE_CHECKING:
    from geomdrap.fields import Drape


class Output(NamedTuple):
    """One result file: its key in the JSON's ``files``, its name, and the function that writes it."""

    key: str
    file: str
    module: str
    function: str = "write"

    def write(self, result: Drape, path: Path) -> None:
        """Write ``result`` to ``path``; the format's libraries are loaded only now."""
        writer: Callable[[Drape, Path], None] = getattr(import_module(self.module), self.function)
        writer(result, path)


OUTPUTS: dict[str, tuple[Output, ...]] = {
    "json": (Output("json", "drape.json", "geomdrap.export.report_json"),),
    "csv": (Output("csv", "nodes.csv", "geomdrap.export.table"),),
    "vtu": (
        Output("net_vtu", "net.vtu", "geomdrap.export.vtu", "write_net"),
        Output("part_vtu", "part.vtu", "geomdrap.export.vtu", "write_part"),
    ),
    "png": (Output("png", "shear.png", "geomdrap.export.picture"),),
    "dxf": (Output("dxf", "flat.dxf", "geomdrap.export.dxf"),),
    "svg": (Output("svg", "flat.svg", "geomdrap.export.svg"),),
}


def write_all(
    result: Drape,
    folder: Path,
    names: Iterable[str] = tuple(OUTPUTS),
    progress: Callable[[float], None] | None = None,
) -> dict[str, Path]:
    """Write the outputs ``names`` of ``result`` to ``folder``; all of them appear together, or none does.

    Returns the path of each file by its key (``json``, ``csv``, ``net_vtu``, ``part_vtu``, ``png``,
    ``dxf``, ``svg``). ``progress`` is called with the share done, 0 to 1. Raises `GeomdrapError` if the
    folder cannot be written.
    """
    wanted = list(names)
    chosen = [output for name in OUTPUTS if name in wanted for output in OUTPUTS[name]]
    if not chosen:
        return {}
    files = {output.key: folder / output.file for output in chosen}
    with whole_folder(folder) as scratch:
        for done, output in enumerate(chosen, start=1):
            if output.key == "json":
                report_json.write(result, scratch / output.file, files)
            else:
                output.write(result, scratch / output.file)
            if progress is not None:
                progress(done / len(chosen))
    return files


def left_over(folder: Path, files: Iterable[Path]) -> list[str]:
    """Name the result files in ``folder`` that are not among ``files``: they are of another, earlier run."""
    written = {file.name for file in files}
    known = [output.file for outputs in OUTPUTS.values() for output in outputs]
    return [name for name in known if name not in written and (folder / name).exists()]
