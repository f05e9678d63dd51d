"""Parts made for tests, whose geometry is known exactly or has no symmetry that could hide a mistake."""

from __future__ import annotations

import numpy as np

from geomdrap.surface import Surface, shapes


def bumpy_sheet(seed=0, n=24, size=100.0, height=12.0, jitter=0.25):
    """A sheet of random smooth bumps on a grid whose points are shifted at random; no two faces alike."""
    rng = np.random.default_rng(seed)
    line = np.linspace(-size / 2, size / 2, n + 1)
    x, y = np.meshgrid(line, line, indexing="ij")
    inner = np.zeros((n + 1, n + 1))
    inner[1:-1, 1:-1] = jitter * size / n
    x = x + inner * rng.uniform(-1, 1, inner.shape)
    y = y + inner * rng.uniform(-1, 1, inner.shape)
    z = np.zeros_like(x)
    for _ in range(4):
        k, phase = rng.uniform(-6.0, 6.0, 2) / size, rng.uniform(0, 2 * np.pi)
        z += 0.25 * height * np.sin(2 * (k[0] * x + k[1] * y) + phase)
    return sheet(np.stack([x, y, z], axis=-1), rng.integers(0, 2, (n, n)))


def sheet(points, diagonals=None):
    """Sheet over a grid of points (nx, ny, 3), normals x × y; ``diagonals`` (nx - 1, ny - 1) 0 or 1."""
    nx, ny = points.shape[:2]
    number = np.arange(nx * ny).reshape(nx, ny)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    turned = np.zeros((nx - 1, ny - 1), bool) if diagonals is None else np.asarray(diagonals, bool)
    first = np.where(turned[..., None], np.stack([a, b, d], -1), np.stack([a, b, c], -1))
    second = np.where(turned[..., None], np.stack([b, c, d], -1), np.stack([a, c, d], -1))
    return Surface(points.reshape(-1, 3), np.concatenate([first.reshape(-1, 3), second.reshape(-1, 3)]))


def plane_sheet(cells=10, side=100.0):
    """A flat square of ``side`` mm in the plane z = 0, a corner at the origin."""
    x = np.linspace(0.0, side, cells + 1)
    return sheet(np.stack([*np.meshgrid(x, x, indexing="ij"), np.zeros((cells + 1, cells + 1))], axis=-1))


def pyramid(sides=12, slope=0.8, radius=100.0, rings=10):
    """A pyramid of plane sides, apex up at the origin: developable but for its tip, to the last digit."""
    turn = 2 * np.pi * np.arange(sides) / sides
    corners = radius * np.stack([np.cos(turn), np.sin(turn), np.full(sides, -slope)], axis=-1)
    points, triangles = [], []
    for k in range(sides):
        a, b = corners[k], corners[(k + 1) % sides]
        base = len(points)
        number = {}
        for i in range(rings + 1):
            for j in range(i + 1):
                number[i, j] = base + len(number)
                points.append(((i - j) * a + j * b) / rings)
        for i in range(rings):
            for j in range(i + 1):
                triangles.append((number[i, j], number[i + 1, j], number[i + 1, j + 1]))
                if j < i:
                    triangles.append((number[i, j], number[i + 1, j + 1], number[i, j + 1]))
    return Surface(np.array(points), np.array(triangles))


def square_tube(side=40.0, length=200.0, steps=4):
    """A tube of square section along x, closed round; unrolled it is a strip without end."""
    line = np.linspace(0.0, side, steps + 1)[:-1]
    half = side / 2
    ring = np.concatenate(
        [
            np.column_stack([half - line, np.full(steps, half)]),
            np.column_stack([np.full(steps, -half), half - line]),
            np.column_stack([line - half, np.full(steps, -half)]),
            np.column_stack([np.full(steps, half), line - half]),
        ]
    )
    return shapes.extrude(np.vstack([ring[::-1], ring[-1:]]), length, side / steps)


