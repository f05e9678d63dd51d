"""What a drape comes to: fields on the part, the flat pattern, areas, bare regions, statistics and checks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from geomdrap.fields.strips import Roll
    from geomdrap.fields.trim import Trimmed
    from geomdrap.fishnet import Net


@dataclass(frozen=True, eq=False)
class FlatPattern:
    """The ply cut out flat, in fabric coordinates (u to the right, v up), mm, with the origin at the seed.

    ``outer`` polygons (k, 2) are counter-clockwise, ``inner`` ones (openings) clockwise, the first point not
    repeated. ``warp_lines`` run at constant v and ``weft_lines`` at constant u on multiples of the pitch, out to the
    contour. ``locked`` are polygons of cells beyond the limit angle. ``cuts`` are lines (2, 2) along which the fabric
    is cut while both sides stay where they are; cuts that open are contours.
    """

    outer: tuple[np.ndarray, ...]
    inner: tuple[np.ndarray, ...]
    warp_lines: tuple[np.ndarray, ...]
    weft_lines: tuple[np.ndarray, ...]
    locked: tuple[np.ndarray, ...]
    cuts: tuple[np.ndarray, ...] = ()

    @property
    def area(self) -> float:
        """Area inside the contours, mm²."""
        from geomdrap.fields.contour import signed_area

        return sum(signed_area(p) for p in (*self.outer, *self.inner))


@dataclass(frozen=True)
class Areas:
    """Areas in mm²: of the part, of what of it is draped, of the fabric that this takes; coverage 0..1."""

    part: float
    draped: float
    fabric: float
    coverage: float


@dataclass(frozen=True)
class BareRegion:
    """A connected stretch of the part without fabric: area mm², a point (3,) mm on it, and why."""

    area: float
    center: np.ndarray
    reason: str


@dataclass(frozen=True)
class ShearStatistics:
    """Absolute shear over the draped area, out to its rim, degrees; shares 0..1 of that area over half the limit and
    over it.
    """

    max: float
    p95: float
    mean: float
    over_half_limit: float
    over_limit: float


@dataclass(frozen=True)
class Checks:
    """How well the net keeps its promises.

    ``edge_error``: largest difference, as a share of the side, between the lengths of the two yarn pieces that close
    a cell, retraced, and their sides. ``off_surface`` mm: largest distance of a node from the part.
    ``curvature_residual`` degrees: how far shear at the nodes differs (95th percentile) from the angle deficits of
    the mesh inside their net rectangles (Gauss-Bonnet); None where the generators are no geodesics all the way.
    """

    edge_error: float
    off_surface: float
    curvature_residual: float | None


@dataclass(frozen=True, eq=False)
class Drape:
    """A net with everything that is read from it.

    Per facet of ``net.surface`` (m,): ``face_shear`` degrees, signed; ``face_warp``, ``face_weft`` (m, 3) unit
    vectors; ``face_thickness`` and ``face_fibre_volume``, factors on the flat fabric's; ``face_coverage`` 0..1;
    ``face_reason``, a ``Status``: why it is bare. NaN on bare facets. ``warnings`` are the net's, and what the result
    itself gives reason to doubt. ``trimmed``: the facets cut to the pitch, with fabric coordinates and directions, of
    which all of this was read. ``roll``: the strips of a roll that the pattern is laid from, where one was given.
    """

    net: Net
    limit_angle: float
    face_shear: np.ndarray
    face_warp: np.ndarray
    face_weft: np.ndarray
    face_thickness: np.ndarray
    face_fibre_volume: np.ndarray
    face_coverage: np.ndarray
    face_reason: np.ndarray
    flat: FlatPattern
    area: Areas
    bare: tuple[BareRegion, ...]
    statistics: ShearStatistics
    checks: Checks
    warnings: tuple[str, ...]
    trimmed: Trimmed
    roll: Roll | None = None
