"""Analytic shapes that turn about an axis: tube, cone, sphere, cap, torus, hemisphere on a flange."""

from __future__ import annotations

import numpy as np

from geomdrap.errors import SurfaceError
from geomdrap.surface.quarter import quartered
from geomdrap.surface.shape_mesh import (
    ROW_STEP,
    Mesh,
    Points,
    Row,
    arc,
    chain,
    grid_triangles,
    line,
    require_positive,
    ring,
    segments,
    stitch,
)
from geomdrap.surface.surface import Surface

FULL_TURN = 360.0


def revolve(profile: Points, edge: float, angle: float = FULL_TURN) -> Mesh:
    """Mesh the surface that a profile sweeps when it turns about the z axis.

    profile: (k, 2) rows of r ≥ 0 and z [mm]; a point with r = 0 at either end becomes one vertex (a pole).
    angle: degrees swept, from −angle/2 to angle/2 about +x; 360 closes without a seam.
    Rings get as many vertices as edges of length ``edge`` fit. Facets are counter-clockwise seen from the
    left of the profile as it runs: outward where it runs from the top pole outward and down.
    """
    rows: list[Row] = []
    count, offset = 0, 0.0
    for r, z in profile:
        if r == 0.0:
            rows.append(Row(np.array([[0.0, 0.0, z]]), np.zeros(1)))
            continue
        before, count = count, segments(np.radians(angle) * r, edge, 5 if angle == FULL_TURN else 1)
        offset = (offset + 0.5) % 1.0 if count == before else offset  # equal rings: half a step on
        rows.append(_circle(float(r), float(z), count, offset, angle))
    return stitch(rows)


def _circle(r: float, z: float, count: int, offset: float, angle: float) -> Row:
    """A ring or an arc, run clockwise: the rows go down the profile, and facets must look outward."""
    closed = angle == FULL_TURN
    position = (np.arange(count) + offset) / count if closed else np.linspace(0.0, 1.0, count + 1)
    turn = np.radians(angle) * (-position if closed else 0.5 - position)
    points = np.stack([r * np.cos(turn), r * np.sin(turn), np.full(len(turn), z)], axis=1)
    return Row(points, position, closed)


def cylinder(
    radius: float = 100.0, length: float = 300.0, edge: float = 5.0, angle: float = FULL_TURN
) -> Surface:
    """Cylinder y² + z² = radius², |x| ≤ length/2; developable, so every drape has zero shear.

    angle: degrees about the top line (y = 0, z = radius); 360 gives a tube, closed without a seam, open at
    both ends. Normals point outward. All vertices lie on the cylinder. Raises SurfaceError on bad sizes.
    """
    require_positive(radius=radius, length=length, edge=edge)
    if not 0.0 < angle <= FULL_TURN:
        raise SurfaceError(f"angle must be above 0 and at most 360 degrees, not {angle}")
    around = segments(np.radians(angle) * radius, edge, 3)
    if angle == FULL_TURN:
        rows = segments(length, edge * np.sqrt(0.75)) + 1
        levels = np.linspace(-length / 2.0, length / 2.0, rows)
        circles = [_tube_ring(radius, x, around, 0.5 * (k % 2)) for k, x in enumerate(levels)]
        return Surface(*stitch(circles), source="cylinder")
    x = np.linspace(-length / 2.0, length / 2.0, segments(length, edge) + 1)
    turn = np.radians(angle) * np.linspace(-0.5, 0.5, around + 1)
    xs, turns = np.meshgrid(x, turn)
    points = np.stack([xs, radius * np.sin(turns), radius * np.cos(turns)], axis=-1).reshape(-1, 3)
    return Surface(points, grid_triangles(*xs.shape), source="cylinder")


def _tube_ring(radius: float, x: float, count: int, offset: float) -> Row:
    turn = 2.0 * np.pi * (np.arange(count) + offset) / count
    return ring(np.stack([np.full(count, x), radius * np.cos(turn), radius * np.sin(turn)], axis=1), offset)


def cone(slope: float = 0.5, radius: float = 150.0, edge: float = 5.0, sectors: int | None = None) -> Surface:
    """Cone z = −slope·r for r ≤ radius, the apex one vertex at the origin, normals up.

    Developable but for the apex, which has the angle deficit 360°·(1 − cos(atan slope)). Ring i has
    ``sectors``·i vertices; the deficit inside it is that of a pyramid with as many sides, so that more
    sectors bring the apex closer to the exact cone, with thinner facets. By default facets are near
    equilateral. Raises SurfaceError on bad sizes.
    """
    require_positive(slope=slope, radius=radius, edge=edge)
    cosine = 1.0 / np.hypot(1.0, slope)
    sectors = max(3, round(6.0 * cosine)) if sectors is None else sectors
    if sectors < 3:
        raise SurfaceError(f"sectors must be 3 or more, not {sectors}")
    count = segments(radius / cosine, edge * ROW_STEP)
    rows = [Row(np.zeros((1, 3)), np.zeros(1))]
    for i in range(1, count + 1):
        r = radius * i / count
        rows.append(_circle(r, -slope * r, sectors * i, 0.0, FULL_TURN))
    return Surface(*stitch(rows), source="cone")


