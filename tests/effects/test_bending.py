"""Yarns that resist bending: derivatives, an independent minimum, rest from any start, and what bending does."""

import numpy as np
import pytest

from geomdrap.fishnet.dissection import FURTHER
from geomdrap.fishnet.relax_bending import add_bending, bending_energy

RADIUS = 9.0
BEND = 3.0


def uneven_net(seed=3):
    """Nodes (5, 4, 3) on a sphere about the origin, tangent vectors there, and rest lengths; one piece is missing."""
    rng = np.random.default_rng(seed)
    x = np.stack([*np.meshgrid(np.arange(5.0), np.arange(4.0), indexing="ij"), np.full((5, 4), RADIUS)], axis=-1)
    x = on_sphere(x + 0.15 * rng.normal(size=x.shape))
    basis = np.linalg.qr(np.concatenate([x[..., None], rng.normal(size=(5, 4, 3, 2))], axis=-1))[0][..., 1:].copy()
    rests = rng.uniform(0.9, 1.2, (4, 4)), rng.uniform(0.9, 1.2, (5, 3))
    rests[0][2, 1] = 0.0
    return x, basis, rests, rng


def on_sphere(x):
    return RADIUS * x / np.linalg.norm(x, axis=2, keepdims=True)


def derivatives(x, basis, rests, full=True):
    g, h, size = np.zeros((5, 4, 3)), np.zeros((5, 4, 7, 2, 2)), np.zeros((5, 4))
    turning = np.broadcast_to(np.eye(3) / RADIUS, (5, 4, 3, 3)).copy()
    add_bending(x, basis, x / RADIUS, turning, *rests, BEND, full, g, h, size)
    return g, h, size


def applied(h, way):
    """The second derivative (5, 4, 7, 2, 2) times a motion (5, 4, 2)."""
    out = np.zeros_like(way)
    for i, j in np.ndindex(5, 4):
        out[i, j] += h[i, j, 0] @ way[i, j]
        for block, (di, dj) in zip(h[i, j, 1:], FURTHER[1:], strict=True):
            if i + di < 5 and 0 <= j + dj < 4:
                out[i, j] += block @ way[i + di, j + dj]
                out[i + di, j + dj] += block.T @ way[i, j]
    return out


def test_the_gradient_is_that_of_the_energy_while_normals_turn():
    x, basis, rests, rng = uneven_net()
    move = np.einsum("ijxa,ija->ijx", basis, rng.normal(size=(5, 4, 2)))
    step = 1e-5
    ahead, behind = (on_sphere(x + s * move) for s in (step, -step))
    slope = (
        bending_energy(ahead, ahead / RADIUS, *rests, BEND) - bending_energy(behind, behind / RADIUS, *rests, BEND)
    ) / (2 * step)
    assert slope == pytest.approx((derivatives(x, basis, rests)[0] * move).sum(), rel=1e-7)


def test_the_second_derivative_is_that_of_the_energy_along_great_circles():
    x, basis, rests, rng = uneven_net()
    way = rng.normal(size=(5, 4, 2))
    move = np.einsum("ijxa,ija->ijx", basis, way)
    speed = np.linalg.norm(move, axis=2, keepdims=True) / RADIUS

    def energy_along(s):
        y = x * np.cos(s * speed) + move / speed * np.sin(s * speed)
        return bending_energy(y, y / RADIUS, *rests, BEND)

    step = 2e-4
    bent = (energy_along(step) - 2.0 * energy_along(0.0) + energy_along(-step)) / step**2
    g, h, _ = derivatives(x, basis, rests)
    pressure = (g * x).sum(axis=2) / RADIUS**2  # what ``along_tangents`` takes off
    found = (way * applied(h, way)).sum() - (pressure * (way**2).sum(axis=2)).sum()
    assert found == pytest.approx(bent, rel=1e-6)


def test_without_turns_of_turns_the_second_derivative_is_positive():
    x, basis, rests, rng = uneven_net()
    h = derivatives(x, basis, rests, full=False)[1]
    for _ in range(20):
        way = rng.normal(size=(5, 4, 2))
        assert (way * applied(h, way)).sum() > 0.0
