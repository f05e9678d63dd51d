"""A bracket as from a CAD system: base, two walls with fillets, lip, raised pad, hole and slot."""

from __future__ import annotations

import numpy as np

from geomdrap.errors import SurfaceError
from geomdrap.surface.shape_mesh import (
    Mesh,
    Points,
    Row,
    arc,
    chain,
    fill,
    join,
    line,
    require_positive,
    stitch,
)
from geomdrap.surface.surface import Surface

BACK = 80.0  # y where the base runs into the back fillet
FRONT = -100.0  # y where the base runs into the front fillet, at x = 0
HOLE = (-74.0, -5.0)  # centre of the hole and of the pad about it
PAD_INNER, PAD_OUTER = 38.0, 72.0  # radii between which the pad rises


def bracket(
    length: float = 300.0,
    *,
    front_radius: float = 330.0,
    fillet: float = 18.0,
    front_wall: float = 40.0,
    back_wall: float = 60.0,
    lip: float = 25.0,
    pad: float = 8.0,
    hole: float = 22.0,
    edge: float = 4.5,
) -> Surface:
    """Bracket along x: a base at z = 0, a curved wall in front, a straight one with a lip and a slot behind.

    The front wall stands on an arc of ``front_radius`` in plan, so that its fillet is a part of a torus
    (with length 300 and radius 330 it turns by 54°); it is ``front_wall`` mm high above the fillet in the
    middle and 60 % of that at its ends. The back wall is upright and straight, ``back_wall`` mm high
    between its two fillets, and ends in a lip turned outward, rounded at its corners; it has a slot 60 × 20.
    About the hole, of radius ``hole``, the base rises by ``pad`` mm between 72 and 38 mm from its centre.
    All bends have the radius ``fillet``. Normals up on the base, inward on the walls. The dimensions are
    ours. Raises SurfaceError on bad sizes.
    """
    require_positive(length=length, front_radius=front_radius, fillet=fillet, back_wall=back_wall, lip=lip)
    require_positive(front_wall=front_wall, hole=hole, edge=edge)
    if length / 2.0 > 0.7 * front_radius or length < 2.0 * (PAD_OUTER - HOLE[0]):
        raise SurfaceError(f"length must be from 292 to 1.4 times front_radius, not {length}")
    if hole > PAD_INNER - 8.0 or back_wall < 30.0 or fillet > 40.0:
        raise SurfaceError("a bracket needs a hole radius up to 30, back_wall from 30 and fillet up to 40 mm")
    bend = np.pi / 2.0 * fillet
    half_turn = float(np.degrees(np.arcsin(length / 2.0 / front_radius)))
    front = arc((0.0, FRONT + front_radius), front_radius, 270.0 - half_turn, 270.0 + half_turn, edge)
    top = BACK + 2.0 * bend + back_wall + lip
    outline, middle = _outline(front, length / 2.0, top, edge), BACK + bend + back_wall / 2.0
    round_hole = arc(HOLE, hole, 0.0, 360.0, 0.8 * edge)[:-1]
    flat, triangles = fill(outline, [round_hole, _slot((60.0, middle), 20.0, 10.0, 0.8 * edge)], edge)
    sheet = np.column_stack([flat[:, 0], _folded(flat[:, 1], fillet, back_wall)])
    sheet[:, 2] += pad * _pad_share(flat)
    wall = _front_wall(sheet[: len(front)], np.radians(half_turn), fillet, front_wall, edge)
    return Surface(*join((sheet, triangles), wall), source="bracket")


def _outline(front: Points, half: float, top: float, edge: float) -> Points:
    """Outline (n, 2) in x and the developed length over base, back wall and lip; the front arc first."""
    corner = 12.0
    right = arc((half - corner, top - corner), corner, 0.0, 90.0, edge)
    left = right[::-1] * [-1.0, 1.0]
    sides = [line(a, b, edge) for a, b in ((front[-1], right[0]), (right[-1], left[0]), (left[-1], front[0]))]
    return chain(front, sides[0], right, sides[1], left, sides[2])[:-1]


def _slot(centre: tuple[float, float], half: float, radius: float, edge: float) -> Points:
    """Outline (n, 2) of a slot along x with round ends, ``half`` mm from its middle to their centres."""
    x, y = centre
    right = arc((x + half, y), radius, -90.0, 90.0, edge)
    left = arc((x - half, y), radius, 90.0, 270.0, edge)
    return chain(right, line(right[-1], left[0], edge), left, line(left[-1], right[0], edge))[:-1]


def _folded(s: Points, fillet: float, wall: float) -> Points:
    """y and z (n, 2) at the developed length s (n,): base, fillet up, wall, fillet outward, lip."""
    bend = np.pi / 2.0 * fillet
    up = np.clip((s - BACK) / fillet, 0.0, np.pi / 2.0)
    rise = np.clip(s - BACK - bend, 0.0, wall)
    over = np.clip((s - BACK - bend - wall) / fillet, 0.0, np.pi / 2.0)
    run = np.maximum(s - BACK - 2.0 * bend - wall, 0.0)
    y = np.minimum(s, BACK) + fillet * (np.sin(up) + 1.0 - np.cos(over)) + run
    return np.column_stack([y, fillet * (1.0 - np.cos(up) + np.sin(over)) + rise])


def _pad_share(flat: Points) -> Points:
    """Height of the pad (n,) from 0 to 1, smooth to the second derivative."""
    distance = np.hypot(flat[:, 0] - HOLE[0], flat[:, 1] - HOLE[1])
    t = np.clip((PAD_OUTER - distance) / (PAD_OUTER - PAD_INNER), 0.0, 1.0)
    return t**3 * (10.0 - 15.0 * t + 6.0 * t * t)


def _front_wall(foot: Points, half_turn: float, fillet: float, height: float, edge: float) -> Mesh:
    """Fillet and wall that rise from the front edge of the base, ``foot`` (n, 3) from −x to +x."""
    turn = np.linspace(-half_turn, half_turn, len(foot))
    outward = np.column_stack([np.sin(turn), -np.cos(turn)])
    share = 1.0 - 0.4 * (turn / half_turn) ** 2
    bend = arc((0.0, fillet), fillet, -90.0, 0.0, edge)
    steps = line((fillet, fillet), (fillet, fillet + height), edge)
    rows = [foot]
    for out, up in chain(bend, steps)[1:]:
        z = np.where(up <= fillet, up, fillet + (up - fillet) * share)
        rows.append(np.column_stack([foot[:, :2] + out * outward, foot[:, 2] + z]))
    position = np.linspace(0.0, 1.0, len(foot))
    return stitch([Row(row[::-1], position) for row in rows])