def icosphere(radius: float = 100.0, subdivisions: int = 4) -> Surface:
    """Sphere about the origin from an icosahedron split ``subdivisions`` times: 20·4^s facets, outward.

    Every vertex is on the sphere. No pole and no seam. Raises SurfaceError on bad sizes.
    """
    require_positive(radius=radius)
    if not 0 <= subdivisions <= 10:
        raise SurfaceError(f"subdivisions must be 0 to 10, not {subdivisions}")
    points, triangles = _icosahedron()
    for _ in range(subdivisions):
        points, triangles = _split(points, triangles)
    return Surface(radius * points, triangles, source="icosphere")


def _icosahedron() -> Mesh:
    """Icosahedron (12 points, 20 facets) with a vertex at each pole, on the unit sphere."""
    height, turn = 1.0 / np.sqrt(5.0), np.radians(36.0) * np.arange(10)
    width = 2.0 / np.sqrt(5.0)
    z = np.where(np.arange(10) % 2 == 0, height, -height)
    belt = np.stack([width * np.cos(turn), width * np.sin(turn), z], axis=1)
    points = np.concatenate([[[0.0, 0.0, 1.0]], belt, [[0.0, 0.0, -1.0]]])
    i = np.arange(10)
    a, b, c = 1 + i, 1 + (i + 1) % 10, 1 + (i + 2) % 10
    even = (i % 2 == 0)[:, None]
    poles = np.where(even, np.stack([0 * i, a, c], 1), np.stack([0 * i + 11, c, a], 1))
    sides = np.where(even, np.stack([a, b, c], 1), np.stack([a, c, b], 1))
    return points, np.concatenate([poles, sides])


def _split(points: Points, triangles: np.ndarray) -> Mesh:
    """Each triangle into four, the new vertices pushed out to the unit sphere."""
    edges, _, split = quartered(triangles, len(points))
    middle = points[edges].sum(axis=1)
    middle /= np.linalg.norm(middle, axis=1, keepdims=True)
    return np.concatenate([points, middle]), split


def sphere_cap(radius: float = 100.0, opening: float = 60.0, edge: float = 5.0) -> Surface:
    """Part of the sphere x² + y² + z² = radius² within ``opening`` degrees of +z (below 180), outward.

    Raises SurfaceError on bad sizes.
    """
    require_positive(radius=radius, opening=opening, edge=edge)
    if opening >= 180.0:
        raise SurfaceError(f"opening must be below 180, not {opening}; a whole sphere is an icosphere")
    return Surface(*revolve(_from_pole(radius, 0.0, opening, edge), edge), source="sphere cap")


def _from_pole(radius: float, centre: float, opening: float, edge: float) -> Points:
    """Profile (k, 2) of a sphere from its top pole, exactly on the axis, to ``opening`` degrees away."""
    profile = arc((0.0, centre), radius, 90.0, 90.0 - opening, edge * ROW_STEP)
    profile[0] = 0.0, centre + radius
    return profile


def hemisphere(radius: float = 100.0, edge: float = 5.0) -> Surface:
    """Half sphere z = sqrt(radius² − x² − y²) ≥ 0, outward: at the rim it stands upright."""
    return Surface(*revolve(_from_pole(radius, 0.0, 90.0, edge), edge), source="hemisphere")


def hemisphere_on_flange(
    radius: float = 75.0, fillet: float = 10.0, flange: float = 60.0, edge: float = 4.0
) -> Surface:
    """Hemisphere that a fillet joins to a flat round flange at z = 0; normals up and outward.

    The sphere's centre is at height ``fillet``, so that its upright rim runs tangentially into the fillet
    (a quarter of a torus), and that into the flange, ``flange`` mm wide. Raises SurfaceError on bad sizes.
    """
    require_positive(radius=radius, fillet=fillet, flange=flange, edge=edge)
    step = edge * ROW_STEP
    foot = radius + fillet
    profile = chain(
        _from_pole(radius, fillet, 90.0, edge),
        arc((foot, fillet), fillet, 180.0, 270.0, step),
        line((foot, 0.0), (foot + flange, 0.0), step),
    )
    return Surface(*revolve(profile, edge), source="hemisphere on a flange")


def torus(
    ring_radius: float = 150.0,
    tube_radius: float = 50.0,
    edge: float = 5.0,
    *,
    angle: float = FULL_TURN,
    start: float = 180.0,
    end: float = 0.0,
) -> Surface:
    """Part of the torus (sqrt(x² + y²) − ring_radius)² + z² = tube_radius²; outward.

    angle: degrees about z, centred on +x. start, end: degrees about the tube from the inner (180) over the
    top (90) to the outer side (0), start above end by less than 360. Positively curved outside, negatively
    inside: K = cos t / (tube_radius·(ring_radius + tube_radius·cos t)). Raises SurfaceError on bad sizes.
    """
    require_positive(ring_radius=ring_radius, tube_radius=tube_radius, edge=edge, angle=angle)
    if tube_radius >= ring_radius or angle > FULL_TURN or not 0.0 < start - end < FULL_TURN:
        raise SurfaceError("a torus needs tube_radius < ring_radius, angle ≤ 360 and 0 < start − end < 360")
    profile = arc((ring_radius, 0.0), tube_radius, start, end, edge * np.sqrt(0.75))
    return Surface(*revolve(profile, edge, angle), source="torus")
