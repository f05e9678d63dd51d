"""The result files of ``geomdrap sweep`` and ``geomdrap optimize``."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geomdrap.export.optimize_json import as_dict as optimum_as_dict
from geomdrap.export.outputs import Extras, write_all
from geomdrap.export.report_json import as_text
from geomdrap.export.sweep_json import as_dict
from geomdrap.export.sweep_table import as_text as as_table
from geomdrap.export.whole import whole_folder, write_whole

if TYPE_CHECKING:
    from geomdrap.fields import Drape
    from geomdrap.sweep import Optimum, Sweep

SWEEP_OUTPUTS = {"json": "sweep.json", "csv": "sweep.csv", "png": "sweep.png", "best": "best"}
OPTIMIZE_OUTPUTS = {"json": "optimize.json", "csv": "optimize.csv", "png": "optimize.png", "best": "best"}


def write_sweep(
    sweep: Sweep,
    best: Drape,
    folder: Path,
    names: Iterable[str],
    progress: Callable[[float], None] = lambda _: None,
    notes: Sequence[str] = (),
    command: str = "",
) -> dict[str, Path]:
    """Write the outputs ``names`` of a sweep to ``folder``; the path of each by its key.

    ``best`` is the best case, whose own files go to a folder of that name; ``notes`` on the cases go before its own;
    ``command`` is the command line that its report shows. Raises `GeomdrapError` if the folder cannot be written.
    """
    files = _chosen(SWEEP_OUTPUTS, folder, names)
    return _write(files, sweep, None, best, partial(as_dict, sweep, best, notes=notes), command, progress)


def write_optimum(
    optimum: Optimum,
    best: Drape,
    folder: Path,
    names: Iterable[str],
    progress: Callable[[float], None] = lambda _: None,
    notes: Sequence[str] = (),
    command: str = "",
) -> dict[str, Path]:
    """The same of an optimum: the table holds all drapes, the picture the sweep and the way of the search."""
    files = _chosen(OPTIMIZE_OUTPUTS, folder, names)
    document = partial(optimum_as_dict, optimum, best, notes=notes)
    return _write(files, optimum.sweep, optimum, best, document, command, progress)


def _chosen(outputs: dict[str, str], folder: Path, names: Iterable[str]) -> dict[str, Path]:
    wanted = list(names)
    return {key: folder / name for key, name in outputs.items() if key in wanted}


def _write(
    files: dict[str, Path],
    sweep: Sweep,
    optimum: Optimum | None,
    best: Drape,
    document: Callable[[dict[str, str]], dict[str, Any]],
    command: str,
    progress: Callable[[float], None],
) -> dict[str, Path]:
    """Write what is in ``files``: the best drape to a folder of its own, the rest together."""
    from geomdrap.export import sweep_picture

    if "best" in files:
        write_all(best, files["best"], progress=lambda share: progress(0.7 * share), extras=Extras(command))
    if not files:
        return files
    with whole_folder(next(iter(files.values())).parent) as scratch:
        if "json" in files:
            named = {key: path.name for key, path in files.items()}
            write_whole(scratch / files["json"].name, as_text(document(named)))
        if "csv" in files:
            write_whole(scratch / files["csv"].name, as_table(sweep))
        if "png" in files:
            shown, path = (sweep, ()) if optimum is None else (optimum.shown, optimum.path)
            sweep_picture.write(shown, scratch / files["png"].name, path)
    progress(1.0)
    return files
