"""The part that a command drapes: read from its file, and cut along the lines that are drawn on it."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from geomdrap.surface import Surface


def read_part(part: Path, unit: str, tolerance: float | None, flip: bool, cuts: tuple[Path, ...]) -> Surface:
    """The surface of a part's file, with a slit along each line of points (columns x, y, z, mm) in ``cuts``."""
    from geomdrap.surface import read_surface
    from geomdrap.sweep.origins import read_points

    surface = read_surface(part, unit=unit, tolerance=tolerance, flip=flip)
    if cuts:
        surface = surface.cut(*(read_points(file) for file in cuts), names=[file.name for file in cuts])
    return surface