def cube(side=60.0, steps=6):
    """A closed cube about the origin, each side a grid."""
    line = np.linspace(-side / 2, side / 2, steps + 1)
    a, b = np.meshgrid(line, line, indexing="ij")
    top = np.full_like(a, side / 2)
    patches = []
    for axis in range(3):
        for sign in (1.0, -1.0):
            p = np.stack([a, b if sign > 0 else -b, sign * top], axis=-1)
            patches.append(sheet_triangles(np.roll(p, axis, axis=-1)))
    points = np.concatenate([p for p, _ in patches])
    shift = np.cumsum([0] + [len(p) for p, _ in patches[:-1]])
    return Surface(points, np.concatenate([t + s for (_, t), s in zip(patches, shift, strict=True)]))


def sheet_triangles(points):
    """Points (n, 3) and triangles (m, 3) of a sheet over a grid of points (nx, ny, 3)."""
    nx, ny = points.shape[:2]
    number = np.arange(nx * ny).reshape(nx, ny)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    t = [np.stack(corners, -1).reshape(-1, 3) for corners in ((a, b, c), (a, c, d))]
    return points.reshape(-1, 3), np.concatenate(t)


def plate_with_holes(holes=((0.0, 0.0, 30.0),), size=200.0, edge=5.0):
    """A flat square plate with square holes (x, y, half width) cut along the lines of its grid."""
    lines = np.linspace(-size / 2, size / 2, round(size / edge) + 1)

    def keep(x, y):
        out = np.ones(x.shape, bool)
        for cx, cy, half in holes:
            out &= np.maximum(abs(x - cx), abs(y - cy)) > half
        return out

    return shapes.grid_surface(lambda x, y: 0.0 * x, lines, lines, keep=keep)


def face_point(surface, face, weights):
    """Point (3,) of a face with barycentric weights (3,)."""
    return np.asarray(weights) @ surface.points[surface.triangles[face]]


def random_starts(surface, rng, count):
    """Faces (count,), points (count, 3) and tangent unit directions (count, 3), anywhere on a surface."""
    faces = rng.integers(0, len(surface.triangles), count)
    weights = rng.dirichlet(np.ones(3), count)
    points = np.einsum("nk,nkc->nc", weights, surface.points[surface.triangles[faces]])
    turn = rng.uniform(0, 2 * np.pi, count)[:, None]
    return faces, points, np.cos(turn) * surface.e1[faces] + np.sin(turn) * surface.e2[faces]


def open_box(edge, size=(100.0, 80.0, 60.0)):
    """A box without its bottom, its top at half its height, in facets of about ``edge`` mm; corners are sharp."""
    points, triangles = [], []
    half = 0.5 * np.array(size)
    # of each side an axis across it, which way, and the two axes along it so that it is seen from outside
    for axis, sense, u, v in ((2, 1, 0, 1), (0, 1, 1, 2), (0, -1, 2, 1), (1, 1, 2, 0), (1, -1, 0, 2)):
        nu, nv = round(size[u] / edge), round(size[v] / edge)
        i, j = np.indices((nu + 1, nv + 1)).reshape(2, -1)
        corner = np.zeros((len(i), 3))
        corner[:, axis] = sense * half[axis]
        corner[:, u], corner[:, v] = (i / nu * 2 - 1) * half[u], (j / nv * 2 - 1) * half[v]
        triangles.append(sheet_triangles(corner.reshape(nu + 1, nv + 1, 3))[1] + sum(map(len, points)))
        points.append(corner)
    return Surface(np.vstack(points), np.vstack(triangles))


def pan(columns=96, wall=0.25 * np.pi, fillet=15.0, depth=40.0, hole=15.0, flat=70.0):
    """A round pan with a hole, a fillet and a conical wall, its facets long around and short up the wall."""
    bend = fillet * wall
    way = np.linspace(0.0, flat - hole + bend + depth, 60)[:, None]
    turned = np.clip((way - (flat - hole)) / fillet, 0.0, wall)
    up = np.clip(way - (flat - hole) - bend, 0.0, None)
    radius = hole + np.minimum(way, flat - hole) + fillet * np.sin(turned) + up * np.cos(wall)
    height = fillet * (1.0 - np.cos(turned)) + up * np.sin(wall)
    around = np.linspace(0.0, 2.0 * np.pi, columns + 1)[None]
    points = np.stack([radius * np.cos(around), radius * np.sin(around), height + 0.0 * around], axis=-1)
    return Surface(*sheet_triangles(points))
