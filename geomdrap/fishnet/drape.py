"""``drape``: the whole method on one screen."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import DrapeError
from geomdrap.fishnet import seed as seeds
from geomdrap.fishnet.effect import Effect, in_order, net_with
from geomdrap.fishnet.extent import Extent, first_extent, grow, sides
from geomdrap.fishnet.fabric import Fabric
from geomdrap.fishnet.front import branch_off, carry_front_on
from geomdrap.fishnet.grid import PIECES, STRAIN, Grid, Status, empty_grid
from geomdrap.fishnet.laid_down import Start, laid_down
from geomdrap.fishnet.march import fill_quadrants, lay_generators
from geomdrap.fishnet.net import Net, cells_of
from geomdrap.fishnet.pitch import coarse_facets
from geomdrap.fishnet.place import APART, all_in_space, place_seed
from geomdrap.fishnet.relax_net import relaxed
from geomdrap.fishnet.shear import shears, yarn_directions
from geomdrap.fishnet.slide import fill_quadrants_sliding, strain_on_axis
from geomdrap.fishnet.steer import Guides, generator_turns
from geomdrap.geodesic.mesh import Mesh

if TYPE_CHECKING:
    from collections.abc import Sequence

    from geomdrap.surface import Surface


UNSETTLED = 1e-3  # of the length of a side
AXIS_ROUNDS, AXIS_STRAIN = 10, 1e-8  # marches until a sliding weft generator has its length: one, without skew


def drape(
    surface: Surface,
    origin: seeds.Origin = "centroid",
    angle: float = 0.0,
    pitch: float | None = None,
    reach: tuple[float, float] | None = None,
    fabric: Fabric | None = None,
    effects: Sequence[Effect] = (),
    *,
    reference: Sequence[float] | None = None,
    project: bool = False,
    warp_guide: Sequence[Sequence[float]] | np.ndarray | None = None,
    weft_guide: Sequence[Sequence[float]] | np.ndarray | None = None,
    near: Net | None = None,
) -> Net:
    """Drape a fabric over a surface from a seed.

    Parameters: ``origin`` is ``"centroid"``, a point (3,) mm, a vertex number or ``"vertex:NUMBER"``; ``angle``
    the heading of the warp, degrees counter-clockwise about the normal from ``reference`` (default the part's
    +x); ``pitch`` the side of a cell, mm (chosen from the part if None); ``reach`` half lengths of the blank
    along warp and weft, mm; ``effects`` act before and after (see ``Effect``); ``project`` allows an origin further
    than a pitch from the surface. ``warp_guide`` and ``weft_guide``, points (k, 3) mm of curves on the part, steer
    the generators along them: the origin is then the point of the guide nearest to ``origin``, or where the two
    cross, and the warp runs along its guide whatever the ``angle``. ``near`` is a net of a ply much like this one:
    one of least energy is sought from where its nodes have gone, which takes less time; a coarser one is refined.
    Raises SurfaceError where the part cannot be draped, DrapeError for an impossible seed, heading, pitch or
    blank.

    Source: H. Borouchaki and A. Cherouat, GeomDrap (modified MOSAIC).
    """
    acting = in_order(effects)
    start = laid_down(
        surface, origin, angle, pitch, fabric or Fabric(), acting, reference, project, (warp_guide, weft_guide)
    )
    part, mesh, seed, pitch, fabric = start.part, start.mesh, start.seed, start.pitch, start.fabric
    extent = first_extent(part, seed, pitch, reach)
    while True:
        grid = _march_sliding(mesh, seed, extent, pitch, fabric, start.guides)
        larger = grow(extent, grid, pitch)
        if larger == extent:
            break
        extent = larger
    _require_cells(grid, part, pitch)
    net = _as_net(start, reach, extent, grid)
    if fabric.relaxes:
        net = relaxed(net, near)
    return replace(net_with(acting, net), effects=acting, guided=start.guides is not None)


def _march_sliding(
    mesh: Mesh, start: seeds.Seed, extent: Extent, pitch: float, fabric: Fabric, guides: Guides | None
) -> Grid:
    """March; where yarns slip, again with the lengths that the cells beside it give to the weft generator."""
    grid = _march(mesh, start, extent, pitch, fabric, 0.0, guides)
    if fabric.slip != 0.0:
        for _ in range(AXIS_ROUNDS):
            strain, off = _asked_on_axis(grid, extent, fabric)
            if off < AXIS_STRAIN:
                break
            grid = _march(mesh, start, extent, pitch, fabric, strain, guides)
    return grid


def _asked_on_axis(grid: Grid, extent: Extent, fabric: Fabric) -> tuple[np.ndarray, float]:
    """Strains (nv,) of the weft generator that the cells beside it ask for, and how far it is off them at most."""
    strain = strain_on_axis(grid, extent.west, fabric.slip)
    return strain, float(np.abs(strain - grid.node[extent.west, :, STRAIN]).max())


def _unsettled(grid: Grid, extent: Extent, fabric: Fabric) -> tuple[str, ...]:
    """A warning where weft sides grow with the shear, and the shear with them, without an end."""
    if fabric.slip == 0.0 or not (off := _asked_on_axis(grid, extent, fabric)[1]) > UNSETTLED:
        return ()
    return (
        f"slip of {fabric.slip:g}: weft sides at the origin and the shear beside them do not settle (they still "
        f"change by {100.0 * off:.2g} % of their length): the net is one of many; use less slip, or another heading",
    )


def _march(
    mesh: Mesh,
    start: seeds.Seed,
    extent: Extent,
    pitch: float,
    fabric: Fabric,
    axis: np.ndarray | float,
    guides: Guides | None,
) -> Grid:
    """Seed, generators (α-nodes), cells (β-nodes), front carried on; ``axis``: strains of the weft generator."""
    grid = empty_grid(*sides(extent, pitch, fabric), start.point, APART)
    i0, j0 = extent.west, extent.south
    grid.node[i0, :, STRAIN] = axis
    weft_rad = math.radians(fabric.weft_angle)
    place_seed(mesh, grid, i0, j0, start.face, *_seed_in_frame(mesh, start), weft_rad)
    turns = generator_turns(mesh, grid, i0, j0, start, fabric, guides)
    lay_generators(mesh, grid, i0, j0, start.starts, start.places, turns)
    branch_off(mesh, grid, i0, j0, weft_rad)
    if fabric.slip == 0.0:
        fill_quadrants(mesh, grid, i0, j0)
    else:
        fill_quadrants_sliding(mesh, grid, i0, j0, fabric.slip)
    carry_front_on(mesh, grid, i0, j0)
    return grid


def _require_cells(grid: Grid, surface: Surface, pitch: float) -> None:
    """Raise DrapeError where the net has no cell to speak of."""
    if grid.box[1] == grid.box[0] or grid.box[3] == grid.box[2]:
        raise DrapeError(
            f"no cell of {pitch:g} mm closes on {surface.source} from this origin and heading: use a smaller pitch, "
            "or move the origin away from the rim and out of corners (--origin x,y,z)"
        )


def _cut_off(surface: Surface, part: Surface) -> tuple[str, ...]:
    """A warning where the cuts part the surface, so that a piece of it is left out."""
    if not surface.cuts or part is surface:
        return ()
    return (
        f"{surface.source} lies in {surface.n_components} pieces with its cuts: the one with the origin is draped, "
        f"{part.area:.6g} mm², and {surface.area - part.area:.6g} mm² are left out: drape them from an origin there",
    )


def unit_hint(surface: Surface) -> tuple[str, ...]:
    """A warning where the part's size looks like another unit."""
    return (surface.findings.unit_hint,) if surface.findings.unit_hint else ()


