"""acp.csv: the ply at the centres of the elements, with the columns of a look-up table for Ansys ACP."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from geomdrap.export.fe_rows import rows
from geomdrap.export.map_onto import ElementPly
from geomdrap.export.whole import write_whole

COLUMNS = (
    *(f"{name}_{axis}" for name in ("Location", "Warp", "Weft") for axis in "xyz"),
    *("Shear", "Thickness", "WarpAngle", "WeftAngle", "U", "V", "Element"),
)
"""Location [mm], two directions, scalars: angles in degrees, thickness as a factor, or in mm."""


def write(ply: ElementPly, path: Path, ply_thickness: float | None = None) -> None:
    """Write the table, a row per element with ply. Raises GeomdrapError if it cannot be written."""
    on = ply.is_draped
    thickness = ply.thickness * (1.0 if ply_thickness is None else ply_thickness)
    scalars = (ply.shear, thickness, ply.ply_angle(ply.warp), ply.ply_angle(ply.weft), ply.at[:, 0], ply.at[:, 1])
    columns = [*ply.mesh.centers.T, *ply.warp.T, *ply.weft.T, *scalars, ply.mesh.element_ids]
    pattern = ",".join(["%.6f"] * (len(columns) - 1)) + ",%d"
    body = rows(pattern, *(np.asarray(column)[on] for column in columns))
    write_whole(path, "\n".join([",".join(COLUMNS), *body]) + "\n")
