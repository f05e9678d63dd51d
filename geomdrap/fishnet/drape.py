"""``drape``: the whole method on one screen."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import DrapeError
from geomdrap.fishnet import seed as seeds
from geomdrap.fishnet.extent import Extent, first_extent, grow, sides
from geomdrap.fishnet.fabric import Fabric
from geomdrap.fishnet.front import carry_front_on
from geomdrap.fishnet.grid import PIECES, Grid, empty_grid
from geomdrap.fishnet.march import fill_quadrants, lay_generators
from geomdrap.fishnet.net import Net
from geomdrap.fishnet.pitch import check_pitch, choose_pitch, coarse_facets
from geomdrap.fishnet.place import all_in_space, place_seed
from geomdrap.geodesic.mesh import Mesh, mesh_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from geomdrap.surface import Surface


def drape(
    surface: Surface,
    origin: seeds.Origin = "centroid",
    angle: float = 0.0,
    pitch: float | None = None,
    reach: tuple[float, float] | None = None,
    fabric: Fabric | None = None,
    *,
    reference: Sequence[float] | None = None,
    project: bool = False,
) -> Net:
    """Drape a fabric over a surface from a seed.

    Parameters: ``origin`` is ``"centroid"``, a point (3,) mm, a vertex number or ``"vertex:NUMBER"``; ``angle``
    the heading of the warp, degrees counter-clockwise about the normal from ``reference`` (default the part's
    +x); ``pitch`` the side of a cell, mm (chosen from the part if None); ``reach`` half lengths of the blank
    along warp and weft, mm; ``project`` allows an origin further than a pitch from the surface.
    Raises SurfaceError where the part cannot be draped, DrapeError for an impossible seed, heading, pitch or
    blank.

    Source: H. Borouchaki and A. Cherouat, GeomDrap (modified MOSAIC).
    """
    fabric = fabric or Fabric()
    if not math.isfinite(angle):
        raise DrapeError(f"the heading must be a finite number of degrees, not {angle}")
    surface.require_drapable()
    face, _, distance = seeds.locate(surface, origin)
    part = surface.only_component(face)
    pitch, notes = (check_pitch(part, pitch), ()) if pitch is not None else choose_pitch(part)
    _check_distance(surface, origin, distance, pitch, project)
    start = seeds.plant(part, origin if part is surface else seeds.locate(surface, origin)[1], angle,
                        None if reference is None else np.asarray(reference, dtype=float), fabric.weft_angle)
    mesh = mesh_of(part)
    extent = first_extent(part, start, pitch, reach)
    while True:
        grid = _march(mesh, start, extent, pitch, fabric)
        larger = grow(extent, grid, part, pitch)
        if larger == extent:
            break
        extent = larger
    return _as_net(surface, part, start, angle, pitch, reach, fabric, extent, mesh, grid, notes)


def _march(mesh: Mesh, start: seeds.Seed, extent: Extent, pitch: float, fabric: Fabric) -> Grid:
    """Seed, generators (α-nodes), cells (β-nodes), and the front carried on."""
    grid = empty_grid(*sides(extent, pitch))
    i0, j0 = extent.west, extent.south
    x, y = _seed_in_frame(mesh, start)
    place_seed(mesh, grid, i0, j0, start.face, x, y, math.radians(fabric.weft_angle))
    lay_generators(mesh, grid, i0, j0, start.starts, start.places)
    fill_quadrants(mesh, grid, i0, j0)
    carry_front_on(mesh, grid, i0, j0)
    return grid


def _seed_in_frame(mesh: Mesh, start: seeds.Seed) -> tuple[float, float]:
    origin, e1, e2 = mesh.frames[start.face].reshape(3, 3)
    return float((start.point - origin) @ e1), float((start.point - origin) @ e2)


def _check_distance(surface: Surface, origin: seeds.Origin, distance: float, pitch: float, project: bool) -> None:
    """The centroid is projected by definition; a point further off than a pitch is more likely a mistake."""
    if origin == "centroid" if isinstance(origin, str) else False:
        return
    if distance > pitch and not project:
        raise DrapeError(
            f"the origin lies {distance:.6g} mm from {surface.source}, more than the pitch of {pitch:.6g} mm; "
            "move it, or use project=True (--project) to take the nearest point"
        )


def _as_net(
    surface: Surface,
    part: Surface,
    start: seeds.Seed,
    angle: float,
    pitch: float,
    reach: tuple[float, float] | None,
    fabric: Fabric,
    extent: Extent,
    mesh: Mesh,
    grid: Grid,
    notes: tuple[str, ...],
) -> Net:
    """Cut the grid to the nodes that are there and turn it into a Net."""
    i0, i1, j0, j1 = (int(k) for k in grid.box)
    near = np.s_[i0 : i1 + 1, j0 : j1 + 1]
    points = all_in_space(mesh, grid, i0, i1 + 1, j0, j1 + 1)
    pieces = grid.marks[near][..., PIECES]
    warp, weft = (pieces & 1) != 0, (pieces & 2) != 0
    valid = warp[:-1, :-1] & warp[:-1, 1:] & weft[:-1, :-1] & weft[1:, :-1]
    if part is not surface:
        others = surface.n_components - 1
        notes = (*notes, f"the part has {others + 1} separate pieces; the one with the origin is draped")
    return Net(
        surface=part,
        fabric=fabric,
        origin=start.point,
        origin_face=start.face,
        warp0=start.warp,
        weft0=start.weft,
        normal0=start.normal,
        angle=float(angle),
        pitch=float(pitch),
        reach=reach,
        u=(np.arange(i0, i1 + 1) - extent.west) * pitch,
        v=(np.arange(j0, j1 + 1) - extent.south) * pitch,
        points=points,
        face=np.asarray(grid.face[near]) - 1,
        status_around=extent.status_around(grid),
        cell_valid=valid,
        notes=notes,
        warnings=coarse_facets(part, pitch),
    )
