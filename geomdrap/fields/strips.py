"""Strips of a roll of fabric that a flat pattern is laid from, and the seams between them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geomdrap.fields.contour import signed_area


@dataclass(frozen=True, eq=False)
class RollStrip:
    """A strip of the roll, laid along the warp.

    ``v`` and ``u``: from, to, mm, of what the pattern has within, half the overlap at each seam with it; ``contours``
    (k, 2) mm of that, outer ones counter-clockwise.
    """

    v: tuple[float, float]
    u: tuple[float, float]
    contours: tuple[np.ndarray, ...]

    @property
    def length(self) -> float:
        """What is cut off the roll, mm."""
        return self.u[1] - self.u[0]

    @property
    def pieces(self) -> int:
        """How many loose pieces it is of; ``length`` has the gaps between them."""
        return sum(signed_area(ring) > 0.0 for ring in self.contours)

    @property
    def area(self) -> float:
        """Of the pattern within the strip, mm²."""
        return float(sum(signed_area(ring) for ring in self.contours))


@dataclass(frozen=True, eq=False)
class Seam:
    """A seam between two strips, the middle of their overlap.

    ``v`` mm; ``pieces`` (2, 2) mm of the line that lie on the pattern, openings left out; ``on_part``: polylines
    (k, 3) mm on the part; ``max_shear`` degrees, the largest without its sign, at ``max_shear_at`` (3,) mm.
    """

    v: float
    pieces: tuple[np.ndarray, ...]
    on_part: tuple[np.ndarray, ...]
    max_shear: float
    max_shear_at: np.ndarray

    @property
    def length(self) -> float:
        """In the flat fabric, mm."""
        return float(sum(piece[1, 0] - piece[0, 0] for piece in self.pieces))


@dataclass(frozen=True, eq=False)
class Roll:
    """The strips from -v to +v and the seams between them; ``width`` of the roll and ``overlap`` of strips, mm."""

    width: float
    overlap: float
    strips: tuple[RollStrip, ...]
    seams: tuple[Seam, ...]

    @property
    def length(self) -> float:
        """Of the roll that is used, strip after strip, mm."""
        return sum(strip.length for strip in self.strips)

    @property
    def waste(self) -> float:
        """Share 0..1 of that which is not pattern; what lies double in an overlap is none."""
        used = self.width * self.length
        return 1.0 - sum(strip.area for strip in self.strips) / used if used > 0.0 else 0.0
