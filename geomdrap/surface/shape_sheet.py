"""Analytic shapes over a plane: plane, z = f(x, y), saddle, L, extruded profiles, hat stringer."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from geomdrap.errors import SurfaceError
from geomdrap.surface.shape_mesh import Points, arc, chain, grid_triangles, line, require_positive, segments
from geomdrap.surface.surface import Surface


def grid_surface(
    f: Callable[[Points, Points], Points],
    xs: Points,
    ys: Points,
    *,
    keep: Callable[[Points, Points], np.ndarray] | None = None,
    source: str = "grid",
) -> Surface:
    """Return the surface z = f(x, y) over a grid of lines x = xs and y = ys, normals up.

    f: takes x and y, both (ny, nx) mm, and returns z (ny, nx). xs (nx,), ys (ny,): increasing, mm.
    keep: takes the middles of the cells (ny − 1, nx − 1) and says which cells belong to the part.
    Two facets a cell, diagonals alternating. Raises SurfaceError if the lines do not increase.
    """
    xs, ys = np.asarray(xs, float), np.asarray(ys, float)
    if len(xs) < 2 or len(ys) < 2 or not (np.all(np.diff(xs) > 0) and np.all(np.diff(ys) > 0)):
        raise SurfaceError("xs and ys must each hold two or more increasing numbers")
    x, y = np.meshgrid(xs, ys)
    z = np.broadcast_to(np.asarray(f(x, y), float), x.shape)
    points = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    kept = None if keep is None else keep(*np.meshgrid(0.5 * (xs[1:] + xs[:-1]), 0.5 * (ys[1:] + ys[:-1])))
    triangles = grid_triangles(len(ys), len(xs), kept)
    used, triangles = np.unique(triangles, return_inverse=True)
    return Surface(points[used], triangles.reshape(-1, 3), source=source)


def _centred(length: float, edge: float) -> Points:
    """Lines (n,) from −length/2 to length/2 with an even number of steps, so that 0 is one of them."""
    return np.linspace(-length / 2.0, length / 2.0, 2 * segments(length, 2.0 * edge) + 1)


def plane(width: float = 300.0, height: float = 200.0, edge: float = 10.0) -> Surface:
    """Rectangle z = 0, |x| ≤ width/2, |y| ≤ height/2; normals up. Raises SurfaceError on bad sizes."""
    require_positive(width=width, height=height, edge=edge)
    return grid_surface(lambda x, y: 0.0 * x, _centred(width, edge), _centred(height, edge), source="plane")


def saddle(radius: float = 300.0, size: float = 300.0, edge: float = 5.0, *, ruled: bool = False) -> Surface:
    """Hyperbolic paraboloid z = (x² − y²)/(2·radius), or with ``ruled`` z = x·y/radius; normals up.

    Over the square |x|, |y| ≤ size/2. Principal curvatures in the middle ±1/radius. A ruled saddle holds
    the straight lines x = const and y = const, so that yarns through the middle along x and y stay
    straight. K = −1/(radius²·(1 + (x² + y²)/radius²)²) for both. Raises SurfaceError on bad sizes.
    """
    require_positive(radius=radius, size=size, edge=edge)
    lines = _centred(size, edge)
    if ruled:
        return grid_surface(lambda x, y: x * y / radius, lines, lines, source="saddle")
    return grid_surface(lambda x, y: (x * x - y * y) / (2.0 * radius), lines, lines, source="saddle")


def l_shape(size: float = 400.0, arm: float = 160.0, radius: float = 800.0, edge: float = 7.0) -> Surface:
    """L in plan on the paraboloid z = −(x² + y²)/(2·radius): a crowned panel with a re-entrant corner.

    The plan is the square |x|, |y| ≤ size/2 without its quarter at +x, +y, so that both arms are ``arm``
    wide. radius = inf gives a flat L. Normals up. Raises SurfaceError on bad sizes.
    """
    require_positive(size=size, arm=arm, edge=edge, **({} if radius == np.inf else {"radius": radius}))
    if arm >= size:
        raise SurfaceError(f"arm must be shorter than size, not {arm} of {size}")
    corner = arm - size / 2.0
    near = np.linspace(-size / 2.0, corner, segments(arm, edge) + 1)
    lines = np.append(near[:-1], np.linspace(corner, size / 2.0, segments(size - arm, edge) + 1))
    return grid_surface(
        lambda x, y: -(x * x + y * y) / (2.0 * radius),
        lines,
        lines,
        keep=lambda x, y: (x < corner) | (y < corner),
        source="l-shape",
    )


def extrude(
    profile: Points, length: float = 300.0, edge: float = 5.0, *, source: str = "extrusion"
) -> Surface:
    """Return the developable surface of a profile moved along x, |x| ≤ length/2.

    profile: (k, 2) rows of y and z [mm]; normals up where it runs toward +y. Each of its segments is one
    row of facets. Raises SurfaceError on bad sizes.
    """
    require_positive(length=length, edge=edge)
    x = _centred(length, edge)
    points = np.empty((len(profile), len(x), 3))
    points[..., 0] = x
    points[..., 1:] = np.asarray(profile, float)[:, None, :]
    return Surface(points.reshape(-1, 3), grid_triangles(len(profile), len(x)), source=source)


def hat_stringer(
    length: float = 400.0,
    *,
    crown: float = 40.0,
    height: float = 45.0,
    flange: float = 40.0,
    wall: float = 75.0,
    fillet: float = 8.0,
    edge: float = 4.0,
) -> Surface:
    """Straight hat section along x: two flanges at z = 0, two walls at ``wall`` degrees, a flat crown.

    crown, flange: widths [mm] of the flat strips; height of the crown [mm]; all bends have the radius
    ``fillet``. wall may pass 90 (undercut). Developable: no shear at any heading. Normals up.
    Raises SurfaceError on bad sizes.
    """
    require_positive(length=length, crown=crown, height=height, flange=flange, fillet=fillet, edge=edge)
    turn = np.radians(wall)
    straight = (height - 2.0 * fillet * (1.0 - np.cos(turn))) / np.sin(turn) if 0.0 < wall < 150.0 else -1.0
    if straight <= 0.0:
        raise SurfaceError("the hat has no room for its walls: take a smaller fillet, or wall from 30 to 110")
    top = np.array([crown / 2.0, height])
    bend = arc(top - [0.0, fillet], fillet, 90.0, 90.0 - wall, edge)
    foot = bend[-1] + straight * np.array([np.cos(turn), -np.sin(turn)])
    centre = foot + fillet * np.array([np.sin(turn), np.cos(turn)])
    toe = arc(centre, fillet, 270.0 - wall, 270.0, edge)
    side, last = line(bend[-1], foot, edge), line(toe[-1], toe[-1] + [flange, 0.0], edge)
    right = chain(line((0.0, height), top, edge), bend, side, toe, last)
    right[:, 1] -= right[-1, 1]
    left = right[::-1] * [-1.0, 1.0]
    return extrude(chain(left, right), length, edge, source="hat stringer")
