"""Panels such as are really made: double dome and car hood. Parametric, but not read from drawings."""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from geomdrap.errors import SurfaceError
from geomdrap.surface.shape_mesh import (
    Points,
    Row,
    arc,
    chain,
    fill,
    join,
    line,
    require_positive,
    segments,
    stitch,
)
from geomdrap.surface.surface import Surface


def double_dome(
    length: float = 470.0,
    width: float = 270.0,
    *,
    dome: float = 75.0,
    spacing: float = 140.0,
    wall: float = 75.0,
    fillet: float = 15.0,
    waist: float = 0.22,
    dip: float = 0.12,
    edge: float = 5.0,
) -> Surface:
    """Two domes joined by a ridge with a waist, on a flat rectangular flange at z = 0; normals up.

    In the manner of the double dome of the woven-fabric forming benchmark (J. Cao and others, M. A. Khan and
    others): symmetric about x and y, for a blank of 470 × 270 mm. We had no drawing of it: the radii and
    heights here are approximate, and results are not to be compared with those published for it.
    Each end is a sphere of radius ``dome``, their centres ``spacing`` apart on x, down to a wall of
    ``wall`` degrees that a fillet joins to the flange. Between them the same profile runs straight, its
    width reduced by up to the share ``waist`` and its height by up to ``dip`` with cos²(πx/spacing).
    Raises SurfaceError on bad sizes.
    """
    require_positive(length=length, width=width, dome=dome, spacing=spacing, fillet=fillet, edge=edge)
    reach = (dome + fillet) * np.sin(np.radians(wall))
    if not 10.0 <= wall <= 85.0 or not (0.0 <= waist < 0.6 and 0.0 <= dip < 0.6):
        raise SurfaceError("a double dome needs a wall of 10 to 85 degrees, and waist and dip from 0 to 0.6")
    if spacing / 2.0 + reach + edge > length / 2.0 or reach + edge > width / 2.0:
        raise SurfaceError("the flange of the double dome is too small: take a larger length or width")
    profile = chain(
        arc((0.0, 0.0), dome, 90.0, 90.0 - wall, edge),
        arc(
            (dome + fillet) * np.array([np.sin(np.radians(wall)), np.cos(np.radians(wall))]),
            fillet,
            270.0 - wall,
            270.0,
            edge,
        ),
    )
    profile -= [0.0, profile[-1, 1]]
    profile[0, 0], profile[-1, 1] = 0.0, 0.0
    rows = [_stadium(rho, z, spacing / 2.0, edge, waist=waist, dip=dip) for rho, z in profile]
    rim = rows[-1].points[:, :2]
    corners = np.array([[-1, -1], [1, -1], [1, 1], [-1, 1], [-1, -1]]) * [length / 2.0, width / 2.0]
    outline = chain(*(line(a, b, edge) for a, b in pairwise(corners)))[:-1]
    flat, triangles = fill(outline, [rim], edge)
    return Surface(*join(stitch(rows), (_lifted(flat, 0.0 * flat[:, 0]), triangles)), source="double dome")


def _lifted(plan: Points, z: Points) -> Points:
    return np.column_stack([plan, z])


def _stadium(rho: float, z: float, half: float, edge: float, *, waist: float, dip: float) -> Row:
    """A closed row round the double dome, clockwise from above, at the distance ``rho`` from its ridge.

    Positions count the two round ends and the two straight sides as a quarter each, so that the ridge
    itself (rho = 0, up one side and down the other) fits the rows about it.
    """
    bend = segments(np.pi * rho, edge, 1)
    along = 2 * segments(half, edge)  # the same on every row, with a vertex at the waist
    arc_turn = np.linspace(0.5, -0.5, bend + 1)
    side = (2.0 * np.arange(1, along) - along) / along  # exactly symmetric: the ridge meets itself
    x = np.concatenate([half + rho * np.cos(np.pi * arc_turn), -half * side])
    y = np.concatenate([rho * np.sin(np.pi * arc_turn), np.full(len(side), -rho)])
    t = np.concatenate([0.25 * (0.5 - arc_turn), 0.25 + 0.125 * (1.0 + side)])
    fade = np.cos(np.pi * np.clip(x / (2.0 * half), -0.5, 0.5)) ** 2
    points = np.stack([x, y * (1.0 - waist * fade), z * (1.0 - dip * fade)], axis=1)
    opposite = points * [-1.0, -1.0, 1.0]
    return Row(np.concatenate([points, opposite]), np.concatenate([t, 0.5 + t]), closed=True)


