"""Points and triangles, as arrays, for tests: good ones and broken ones."""

from __future__ import annotations

import numpy as np


def grid(n=4, size=100.0, height=None):
    """A square sheet of 2 n² triangles in z = height(x, y)."""
    x, y = np.meshgrid(np.linspace(0.0, size, n + 1), np.linspace(0.0, size, n + 1), indexing="ij")
    z = np.zeros_like(x) if height is None else height(x, y)
    number = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    triangles = np.concatenate([np.stack(t, axis=-1).reshape(-1, 3) for t in ((a, b, c), (a, c, d))])
    return np.stack([x, y, z], axis=-1).reshape(-1, 3), triangles


def bumpy(n=12, size=100.0):
    """A sheet with no symmetry and no two faces alike."""
    return grid(n, size, lambda x, y: 0.1 * size * np.sin(5 * x / size) * np.cos(4 * y / size + 0.3))


def box(size=(10.0, 20.0, 30.0)):
    """A closed box of 12 triangles, facing outward."""
    points = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * np.array(size)
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return points, np.array(triangles)


def soup(points, triangles):
    """The same triangles with three points of their own each, as STL has them."""
    return points[triangles].reshape(-1, 3), np.arange(3 * len(triangles)).reshape(-1, 3)


def ribbon(n=24, twist=0.0, radius=50.0, width=20.0):
    """A closed band with so many half turns: 0 a ring, 1 a Möbius strip."""
    rows = []
    for i in range(n):
        turn = 2 * np.pi * i / n
        half = 0.5 * twist * turn
        across = np.array([np.cos(half) * np.cos(turn), np.cos(half) * np.sin(turn), np.sin(half)])
        middle = radius * np.array([np.cos(turn), np.sin(turn), 0.0])
        rows += [middle - 0.5 * width * across, middle + 0.5 * width * across]
    odd = round(twist) % 2
    triangles = []
    for i in range(n):
        a, b, c, d = 2 * i, 2 * i + 1, (2 * i + 2) % (2 * n), (2 * i + 3) % (2 * n)
        if i == n - 1 and odd:
            c, d = d, c
        triangles += [(a, b, d), (a, d, c)]
    return np.array(rows), np.array(triangles)


def fin():
    """A sheet with a wall standing on one of its inner edges."""
    points, triangles = grid(2)
    points = np.vstack([points, points[4] + [0.0, 0.0, 40.0]])
    return points, np.vstack([triangles, [3, 4, 9]])


def rotation(seed=0):
    """A rotation matrix in general position."""
    q, _ = np.linalg.qr(np.random.default_rng(seed).normal(size=(3, 3)))
    return q * np.sign(np.linalg.det(q))
