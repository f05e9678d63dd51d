"""The result files of ``geomdrap diagnose`` and ``geomdrap improve``."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geomdrap import __version__
from geomdrap.export import diagnose_picture, improve_picture
from geomdrap.export.report_json import as_text, plain
from geomdrap.export.whole import whole_folder, write_whole

if TYPE_CHECKING:
    from geomdrap.criticism import Diagnosis, Improvement

DIAGNOSE_OUTPUTS = {"json": "diagnose.json", "png": "diagnose.png"}


def as_dict(diagnosis: Diagnosis, files: Mapping[str, str | Path] | None = None) -> dict[str, Any]:
    """The JSON object of a diagnosis (schema geomdrap.diagnose/1), with its version and the paths of its files."""
    names = {key: str(path) for key, path in (files or {}).items()}
    return plain({**diagnosis.as_dict(), "version": __version__, "files": names})


def write_diagnosis(diagnosis: Diagnosis, folder: Path, names: Iterable[str]) -> dict[str, Path]:
    """Write the outputs ``names`` to ``folder``, all together or none; the path of each file by its key.

    Raises `GeomdrapError` if the folder cannot be written.
    """
    wanted = list(names)
    files = {key: folder / name for key, name in DIAGNOSE_OUTPUTS.items() if key in wanted}
    if files:
        with whole_folder(folder) as scratch:
            for key, path in files.items():
                if key == "json":
                    write_whole(
                        scratch / path.name, as_text(as_dict(diagnosis, {k: p.name for k, p in files.items()}))
                    )
                else:
                    diagnose_picture.write(diagnosis, scratch / path.name)
    return files


def write_improvement(improvement: Improvement, model: Path) -> dict[str, Path]:
    """Write the model file, and improve.json and improve.png beside it, all together or none."""
    from geomdrap.effects import write_model

    files = {"model": model, "json": model.parent / "improve.json", "png": model.parent / "improve.png"}
    with whole_folder(model.parent) as scratch:
        meant = improvement.diagnosis.experiment.as_meant(improvement.effects)
        write_model(scratch / model.name, improvement.effects, improvement.notes, meant)
        write_whole(scratch / "improve.json", as_text(plain(improvement.as_dict(model.name))))
        improve_picture.write(improvement, scratch / "improve.png")
    return files
