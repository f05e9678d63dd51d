"""Smooth terms of height fields z(x, y), each with its first and second derivatives in closed form."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
Term = Callable[[Array, Array], tuple[Array, ...]]
"""(x, y), each (n,) mm -> z, z_x, z_y, z_xx, z_xy, z_yy, each (n,)."""


def bump(height: float, x0: float, y0: float, sx: float, sy: float) -> Term:
    """A Gaussian bump of ``height`` mm at (x0, y0) with standard deviations ``sx``, ``sy`` mm."""

    def term(x: Array, y: Array) -> tuple[Array, ...]:
        p, q = (x - x0) / sx**2, (y - y0) / sy**2
        z = height * np.exp(-0.5 * (p * (x - x0) + q * (y - y0)))
        return z, -p * z, -q * z, (p * p - 1.0 / sx**2) * z, p * q * z, (q * q - 1.0 / sy**2) * z

    return term


def bowl(curvature_x: float, curvature_y: float) -> Term:
    """A paraboloid with the given curvatures [1/mm] at its middle: (cx x² + cy y²)/2."""

    def term(x: Array, y: Array) -> tuple[Array, ...]:
        z = 0.5 * (curvature_x * x * x + curvature_y * y * y)
        zero = np.zeros_like(x)
        return z, curvature_x * x, curvature_y * y, zero + curvature_x, zero, zero + curvature_y

    return term


def ramp(slope: float, start: float, width: float, heading: float = 0.0) -> Term:
    """Flat before ``start``, rising with ``slope`` after it, along ``heading`` [deg]; a hyperbolic fillet between.

    The radius of the fillet where it is tightest is 2 width / slope for a gentle slope.
    """
    c, s = np.cos(np.deg2rad(heading)), np.sin(np.deg2rad(heading))

    def term(x: Array, y: Array) -> tuple[Array, ...]:
        t = c * x + s * y - start
        root = np.sqrt(t * t + width * width)
        first, second = 0.5 * slope * (1.0 + t / root), 0.5 * slope * width**2 / root**3
        return 0.5 * slope * (t + root), c * first, s * first, c * c * second, c * s * second, s * s * second

    return term


def roof(slope: float, width: float, heading: float = 0.0) -> Term:
    """A ridge across ``heading`` [deg]: −slope (√(t² + width²) − width), a hyperbola of radius width / slope."""
    c, s = np.cos(np.deg2rad(heading)), np.sin(np.deg2rad(heading))

    def term(x: Array, y: Array) -> tuple[Array, ...]:
        t = c * x + s * y
        root = np.sqrt(t * t + width * width)
        first, second = -slope * t / root, -slope * width**2 / root**3
        return slope * (width - root), c * first, s * first, c * c * second, c * s * second, s * s * second

    return term


def frustum(slope: float, top: float, foot: float, shoulder: float, fillet: float, longer: float = 1.0) -> Term:
    """A truncated cone on the plane z = 0: a plateau out to about ``top`` mm, a wall of ``slope`` to ``foot``.

    ``shoulder`` and ``fillet`` (mm) round the two bends as ``width`` does a ramp's; ``shoulder`` also rounds the tip
    that hyperbolas leave in the middle. It is ``longer`` times as far out along x as if round, and 1/longer along y.
    """

    def term(x: Array, y: Array) -> tuple[Array, ...]:
        p, q = x / longer, y * longer
        r = np.sqrt(p * p + q * q + shoulder**2)
        rx, ry = p / longer / r, q * longer / r
        rxx, rxy, ryy = (1.0 / longer**2 - rx * rx) / r, -rx * ry / r, (longer**2 - ry * ry) / r
        near, far = np.hypot(r - top, shoulder), np.hypot(r - foot, fillet)
        z = 0.5 * slope * (foot - top + far - near)
        first = 0.5 * slope * ((r - foot) / far - (r - top) / near)
        second = 0.5 * slope * (fillet**2 / far**3 - shoulder**2 / near**3)
        bends = second * rx * rx + first * rxx, second * rx * ry + first * rxy, second * ry * ry + first * ryy
        return z, first * rx, first * ry, *bends

    return term


def cap(radius: float, curved_x: bool = True, curved_y: bool = True) -> Term:
    """A sphere of ``radius`` mm seen from above, or a cylinder where only one direction is curved."""

    def term(x: Array, y: Array) -> tuple[Array, ...]:
        px, py = x * curved_x, y * curved_y
        z = np.sqrt(np.maximum(radius**2 - px * px - py * py, 1e-6 * radius**2))
        zx, zy = -px / z, -py / z
        return z, zx, zy, -(curved_x + zx * zx) / z, -zx * zy / z, -(curved_y + zy * zy) / z

    return term


def added(terms: Sequence[Term]) -> Term:
    """The sum of ``terms``; none of them: the plane z = 0."""

    def term(x: Array, y: Array) -> tuple[Array, ...]:
        total = [np.zeros_like(x) for _ in range(6)]
        for one in terms:
            total = [sum_ + value for sum_, value in zip(total, one(x, y), strict=True)]
        return tuple(total)

    return term