def _seed_in_frame(mesh: Mesh, start: seeds.Seed) -> tuple[float, float, float, float]:
    """Point and unit warp direction of the seed in the frame of its face."""
    origin, e1, e2 = mesh.frames[start.face].reshape(3, 3)
    away = start.point - origin
    heading_rad = math.atan2(float(start.warp @ e2), float(start.warp @ e1))
    return float(away @ e1), float(away @ e2), math.cos(heading_rad), math.sin(heading_rad)


def _sides_as_they_lie(grid: Grid, fabric: Fabric) -> tuple[np.ndarray, np.ndarray] | None:
    """Lengths of warp pieces (nu - 1, nv) and weft pieces (nu, nv - 1), mm; None where they are the pitch."""
    if not fabric.stretches:
        return None
    i0, i1, j0, j1 = (int(k) for k in grid.box[:4])
    warp = np.broadcast_to(grid.sides_u[i0:i1, None], (i1 - i0, j1 - j0 + 1)).copy()
    return warp, grid.sides_v[None, j0:j1] * (1.0 + grid.node[i0 : i1 + 1, j0:j1, STRAIN])


def _as_net(start: Start, reach: tuple[float, float] | None, extent: Extent, grid: Grid) -> Net:
    """Cut the grid to the nodes that are there and turn it into a Net."""
    part, seed, pitch = start.part, start.seed, start.pitch
    i0, i1, j0, j1 = (int(k) for k in grid.box[:4])
    near = np.s_[i0 : i1 + 1, j0 : j1 + 1]
    face = grid.face[near] - 1
    lattice = all_in_space(start.mesh, grid, i0, i1 + 1, j0, j1 + 1)
    lattice_valid = _whole_cells(grid.marks[near][..., PIECES])
    status = extent.status_around(grid)
    over_hole = face >= len(part.triangles)
    points, valid = lattice, lattice_valid
    if over_hole.any():
        status[1:-1, 1:-1][over_hole] = Status.IN_HOLE
        points = np.where(over_hole[..., None], np.nan, lattice)
        face = np.where(over_hole, -1, face)
        valid = lattice_valid & np.isfinite(cells_of(points[..., 0])).all(axis=0)
    cell_shear, shear = shears(grid, i0, j0, valid)
    return Net(
        surface=part,
        fabric=start.fabric,
        origin=seed.point,
        origin_face=seed.face,
        warp0=seed.warp,
        weft0=seed.weft,
        normal0=seed.normal,
        angle=start.angle,
        pitch=pitch,
        reach=reach,
        u=(np.arange(i0, i1 + 1) - extent.west) * pitch,
        v=(np.arange(j0, j1 + 1) - extent.south) * pitch,
        points=points,
        face=face,
        status_around=status,
        cell_valid=valid,
        lattice=lattice,
        lattice_valid=lattice_valid,
        yarns=yarn_directions(start.mesh, grid, i0, i1 + 1, j0, j1 + 1),
        cell_shear=cell_shear,
        shear=shear,
        sides=_sides_as_they_lie(grid, start.fabric),
        notes=(*start.notes, *_left_out(start)),
        warnings=_warnings(start, extent, grid),
    )


def _whole_cells(pieces: np.ndarray) -> np.ndarray:
    """Which cells (nu - 1, nv - 1) have four sides; ``pieces`` (nu, nv) as in the grid."""
    warp, weft = (pieces & 1) != 0, (pieces & 2) != 0
    return np.asarray(warp[:-1, :-1] & warp[:-1, 1:] & weft[:-1, :-1] & weft[1:, :-1])


def _left_out(start: Start) -> tuple[str, ...]:
    """A note where of several pieces one is draped."""
    if start.part is start.surface:
        return ()
    return (f"the part has {start.surface.n_components} separate pieces; the one with the origin is draped",)


def _warnings(start: Start, extent: Extent, grid: Grid) -> tuple[str, ...]:
    """What the user should look at."""
    return (
        *unit_hint(start.surface),
        *_cut_off(start.surface, start.part),
        *coarse_facets(start.part, start.pitch),
        *_unsettled(grid, extent, start.fabric),
    )
