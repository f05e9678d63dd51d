"""residuals.csv: a row for each measured point, with prediction, residual and why there is none."""

from __future__ import annotations

import csv
import io
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.export.whole import write_whole

if TYPE_CHECKING:
    from geomdrap.criticism import Comparison


def write(comparison: Comparison, path: Path) -> None:
    """Write residuals.csv; empty cells where something is not known. Measured less predicted, mm and degrees."""
    write_whole(path, as_text(comparison))


def as_text(comparison: Comparison) -> str:
    """The table as text, rows in the order of the measurement."""
    columns = columns_of(comparison)
    cells = [_texts(values) for values in columns.values()]
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(["line", *columns, "outlier", "reason"])
    outliers = {outlier.row: outlier.kind for outlier in comparison.outliers}
    for k, line in enumerate(comparison.measurement.row.tolist()):
        numbers = [column[k] for column in cells]
        writer.writerow([line, *numbers, outliers.get(k, ""), comparison.matched.reason[k]])
    return out.getvalue()


def columns_of(comparison: Comparison) -> dict[str, np.ndarray]:
    """Columns of numbers (n,) by name; those that were not measured are left out."""
    measurement, matched, places = comparison.measurement, comparison.matched, comparison.places
    columns = {"u": matched.u, "v": matched.v}
    columns |= dict(zip("xyz", measurement.points.T, strict=True))
    columns |= {f"predicted_{axis}": values for axis, values in zip("xyz", matched.point.T, strict=True)}
    columns |= {f"residual_{axis}": values for axis, values in zip("xyz", comparison.vector.T, strict=True)}
    names = ("along_warp", "along_weft", "normal")
    parts = dict(zip(names, comparison.parts.T, strict=True))
    columns |= {name: values for name, values in parts.items() if measurement.labelled or name == "normal"}
    columns["predicted_shear"] = matched.shear
    optional = {
        "shear": measurement.shear,
        "residual_shear": comparison.shear,
        "warp_turn": comparison.warp_turn,
        "weft_turn": comparison.weft_turn,
    }
    columns |= {name: values for name, values in optional.items() if values is not None}
    return columns | {"distance": places.distance, "curvature": places.curvature, "rim": places.rim}


def _texts(values: np.ndarray) -> list[str]:
    rounded = np.round(values, 6) + 0.0  # + 0.0 turns −0.000000 into 0.000000
    return [f"{x:.6f}" if np.isfinite(x) else "" for x in rounded.tolist()]
