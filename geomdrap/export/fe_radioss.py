"""fe.inc: the ply for Radioss, as a /DRAPE block: thickness factor and turn of the ply per element."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np

from geomdrap.export.fe_rows import rows
from geomdrap.export.map_onto import ElementPly
from geomdrap.export.whole import write_whole

TITLE = 100
"""Characters that a title may have."""


def write(ply: ElementPly, path: Path, ply_thickness: float | None = None) -> None:
    """Write the include file. Raises GeomdrapError if it cannot be written.

    /DRAPE: title, then per line entity (10 columns), number (10), thinning (20), angle (20), as the starter reads it
    (Radioss starter input, /DRAPE). The factor multiplies the thickness of the /PLY; the angle is added to its own.
    It counts from the element's material axis, its side 1-2 where the mesh names none, or from ``ply.axis`` where
    that is given: the property's reference vector must then be the same.
    """
    write_whole(path, "\n".join(lines(ply, ply_thickness)) + "\n")


def lines(ply: ElementPly, ply_thickness: float | None) -> Iterator[str]:
    """The lines of the file."""
    on = ply.is_draped
    yield "#---1----|----2----|----3----|----4----|----5----|----6----|----7----|----8----|----9----|---10----|"
    yield f"# angles count from {ply.axis_words}"
    if ply_thickness is not None:
        yield f"# thickness of the flat fabric: {ply_thickness:g} mm, to be given to the ply; angle of the ply: 0"
    if not on.all():
        yield f"# {int((~on).sum())} elements have no ply and are not listed"
    yield "/DRAPE/1"
    yield f"Ply on {ply.mesh.source}"[:TITLE]
    yield "#   Entity Entity_ID            Thinning          thetaDrape"
    angle = ply.ply_angle(ply.warp)
    for name, those in (("SHELL", ply.mesh.is_quad), ("SH3N", ~ply.mesh.is_quad)):
        k = np.flatnonzero(on & those)
        yield from rows(f"{name:<10}%10d%20.6f%20.6f", ply.mesh.element_ids[k], ply.thickness[k], angle[k])