def car_hood(
    length: float = 950.0,
    front: float = 900.0,
    rear: float = 1300.0,
    *,
    corner: float = 150.0,
    bend: float = 45.0,
    turn: float = 80.0,
    hem: float = 25.0,
    line_height: float = 12.0,
    bulge: float = 45.0,
    edge: float = 15.0,
) -> Surface:
    """Car-hood-like panel: crowned, two character lines, a power bulge, edges turned down.

    Plan: trapezium, ``front`` wide at x = −length/2 and ``rear`` wide at x = length/2, corners rounded with
    the radius ``corner``. Skin: z = −x²/(2·5500) − y²/(2·2600), less n²/(2·600) where n > 0 is the distance
    forward of x = −length/2 + 220 (the nose), plus line_height·S(c − y)·S(c + y), where
    S(t) = (1 + tanh(t/40))/2 and c = 0.29·rear + 0.18·x (two lines that draw together toward the front), plus
    bulge·exp(−((x + 200)/140)²/2 − (y/110)²/2).
    All round, a bend of the radius ``bend`` turns the edge down by ``turn`` degrees, then runs straight for
    ``hem`` mm. Normals up. The dimensions are ours, of the size of a real hood.
    Raises SurfaceError on bad sizes.
    """
    require_positive(length=length, front=front, rear=rear, corner=corner, bend=bend, turn=turn, edge=edge)
    if turn >= 120.0 or corner > 0.3 * min(length, front, rear) or hem < 0.0:
        raise SurfaceError("a car hood needs turn < 120 degrees, corner ≤ 0.3 of the sides and hem ≥ 0")
    corners = 0.5 * np.array([[-length, -front], [length, -rear], [length, rear], [-length, front]])
    outline = _rounded(corners, corner, edge)
    plan, triangles = fill(outline, [], edge)
    skin = _lifted(plan, _hood_height(plan, length, rear, line_height, bulge))
    rim = skin[: len(outline)]
    slope = np.array([_hood_height(outline + d, length, rear, line_height, bulge) for d in 1e-3 * np.eye(2)])
    slope -= np.array([_hood_height(outline - d, length, rear, line_height, bulge) for d in 1e-3 * np.eye(2)])
    normal = _unit(np.column_stack([-slope.T / 2e-3, np.ones(len(outline))]))
    along = np.roll(rim, -1, axis=0) - np.roll(rim, 1, axis=0)
    outward = _unit(np.cross(along, normal))
    path = arc((0.0, -bend), bend, 90.0, 90.0 - turn, 0.75 * edge)
    if hem > 0.0:
        run = hem * np.array([np.cos(np.radians(turn)), -np.sin(np.radians(turn))])
        path = chain(path, line(path[-1], path[-1] + run, 0.9 * edge))
    position = np.arange(len(rim)) / len(rim)
    rows = [Row(rim[::-1], position, closed=True)]
    rows += [Row((rim + out * outward + up * normal)[::-1], position, closed=True) for out, up in path[1:]]
    return Surface(*join((skin, triangles), stitch(rows)), source="car hood")


def _hood_height(plan: Points, length: float, rear: float, line_height: float, bulge: float) -> Points:
    x, y = plan.T
    nose = np.maximum(0.0, 220.0 - length / 2.0 - x)
    c = 0.29 * rear + 0.18 * x
    middle = 0.25 * (1.0 + np.tanh((c - y) / 40.0)) * (1.0 + np.tanh((c + y) / 40.0))
    hump = np.exp(-0.5 * ((x + 200.0) / 140.0) ** 2 - 0.5 * (y / 110.0) ** 2)
    return -x * x / 11000.0 - y * y / 5200.0 - nose * nose / 1200.0 + line_height * middle + bulge * hump


def _unit(vectors: Points) -> Points:
    return vectors / np.linalg.norm(vectors, axis=1, keepdims=True)


def _rounded(corners: Points, radius: float, edge: float) -> Points:
    """Outline (n, 2) of a convex polygon, given counter-clockwise, with its corners rounded."""
    bends = []
    for before, here, after in zip(np.roll(corners, 1, 0), corners, np.roll(corners, -1, 0), strict=True):
        (ux, uy), (vx, vy) = _unit(np.array([here - before, after - here]))
        sweep = float(np.degrees(np.arctan2(ux * vy - uy * vx, ux * vx + uy * vy)))
        start = float(np.degrees(np.arctan2(-ux, uy)))
        trim = radius * np.tan(np.radians(sweep / 2.0))
        centre = here + np.array([-trim * ux - radius * uy, -trim * uy + radius * ux])
        bends.append(arc(centre, radius, start, start + sweep, edge))
    sides = [line(bend[-1], bends[(k + 1) % len(bends)][0], edge) for k, bend in enumerate(bends)]
    return np.concatenate([chain(bend, side)[:-1] for bend, side in zip(bends, sides, strict=True)])
