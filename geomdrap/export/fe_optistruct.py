"""fe.fem: the ply for OptiStruct, as a DRAPE entry: thickness factor and turn of the ply per element."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from geomdrap.export.fe_nastran import check_numbers
from geomdrap.export.fe_rows import rows
from geomdrap.export.map_onto import ElementPly
from geomdrap.export.whole import write_whole


def write(ply: ElementPly, path: Path, ply_thickness: float | None = None) -> None:
    """Write the include file. Raises GeomdrapError if numbers do not fit or the file cannot be written.

    DRAPE: an identification, then per line entity type, element, thinning factor, angle (Altair OptiStruct reference
    guide, DRAPE). The angle counts from the element's material axis, or from ``ply.axis`` where that is given: the
    model's material axis must then be the same. The PLY adds its own THETA.
    """
    check_numbers(ply)
    write_whole(path, "\n".join(lines(ply, ply_thickness)) + "\n")


def lines(ply: ElementPly, ply_thickness: float | None) -> Iterator[str]:
    """The lines of the file: fields of eight columns."""
    on = ply.is_draped
    flat = "T" if ply_thickness is None else f"{ply_thickness:g}"
    yield f"$ Ply on {ply.mesh.source}: factor on the thickness, and angle of the warp"
    yield f"$ from {ply.axis_words}"
    yield f"$ use: PLY, id, material, {flat}, 0.0, , , 1   (thickness of the flat fabric, THETA 0, DRAPE 1)"
    if not on.all():
        yield f"$ {int((~on).sum())} elements have no ply and are not listed"
    yield f"{'DRAPE':<8}{1:>8}"
    factor, angle = ply.thickness[on], ply.ply_angle(ply.warp)[on]
    yield from rows("+       ELEM    %8d%8.5f%8.3f", ply.mesh.element_ids[on], factor, angle)
