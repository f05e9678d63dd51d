"""Read a part from a file."""

from __future__ import annotations

from importlib import import_module
from pathlib import Path

import numpy as np

from geomdrap.errors import SurfaceError
from geomdrap.surface.formats import READERS, RawMesh
from geomdrap.surface.surface import Surface

#: mm across beyond which a part read in inches or centimetres is more likely in mm (200 mm read in inches are 5 m)
LARGEST_CONVERTED = 3_000.0
#: units of length in mm
UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4}


def read_surface(
    path: str | Path, *, unit: str = "mm", tolerance: float | None = None, flip: bool = False
) -> Surface:
    """Read a part: STL, OBJ, PLY, OFF, GLB, VTU, VTK, MSH, INP, BDF, and with the [cad] extra STEP and IGES.

    unit is the file's unit of length (mm, cm, m, in); STEP and IGES files know their own. tolerance [mm] is
    how far the triangles of a STEP or IGES file may lie from its surface. flip turns the normals.
    Raises SurfaceError, in one sentence, for whatever keeps the file from being read.
    """
    path = Path(path)
    if unit not in UNITS:
        raise SurfaceError(f"unit {unit!r} is not known; use one of {', '.join(UNITS)}")
    raw = _read_raw(path, tolerance)
    if raw.scale is not None and unit != "mm":
        raise SurfaceError(f"{path.name} knows its own unit; leave the unit {unit!r} out")
    if len(raw.triangles) == 0:
        raise SurfaceError(f"{path.name} holds no triangles; export the part as a triangulated surface")
    scale = UNITS[unit] if raw.scale is None else raw.scale
    surface = Surface(
        np.asarray(raw.points, dtype=np.float64) * scale,
        raw.triangles,
        source=path.name,
        face_numbers=raw.face_numbers,
        notes=raw.notes,
    )
    surface = _with_doubt(surface, unit)
    if path.suffix.lower() == ".stl":
        surface = surface.numbered_as_welded()  # the points of an STL file have no numbers of their own
    return surface.flipped() if flip else surface


def _with_doubt(surface: Surface, unit: str) -> Surface:
    """The part with a hint where its numbers look like mm, but were read as inches or centimetres."""
    if unit not in ("in", "cm") or surface.diagonal <= LARGEST_CONVERTED or surface.findings.unit_hint:
        return surface
    return surface.doubted(
        f"read with --unit {unit} the part is {surface.diagonal / 1000:.3g} m across, in mm it would be "
        f"{surface.diagonal / UNITS[unit]:.4g} mm: is the file in mm already?"
    )


def _read_raw(path: Path, tolerance: float | None) -> RawMesh:
    """Check what can be checked without reading, then hand over to the format's reader."""
    try:
        if path.is_dir():
            raise SurfaceError(f"{path} is a folder; name a mesh file in it")
        if not path.exists():
            raise SurfaceError(f"{path} does not exist; check the name of the part's file")
        reader = READERS.get(path.suffix.lower())
        known = ", ".join(READERS)
        if not path.suffix:
            raise SurfaceError(f"{path.name}: the name must end with the file's format, one of {known}; rename it")
        if reader is None:
            raise SurfaceError(f"{path.name}: files '{path.suffix}' cannot be read; use one of {known}")
        if path.stat().st_size == 0:
            raise SurfaceError(f"{path.name} is empty; export the part again")
        with path.open("rb"):
            pass
        raw: RawMesh = import_module(f"geomdrap.surface.formats.{reader}").read(path, tolerance)
    except PermissionError:
        raise SurfaceError(f"{path} may not be read; ask for permission to read it") from None
    except (OSError, ValueError) as error:  # ValueError: a NUL in the name
        raise SurfaceError(f"{path} cannot be read ({error}); check the file") from None
    return raw
