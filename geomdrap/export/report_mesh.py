"""The ply as a mesh for a viewer in the browser: quantised, a vertex for each place in the fabric."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from geomdrap.export.ply_corners import STEPS, Box, on_octahedron, ply_corners
from geomdrap.export.report_merge import merged
from geomdrap.export.scene import sharp_edges

if TYPE_CHECKING:
    from geomdrap.fields import Drape

Floats = NDArray[np.float64]
Array = NDArray[Any]

PER_DEGREE = 100
"""Shear is kept to 0.01°."""
BARE = -32768
"""Shear of bare vertices: this plus the number of the `Status` that says why."""
MOST_EDGES = 0.25
"""Sharp edges per facet above which a part is rough all over, and only its rim is drawn."""


@dataclass(frozen=True)
class ReportMesh:
    """Vertices (n,) and triangles (m, 3) of the draped part, cut to the pitch.

    ``position`` (n, 3) and ``at`` (n, 2) uint16 in steps of ``space`` and ``fabric``; ``normal`` (n, 2) int16, on the
    octahedron; ``shear`` (n,) int16 in 0.01°, or ``BARE`` plus the reason; ``edges`` (k, 2, 3) uint16.
    """

    space: Box
    fabric: Box
    position: Array
    at: Array
    normal: Array
    shear: Array
    triangles: Array
    edges: Array


def report_mesh(result: Drape) -> ReportMesh:
    """The mesh of a drape; vertices are parted where the fabric, the normal or the reason differs on their facets."""
    corners = merged(ply_corners(result), result)
    points = result.trimmed.mesh.points
    space = Box.around(points)
    number, first = corners.joined()
    shear = np.rint(PER_DEGREE * corners.shear).astype(np.int64)
    shear[corners.bare] = BARE + corners.reason[corners.bare, None]
    return ReportMesh(
        space=space,
        fabric=corners.fabric,
        position=space.count(points)[corners.triangles.ravel()[first]],
        at=corners.fabric.count(corners.at).reshape(-1, 2)[first],
        normal=on_octahedron(corners.normals).reshape(-1, 2)[first],
        shear=shear.ravel()[first].astype(np.int16),
        triangles=number.astype(np.uint16 if len(first) <= STEPS else np.uint32),
        edges=space.count(drawn_edges(result.net.surface)),
    )


def drawn_edges(surface: Any) -> Floats:
    """End points (k, 2, 3) mm of the rim and of the creases; of the rim alone where nearly everything is a crease."""
    edges = sharp_edges(surface)
    if len(edges) <= MOST_EDGES * len(surface.triangles):
        return edges
    face, corner = np.nonzero(surface.neighbours < 0)
    ends = np.stack([surface.triangles[face, corner], surface.triangles[face, (corner + 1) % 3]], axis=1)
    return np.asarray(surface.points[ends])
