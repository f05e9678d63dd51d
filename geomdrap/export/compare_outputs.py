"""The result files of ``geomdrap compare``."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING

from geomdrap.export.outputs import Extras, Output
from geomdrap.export.whole import whole_folder

if TYPE_CHECKING:
    from geomdrap.criticism import Comparison

COMPARE_OUTPUTS = {
    "json": Output("json", "compare.json", "geomdrap.export.compare_json", takes="files"),
    "csv": Output("csv", "residuals.csv", "geomdrap.export.compare_table"),
    "vtu": Output("vtu", "residuals.vtu", "geomdrap.export.compare_vtu"),
    "png": Output("png", "compare.png", "geomdrap.export.compare_picture"),
}


def write_comparison(comparison: Comparison, folder: Path, names: Iterable[str]) -> dict[str, Path]:
    """Write the outputs ``names`` to ``folder``, all together or none; the path of each file by its key.

    Raises `GeomdrapError` if the folder cannot be written.
    """
    wanted = list(names)
    chosen = [output for name, output in COMPARE_OUTPUTS.items() if name in wanted]
    if not chosen:
        return {}
    files = {output.key: folder / output.file for output in chosen}
    with whole_folder(folder) as scratch:
        for output in chosen:
            output.write(comparison, scratch / output.file, Extras(), files)
    return files
