"""The first step of a drape: where on which surface the ply begins, and how it heads there."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from geomdrap.errors import DrapeError, SurfaceError
from geomdrap.fishnet import seed as seeds
from geomdrap.fishnet.centroid import said
from geomdrap.fishnet.effect import Effect, fabric_with, shift_with, surface_with
from geomdrap.fishnet.fabric import Fabric
from geomdrap.fishnet.pitch import check_pitch, choose_pitch
from geomdrap.fishnet.shift import Shift, displaced
from geomdrap.fishnet.steer import Guides
from geomdrap.geodesic.mesh import Mesh, mesh_of

if TYPE_CHECKING:
    from collections.abc import Sequence

    from geomdrap.surface import Surface

    Curve = Sequence[Sequence[float]] | np.ndarray

FAR = 1e5  # part's diagonals from the origin: beyond, rounding reaches what ``TIE`` tells apart
MOST_HEADING = 1e6  # degrees: more is a slip of the pen, and leaves few digits of the direction
SPREAD = 2.0  # cells: the facets' curvature is spread no further, which is below what the net resolves


class Start(NamedTuple):
    """A ply at its seed: the ``surface`` with the effects that act on it, its ``part`` that is draped, and so on."""

    surface: Surface
    part: Surface
    mesh: Mesh
    seed: seeds.Seed
    angle: float
    pitch: float
    fabric: Fabric
    guides: Guides | None
    notes: tuple[str, ...]


def laid_down(
    surface: Surface,
    origin: seeds.Origin,
    angle: float,
    pitch: float | None,
    fabric: Fabric,
    acting: Sequence[Effect],
    reference: Sequence[float] | None,
    project: bool,
    guides: tuple[Curve | None, Curve | None] = (None, None),
) -> Start:
    """The ply at its seed, under effects in the order in which they act; other parameters as of ``drape``.

    Raises SurfaceError where the part cannot be draped, DrapeError for an impossible seed, heading or pitch.
    """
    fabric = fabric_with(acting, fabric)
    if not abs(angle) <= MOST_HEADING:
        raise DrapeError(f"the heading must be a number of degrees up to {MOST_HEADING:,.0f}, not {angle:g}")
    tool, (face, point, distance) = surface, seeds.locate(surface, origin)
    meant, surface = point, surface_with(acting, tool)
    if surface is not tool:
        face, point, _ = seeds.locate(surface, point)
    part = surface.only_component(face)
    part.require_drapable()
    _require_digits(part)
    pitch, notes = (check_pitch(part, pitch), ()) if pitch is not None else choose_pitch(part)
    _check_distance(tool, origin, distance, pitch, project)
    mesh = mesh_of(part.lidded, SPREAD * pitch)
    point, moved = seeds.out_of_corner(part, origin, point, mesh, pitch)
    where = said(tool, meant, pitch) if isinstance(origin, str) and origin == "centroid" else ()
    notes = (*notes, *where, *moved, *_cuts(tool))
    along = Guides.laid(part, *guides, pitch, project)
    shift = shift_with(acting, Shift())
    if along:
        along.require_alone(fabric, shift)
        seed, angle, fabric = along.plant(part, point, mesh, reference, fabric, pitch)
        notes = (*notes, along.note)
    else:
        seed = _plant(part, point, math.fmod(angle, 360.0), mesh, reference, fabric, shift)
        notes = (*notes, *_elsewhere(shift, angle))
    return Start(surface, part, mesh, seed, float(angle), float(pitch), fabric, along, notes)


def _plant(
    part: Surface,
    point: np.ndarray,
    heading: float,
    mesh: Mesh,
    reference: Sequence[float] | None,
    fabric: Fabric,
    shift: Shift,
) -> seeds.Seed:
    """The seed at a point with the warp at a heading (degrees), or where it was really laid down."""

    def plant(turn: float) -> seeds.Seed:
        return seeds.plant(part, point, heading + turn, mesh, reference, fabric.weft_angle)

    meant = plant(0.0)
    return meant if shift == Shift() else displaced(shift, meant, plant, mesh, len(part.triangles))


def _elsewhere(shift: Shift, angle: float) -> tuple[str, ...]:
    """A note on a ply that is not laid as asked: its heading (degrees) is not the one that is printed."""
    if shift == Shift():
        return ()
    turn, away = f"turned by {shift.dangle:+.3g}° from {angle:g}°", math.hypot(shift.du, shift.dv)
    return (f"placement: the ply lies {away:.3g} mm from the origin asked for, and {turn}",)


def _cuts(surface: Surface) -> tuple[str, ...]:
    """A note on the lines that the part is cut along."""
    names = ", ".join(dict.fromkeys(surface.cuts))
    return (f"the part is cut along {names}: {surface.cut_length:.4g} mm",) if names else ()


def _require_digits(surface: Surface) -> None:
    """Raise SurfaceError for a part so far from the origin that its coordinates have too few digits left."""
    away = float(np.abs(surface.bounds).max())
    if away > FAR * surface.diagonal:
        raise SurfaceError(
            f"{surface.source} lies {away:.3g} mm from the origin, too far for a size of {surface.diagonal:.6g} mm: "
            "its coordinates have too few digits; move it closer to the origin"
        )


def _check_distance(surface: Surface, origin: seeds.Origin, distance: float, pitch: float, project: bool) -> None:
    """The centroid is projected by definition; a point further off than a pitch is more likely a mistake."""
    if isinstance(origin, str) and origin == "centroid":
        return
    if distance > pitch and not project:
        raise DrapeError(
            f"the origin lies {distance:.6g} mm from {surface.source}, more than the pitch of {pitch:.6g} mm; "
            "move it, or allow the nearest point with --project (project=True)"
        )
