"""What a reader hands over."""

from __future__ import annotations

from dataclasses import dataclass

from geomdrap.surface.types import Floats, Ints


@dataclass(frozen=True)
class RawMesh:
    """Triangles as they stand in a file.

    points (n, 3) in the file's unit, triangles (m, 3); face_numbers (m,) where a face of the file gave more
    than one triangle; scale is the file's own unit in mm, where the file knows it (STEP, IGES).
    """

    points: Floats
    triangles: Ints
    face_numbers: Ints | None = None
    notes: tuple[str, ...] = ()
    scale: float | None = None
