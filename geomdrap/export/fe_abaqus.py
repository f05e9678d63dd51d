"""fe.inp: the ply for Abaqus, as *DISTRIBUTION and *ORIENTATION per element, to be included in a model."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from geomdrap.export.fe_mesh import Floats
from geomdrap.export.fe_rows import rows
from geomdrap.export.map_onto import ElementPly
from geomdrap.export.whole import write_whole

PER_LINE = 16
"""Numbers on a data line of *ELSET, as many as the format takes."""


def write(ply: ElementPly, path: Path, ply_thickness: float | None = None) -> None:
    """Write the include file; ``ply_thickness`` mm of the flat fabric. Raises GeomdrapError if it cannot be."""
    write_whole(path, "\n".join(lines(ply, ply_thickness)) + "\n")


def lines(ply: ElementPly, ply_thickness: float | None) -> Iterator[str]:
    """The lines of the file."""
    mesh = ply.mesh
    yield from head(ply, ply_thickness)
    if not mesh.is_given:
        yield "*NODE"
        yield from rows("%d, %.6f, %.6f, %.6f", mesh.node_ids, *mesh.points.T)
        yield "*ELEMENT, TYPE=S3, ELSET=GEOMDRAP_ALL"
        yield from rows("%d, %d, %d, %d", mesh.element_ids, *mesh.node_ids[mesh.corners[:, :3]].T)
    ids = mesh.element_ids[ply.is_draped]
    yield "*ELSET, ELSET=GEOMDRAP_PLY"
    for start in range(0, len(ids), PER_LINE):
        yield ", ".join(map(str, ids[start : start + PER_LINE].tolist()))
    yield "*DISTRIBUTION TABLE, NAME=GEOMDRAP_AXES_TABLE"
    yield "COORD3D, COORD3D"
    for name, direction in (("WARP", ply.warp), ("WEFT", ply.weft)):
        yield from axes(ply, name, direction)
    if ply_thickness is not None:
        yield "*DISTRIBUTION TABLE, NAME=GEOMDRAP_THICKNESS_TABLE"
        yield "LENGTH"
        yield "*DISTRIBUTION, NAME=GEOMDRAP_THICKNESS, LOCATION=ELEMENT, TABLE=GEOMDRAP_THICKNESS_TABLE"
        yield f", {ply_thickness:.6g}"
        yield from rows("%d, %.6f", ids, ply_thickness * ply.thickness[ply.is_draped])


def head(ply: ElementPly, ply_thickness: float | None) -> Iterator[str]:
    """Comments: what this is and how it is used."""
    yield f"** Ply on {ply.mesh.source}: axes per element. Axis 1 is the yarn, axis 3 the element's normal."
    yield "** GEOMDRAP_WARP_AXES follows the warp, GEOMDRAP_WEFT_AXES the weft. Where the fabric shears these are not"
    yield "** at right angles: use one for each yarn family, or the first with a material for the sheared fabric."
    yield "** *DISTRIBUTION TABLE belongs to the model; in a file with parts move these blocks out of the part."
    use = ", SHELL THICKNESS=GEOMDRAP_THICKNESS" if ply_thickness is not None else ""
    yield f"** *SHELL SECTION, ELSET=GEOMDRAP_PLY, MATERIAL=..., ORIENTATION=GEOMDRAP_WARP_AXES{use}"
    if not ply.is_draped.all():
        yield f"** {int((~ply.is_draped).sum())} elements have no ply: they are not in GEOMDRAP_PLY."


def axes(ply: ElementPly, name: str, direction: Floats) -> Iterator[str]:
    """A distribution of points a (on axis 1) and b (in the plane of axes 1 and 2), and the orientation by it."""
    on = ply.is_draped
    first = direction[on]
    second = np.cross(ply.mesh.normals[on], first)
    yield f"*DISTRIBUTION, NAME=GEOMDRAP_{name}, LOCATION=ELEMENT, TABLE=GEOMDRAP_AXES_TABLE"
    yield ", 1., 0., 0., 0., 1., 0."
    yield from rows("%d, %.7f, %.7f, %.7f, %.7f, %.7f, %.7f", ply.mesh.element_ids[on], *first.T, *second.T)
    yield f"*ORIENTATION, NAME=GEOMDRAP_{name}_AXES, SYSTEM=RECTANGULAR, DEFINITION=COORDINATES"
    yield f"GEOMDRAP_{name}"
    yield "3, 0."
