"""The ply on the elements of a finite element mesh: directions, shear and thickness at their centres."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import GeomdrapError
from geomdrap.export.fe_mesh import FeMesh, Floats, angle_between, laid_into, mesh_of_part
from geomdrap.export.ply_corners import at_corners, barycentric, piece_shear, ply_corners
from geomdrap.fields.evaluate import unit_directions, unit_vectors
from geomdrap.surface.nearest import NearestTree

if TYPE_CHECKING:
    from geomdrap.fields import Drape
    from geomdrap.surface import Surface

TINY = 1.0 / 20.0
"""Of the part's size: a mesh that is smaller is in inches or metres, and would all lie on one spot."""
SMALL = 1.0 / 5.0
"""Of the part's size, below which the unit of the mesh is doubted."""
STEEP = np.cos(np.radians(60.0))
"""Cosine between the normals of an element and of the facet nearest to it below which they are not the same wall."""


@dataclass(frozen=True, eq=False)
class ElementPly:
    """A ply on the elements (m,) of a mesh; NaN where ``is_draped`` is not set.

    ``relative_size``: of the mesh, over the part's.

    ``warp`` and ``weft`` (m, 3) unit vectors in the planes of the elements; ``shear`` (m,) degrees, signed as on the
    part; ``thickness`` (m,) factor on the flat fabric's; ``at`` (m, 2) mm in the flat fabric; ``distance`` (m,) mm
    from the part. ``axis``: the direction (3,) whose projection is 0° of ply angles; None: the material's.
    """

    mesh: FeMesh
    warp: Floats
    weft: Floats
    shear: Floats
    thickness: Floats
    at: Floats
    distance: Floats
    is_draped: NDArray[np.bool_]
    axis: tuple[float, float, float] | None = None
    relative_size: float = 1.0

    def side_angle(self, direction: Floats) -> Floats:
        """Degrees (m,) from the sides 1-2 to a direction (m, 3), counter-clockwise about the elements' normals."""
        return angle_between(self.mesh.sides, direction, self.mesh.normals)

    def ply_angle(self, direction: Floats) -> Floats:
        """Degrees (m,) from the axes of ply angles to a direction (m, 3), counter-clockwise about the normals."""
        normals = self.mesh.normals
        if self.axis is None:
            return angle_between(self.mesh.axes, direction, normals)
        along = np.broadcast_to(np.asarray(self.axis, float), normals.shape)
        return angle_between(laid_into(along, normals), direction, normals)

    @property
    def axis_words(self) -> str:
        """What ply angles count from, in words."""
        if self.axis is None:
            return "the element's own material axis (its side 1-2 where the mesh names none)"
        return "({:g}, {:g}, {:g}) laid into the element".format(*self.axis)

    def notes(self) -> list[str]:
        """Sentences on what is doubtful: elements without ply, a mesh much smaller than the part."""
        notes = []
        if self.mesh.others:
            kinds = ", ".join(self.mesh.others)
            notes.append(f"{self.mesh.source} has elements that are no shells ({kinds}), which carry no ply")
        if self.relative_size < SMALL:
            notes.append(f"{self.mesh.source} has {self.relative_size:.2g} of the part's size; is it in mm?")
        without = int((~self.is_draped).sum())
        if not without:
            return notes
        first = ", ".join(str(n) for n in self.mesh.element_ids[~self.is_draped][:3])
        return [
            *notes,
            f"{without:,} of {len(self.is_draped):,} elements of {self.mesh.source} have no ply ({first} ...): the "
            "part is bare there, further away than one pitch, or inclined to them by more than 60°",
        ]


def map_onto(
    result: Drape, mesh: FeMesh | None = None, axis: tuple[float, float, float] | None = None
) -> ElementPly:
    """The ply at the centre of each element, read at the nearest point of the part.

    Without a mesh the part's own facets are the elements. Directions and shear are linear over the facets there (cut
    to the pitch), and continuous but at creases. An element has no ply where the part is bare, lies further away than
    a pitch, or is inclined by more than 60°. Raises GeomdrapError where no element has any, or the mesh is in another
    unit.
    """
    mesh = mesh if mesh is not None else mesh_of_part(result.net.surface)
    relative = require_size(mesh, result.net.surface)
    trimmed = result.trimmed
    pieces = trimmed.mesh
    centers, normals = mesh.centers, mesh.normals
    near = NearestTree(pieces.points, pieces.triangles).query(centers)
    piece = near.face
    corners = pieces.points[pieces.triangles[piece]]
    shares = barycentric(near.point[:, None], corners)[:, 0]
    at = np.einsum("mc,mck->mk", shares, trimmed.at[piece])
    facing = (result.net.surface.normals[pieces.parent[piece]] * normals).sum(axis=1)
    on = (trimmed.kind[piece] > 0) & (near.distance <= result.net.pitch) & (np.abs(facing) > STEEP)
    if result.net.reach is not None:
        on &= (np.abs(np.nan_to_num(at)) <= np.asarray(result.net.reach)).all(axis=1)
    if not on.any():
        raise GeomdrapError(
            f"no element of {mesh.source} lies on the draped part; is it the same part, in mm and in the same place?"
        )
    warp, weft, shear = interpolated(result, piece, shares)
    gone = ~on
    for values in (warp, weft, shear, at):
        values[gone] = np.nan
    return ElementPly(
        mesh=mesh,
        warp=laid_into(warp, normals),
        weft=laid_into(weft, normals),
        shear=shear,
        thickness=1.0 / np.cos(np.radians(shear)),
        at=at,
        distance=near.distance,
        is_draped=on,
        axis=axis,
        relative_size=relative,
    )


def require_size(mesh: FeMesh, part: Surface) -> float:
    """Size of the mesh over that of the part. Raises GeomdrapError where that can only be another unit."""
    corners = mesh.points[mesh.corners[:, :3]].reshape(-1, 3)
    relative = float(np.linalg.norm(corners.max(axis=0) - corners.min(axis=0)) / part.diagonal)
    if relative < TINY or relative > 1.0 / TINY:
        raise GeomdrapError(
            f"{mesh.source} is {relative:.1g} times as large as the part; write the mesh in mm (--unit is the part's)"
        )
    return relative


def interpolated(result: Drape, piece: np.ndarray, shares: Floats) -> tuple[Floats, Floats, Floats]:
    """Warp and weft (k, 3) and shear (k,) at shares (k, 3) of the corners of facets cut to the pitch (k,)."""
    joined, _ = ply_corners(result).joined()

    def field(values: Floats) -> Floats:
        return np.asarray((at_corners(values, result.trimmed.area, joined)[piece] * shares).sum(axis=1))

    both = []
    for directions in unit_directions(result.trimmed):
        both.append(unit_vectors(np.column_stack([field(component) for component in directions.T])))
    return both[0], both[1], field(piece_shear(result))
