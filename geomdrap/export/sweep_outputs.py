"""The result files of ``geomdrap sweep``."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from geomdrap.export.outputs import write_all
from geomdrap.export.report_json import as_text
from geomdrap.export.sweep_json import as_dict
from geomdrap.export.sweep_table import as_text as as_table
from geomdrap.export.whole import whole_folder, write_whole

if TYPE_CHECKING:
    from geomdrap.fields import Drape
    from geomdrap.sweep import Sweep

SWEEP_OUTPUTS = {"json": "sweep.json", "csv": "sweep.csv", "png": "sweep.png", "best": "best"}


def write_sweep(
    sweep: Sweep, best: Drape, folder: Path, names: Iterable[str], progress: Callable[[float], None] = lambda _: None
) -> dict[str, Path]:
    """Write the outputs ``names`` of a sweep to ``folder``; the path of each by its key.

    ``best`` is the best case, whose own files go to a folder of that name. Raises `GeomdrapError` if the folder
    cannot be written.
    """
    wanted = list(names)
    files = {key: folder / name for key, name in SWEEP_OUTPUTS.items() if key in wanted}
    if "best" in files:
        write_all(best, files["best"], progress=lambda share: progress(0.7 * share))
    if files:
        with whole_folder(folder) as scratch:
            for key, path in files.items():
                _write(key, sweep, scratch / path.name, {k: Path(p.name) for k, p in files.items()})
    progress(1.0)
    return files


def _write(key: str, sweep: Sweep, path: Path, files: dict[str, Path]) -> None:
    if key == "json":
        write_whole(path, as_text(as_dict(sweep, files)))
    elif key == "csv":
        write_whole(path, as_table(sweep))
    elif key == "png":
        from geomdrap.export import sweep_picture

        sweep_picture.write(sweep, path)
