"""A finite element mesh of shells, with the numbers that its own file gives to nodes and elements."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import GeomdrapError
from geomdrap.fields.evaluate import unit_vectors

if TYPE_CHECKING:
    from geomdrap.surface import Surface

Floats = NDArray[np.float64]
Ints = NDArray[np.int64]
Nodes = dict[int, tuple[float, float, float]]
"""Coordinates by number."""
Elements = list[tuple[int, int, tuple[int, ...]]]
"""Number, part, numbers of 3 or 4 corners."""


@dataclass(frozen=True)
class Deck:
    """The text that a mesh was read from: its lines, and for each element its first and last line and its fields."""

    lines: tuple[str, ...]
    spans: tuple[tuple[int, int], ...]
    names: tuple[str, ...]
    fields: tuple[tuple[str, ...], ...]


@dataclass(frozen=True, eq=False)
class FeMesh:
    """Triangles and quadrilaterals by their corners.

    ``node_ids`` (n,), ``points`` (n, 3) mm; ``element_ids`` (m,), ``parts`` (m,) of their properties or parts,
    ``corners`` (m, 4) rows of ``points``, -1 for the fourth corner of triangles; ``material_angle`` (m,) degrees from
    the side 1-2 to the element's own material axis, counter-clockwise about its normal; ``material_axis`` (m, 3) if
    that axis is instead the projection of a direction, else NaN. ``is_given``: read from ``source``, a file of the
    user's own, which knows nodes and elements; ``deck``: its text, where a format writes that again; ``others``:
    types of elements in the file that are no shells, and are not among these.
    """

    source: str
    node_ids: Ints
    points: Floats
    element_ids: Ints
    parts: Ints
    corners: Ints
    material_angle: Floats
    material_axis: Floats
    is_given: bool = True
    deck: Deck | None = None
    others: tuple[str, ...] = ()

    @property
    def is_quad(self) -> NDArray[np.bool_]:
        """Which elements (m,) have four corners."""
        return np.asarray(self.corners[:, 3] >= 0)

    @property
    def centers(self) -> Floats:
        """Mean (m, 3) of the corners."""
        corners = self.points[self.corners]
        four = corners.mean(axis=1)
        return np.where(self.is_quad[:, None], four, corners[:, :3].mean(axis=1))

    @property
    def normals(self) -> Floats:
        """Unit normals (m, 3) by the order of the corners; of quadrilaterals across their diagonals."""
        a, b, c, d = self.points[self.corners].swapaxes(0, 1)
        d = np.where(self.is_quad[:, None], d, a)
        across = np.where(self.is_quad[:, None], np.cross(c - a, d - b), np.cross(b - a, c - a))
        return np.asarray(unit_vectors(across))

    @property
    def sides(self) -> Floats:
        """Unit directions (m, 3) of the sides 1-2, laid into the planes of the elements."""
        a, b = self.points[self.corners[:, 0]], self.points[self.corners[:, 1]]
        return laid_into(b - a, self.normals)

    @property
    def axes(self) -> Floats:
        """Unit directions (m, 3) of the elements' own material axes, from which ply angles count."""
        normals, sides = self.normals, self.sides
        angle = np.radians(self.material_angle)[:, None]
        turned = np.cos(angle) * sides + np.sin(angle) * np.cross(normals, sides)
        by_axis = np.isfinite(self.material_axis[:, 0])
        return np.where(by_axis[:, None], laid_into(np.nan_to_num(self.material_axis), normals), turned)


def laid_into(vectors: Floats, normals: Floats) -> Floats:
    """Vectors (k, 3) projected onto the planes of unit normals (k, 3), of length one."""
    return np.asarray(unit_vectors(vectors - (vectors * normals).sum(axis=1, keepdims=True) * normals))


def angle_between(start: Floats, end: Floats, normals: Floats) -> Floats:
    """Degrees (k,) from start to end (k, 3), counter-clockwise about the normals, above -180 up to 180."""
    sine = (np.cross(start, end) * normals).sum(axis=1)
    angle = np.degrees(np.arctan2(sine, (start * end).sum(axis=1)))
    return np.asarray(np.where(angle <= -180.0, angle + 360.0, angle))


def mesh_of_part(surface: Surface) -> FeMesh:
    """The part's own triangles, numbered from 1."""
    m = len(surface.triangles)
    return FeMesh(
        source=surface.source,
        node_ids=np.arange(1, len(surface.points) + 1),
        points=np.asarray(surface.points),
        element_ids=np.arange(1, m + 1),
        parts=np.ones(m, np.int64),
        corners=np.column_stack([surface.triangles.astype(np.int64), np.full(m, -1)]),
        material_angle=np.zeros(m),
        material_axis=np.full((m, 3), np.nan),
        is_given=False,
    )


def assemble(
    name: str,
    nodes: Nodes,
    elements: Elements,
    *,
    others: Iterable[str] = (),
    material_angle: Floats | None = None,
    material_axis: Floats | None = None,
    deck: Deck | None = None,
) -> FeMesh:
    """A mesh from what a file holds. Without material angles and axes the side 1-2 is the material's.

    Raises GeomdrapError where there are no shells, or one is there twice, names a node that is not there, or has no
    area.
    """
    if not elements:
        raise GeomdrapError(f"{name} holds no shell elements; export the mesh of the part with its shells")
    ids = np.array([element[0] for element in elements], np.int64)
    if len(np.unique(ids)) < len(ids):
        values, counts = np.unique(ids, return_counts=True)
        raise GeomdrapError(
            f"{name}: element {values[counts > 1][0]} is there twice; export one part with unique numbers"
        )
    row = {number: k for k, number in enumerate(nodes)}
    try:
        corners = np.array([[*(row[n] for n in e[2]), *[-1] * (4 - len(e[2]))] for e in elements], np.int64)
    except KeyError as missing:
        raise GeomdrapError(f"{name}: an element has node {missing}, which is not there; export all nodes") from None
    m = len(elements)
    mesh = FeMesh(
        source=name,
        node_ids=np.array(list(nodes), np.int64),
        points=np.array(list(nodes.values()), float).reshape(-1, 3),
        element_ids=ids,
        parts=np.array([element[1] for element in elements], np.int64),
        corners=corners,
        material_angle=np.zeros(m) if material_angle is None else material_angle,
        material_axis=np.full((m, 3), np.nan) if material_axis is None else material_axis,
        deck=deck,
        others=tuple(sorted(others)),
    )
    flat = np.abs(mesh.normals).sum(axis=1) == 0.0
    if flat.any():
        raise GeomdrapError(f"{name}: element {ids[flat][0]} has no area; repair the mesh")
    return mesh
