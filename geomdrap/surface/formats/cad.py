"""STEP and IGES through cascadio (OpenCASCADE), as triangles within a tolerance."""

from __future__ import annotations

import contextlib
import io
import os
import sys
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Literal

from geomdrap.errors import SurfaceError
from geomdrap.surface.formats import polygons
from geomdrap.surface.formats.raw import RawMesh

#: greatest distance [mm] of the triangles from the CAD surface where none is asked for
TOLERANCE = 0.05
#: greatest angle between neighbouring triangles; cascadio's own 0.5 rad gives a fillet three facets
ANGLE_RAD = 0.1
#: cascadio hands STEP over in metres (as glTF wants), IGES in mm; the file's own unit is already seen to
SCALE = {"step": 1000.0, "iges": 1.0}


def read(path: Path, tolerance: float | None) -> RawMesh:
    """Triangulate a CAD file so that it is within the tolerance [mm] of the true surface.

    Raises SurfaceError where cascadio is missing or the file has no faces.
    """
    try:
        import cascadio
    except ImportError:
        raise SurfaceError(
            f"{path.name}: reading STEP and IGES needs cascadio; install it with: pip install 'geomdrap[cad]'"
        ) from None
    if tolerance is not None and not 0.0 < tolerance < float("inf"):
        raise SurfaceError(f"the tessellation tolerance must be above 0 mm, not {tolerance}")
    kind: Literal["iges", "step"] = "iges" if path.suffix.lower().startswith(".ig") else "step"
    data = path.read_bytes()
    try:
        with _silent():
            glb = cascadio.load(
                data,
                file_type=kind,
                tol_linear=TOLERANCE if tolerance is None else tolerance,
                tol_angular=ANGLE_RAD,
            )
    except (RuntimeError, ValueError):
        glb = b""
    if not glb:
        raise SurfaceError(f"{path.name} cannot be read as {kind.upper()}; export the part again")
    mesh = polygons.load(io.BytesIO(glb), "glb", path.name)
    return replace(mesh, scale=SCALE[kind])


@contextlib.contextmanager
def _silent() -> Iterator[None]:
    """Keep OpenCASCADE's own messages, written past Python, out of the terminal and of ``--json``."""
    sys.stdout.flush()
    sys.stderr.flush()
    kept = [os.dup(1), os.dup(2)]
    try:
        with open(os.devnull, "w") as nowhere:
            os.dup2(nowhere.fileno(), 1)
            os.dup2(nowhere.fileno(), 2)
        yield
    finally:
        for number, original in enumerate(kept, 1):
            os.dup2(original, number)
            os.close(original)
