"""residuals.vtu: the measured points with their residual vectors, for ParaView and the like (Glyph filter)."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.export.compare_table import columns_of
from geomdrap.export.whole import whole_file

if TYPE_CHECKING:
    from geomdrap.criticism import Comparison


def write(comparison: Comparison, path: Path) -> None:
    """Write the compared points as vertices: ``residual`` (3,) mm and the columns of residuals.csv.

    Points without a prediction are there too, with NaN and ``used`` 0; ``outlier`` is 1 where a value stands out.
    """
    import meshio

    points = comparison.measurement.points
    skipped = ("x", "y", "z", "residual_x", "residual_y", "residual_z")
    fields = {name: values for name, values in columns_of(comparison).items() if name not in skipped}
    flags = {
        "used": comparison.used.astype(np.int32),
        "outlier": (comparison.used & ~comparison.trusted).astype(np.int32),
        "line": comparison.measurement.row,
    }
    mesh = meshio.Mesh(
        points,
        [("vertex", np.arange(len(points), dtype=np.int64)[:, None])],
        point_data={"residual": comparison.vector, **fields, **flags},
    )
    with whole_file(path) as temporary:
        mesh.write(temporary, file_format="vtu", compression=None)
