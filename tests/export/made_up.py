"""Made-up drapes for the tests of pictures and drawings: a bump on a plate, with the contract's names only.

Nothing here is draped: shear, coverage and pattern are formulas, so that each test knows what must appear.
"""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np


def made_up_surface(points, triangles, source="bump.stl"):
    points, triangles = np.asarray(points, dtype=float), np.asarray(triangles, dtype=np.int32)
    a, b, c = (points[triangles[:, k]] for k in range(3))
    cross = np.cross(b - a, c - a)
    areas = 0.5 * np.linalg.norm(cross, axis=1)
    normals = cross / (2 * areas)[:, None]
    vertex_normals = np.zeros_like(points)
    np.add.at(vertex_normals, triangles.ravel(), np.repeat(cross, 3, axis=0))
    vertex_normals /= np.linalg.norm(vertex_normals, axis=1, keepdims=True)
    bounds = np.array([points.min(axis=0), points.max(axis=0)])
    return SimpleNamespace(
        points=points,
        triangles=triangles,
        source=source,
        areas=areas,
        area=float(areas.sum()),
        normals=normals,
        vertex_normals=vertex_normals,
        bounds=bounds,
        diagonal=float(np.linalg.norm(bounds[1] - bounds[0])),
        neighbours=neighbours_of(triangles),
    )


def neighbours_of(triangles):
    found, neighbours = {}, np.full((len(triangles), 3), -1, dtype=np.int32)
    for f, corners in enumerate(triangles):
        for k in range(3):
            a, b = int(corners[k]), int(corners[(k + 1) % 3])
            if (b, a) in found:
                g, m = found[b, a]
                neighbours[f, k], neighbours[g, m] = g, f
            found[a, b] = (f, k)
    return neighbours


def grid(nx, ny):
    """Triangles of an (nx, ny) grid of vertices, numbered i * ny + j, normals to +z."""
    i, j = np.meshgrid(np.arange(nx - 1), np.arange(ny - 1), indexing="ij")
    a = (i * ny + j).ravel()
    return np.vstack([np.stack([a, a + ny, a + ny + 1], axis=1), np.stack([a, a + ny + 1, a + 1], axis=1)])


def bump(x, y, width, height, rise):
    return rise * np.exp(-(((x / width) ** 2 + (y / height) ** 2) * 14)) + 0 * x


def made_up_drape(
    *,
    width=200.0,
    height=140.0,
    rise=40.0,
    n=60,
    most=55.0,
    coverage=1.0,
    pitch=None,
    warnings=(),
    bare=(),
    limit=45.0,
    source="bump.stl",
):
    """A bump `rise` high on a plate width × height (mm) about the origin, shear up to `most` degrees near it.

    With coverage < 1 the faces at the right end (+x) are bare.
    """
    x, y = np.linspace(-width / 2, width / 2, n), np.linspace(-height / 2, height / 2, n)
    X, Y = np.meshgrid(x, y, indexing="ij")
    surface = made_up_surface(
        np.stack([X, Y, bump(X, Y, width, height, rise)], axis=-1).reshape(-1, 3), grid(n, n), source
    )
    middle = surface.points[surface.triangles].mean(axis=1)
    edge = width * (coverage - 0.5)
    face_shear = np.where(
        middle[:, 0] <= edge + 1e-9, shear_at(middle[:, 0] / width, middle[:, 1] / height, most), np.nan
    )
    pitch = pitch or min(width, height) / 24
    u, v = (pitch * np.arange(-int(side / 2 / pitch), int(side / 2 / pitch) + 1) for side in (width, height))
    U, V = np.meshgrid(u, v, indexing="ij")
    points = np.stack([U, V, bump(U, V, width, height, rise)], axis=-1)
    points[edge + 1e-9 < u] = np.nan
    cu, cv = np.meshgrid((u[1:] + u[:-1]) / 2, (v[1:] + v[:-1]) / 2, indexing="ij")
    cell_shear = np.where(cu < edge, shear_at(cu / width, cv / height, most), np.nan)
    net = SimpleNamespace(
        surface=surface,
        origin=np.array([0.0, 0.0, rise]),
        origin_face=0,
        warp0=np.array([1.0, 0, 0]),
        weft0=np.array([0, 1.0, 0]),
        normal0=np.array([0, 0, 1.0]),
        angle=0.0,
        pitch=pitch,
        effects=(),
        reach=None,
        u=u,
        v=v,
        points=points,
        cell_shear=cell_shear,
        notes=(),
        warnings=tuple(warnings),
    )
    size = np.abs(face_shear[~np.isnan(face_shear)])
    statistics = SimpleNamespace(
        max=float(size.max()),
        p95=float(np.percentile(size, 95)),
        mean=float(size.mean()),
        over_half_limit=float((size > limit / 2).mean()),
        over_limit=float((size > limit).mean()),
    )
    flat = made_up_pattern(width, height, edge, u, v)
    area = SimpleNamespace(
        part=surface.area, draped=surface.area * coverage, fabric=flat.area, coverage=coverage
    )
    return SimpleNamespace(
        net=net,
        warnings=tuple(warnings),
        limit_angle=limit,
        face_shear=face_shear,
        flat=flat,
        area=area,
        bare=tuple(bare),
        statistics=statistics,
        roll=None,
    )


def shear_at(x, y, most):
    """Four lobes of alternating sign, as on a dome; x and y relative to the part's size."""
    r2 = x**2 + y**2
    return most * 8.6 * np.sign(x * y) * np.sqrt(np.abs(x * y)) * np.exp(-12 * r2) * 0.92


def made_up_pattern(width, height, edge, u, v):
    """An L-shaped pattern with a square hole: the corner at (+u, +v) is missing."""
    a, b = width / 2, height / 2
    right = min(a, edge)
    outer = np.array(
        [[-a, -b], [right, -b], [right, 0.4 * b], [0.5 * right, 0.4 * b], [0.5 * right, b], [-a, b]]
    )
    hole = np.array([[-0.8, -0.8], [-0.8, -0.6], [-0.7, -0.6], [-0.7, -0.8]]) * [a, b]
    warp = tuple(np.array([[-a, t], [right if t < 0.4 * b else 0.5 * right, t]]) for t in v)
    weft = tuple(np.array([[s, -b], [s, b if s < 0.5 * right else 0.4 * b]]) for s in u if s <= right)
    locked = (np.array([[0.2, 0.1], [0.3, 0.1], [0.3, 0.2], [0.2, 0.2]]) * [a, b],)
    area = polygon_area(outer) + polygon_area(hole)
    return SimpleNamespace(
        outer=(outer,), inner=(hole,), warp_lines=warp, weft_lines=weft, locked=locked, area=area, cuts=()
    )


def polygon_area(polygon):
    """Signed area of a closed polygon (k, 2) by the shoelace, positive counter-clockwise."""
    x, y = np.asarray(polygon)[:, :2].T
    return 0.5 * float(x @ np.roll(y, -1) - y @ np.roll(x, -1))
