"""Analytic tools to drape on: smooth height fields over a rectangle, drawn at random within a family."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geomdrap.blind.terms import Array, Term, added, bowl, bump, cap, frustum, ramp, roof
from geomdrap.errors import GeomdrapError


@dataclass(frozen=True)
class Tool:
    """A tool z(x, y) over |x| ≤ half[0], |y| ≤ half[1] (mm), the ply on its upper side."""

    name: str
    term: Term
    half: tuple[float, float]
    concave: bool = False
    """Whether it has concave fillets that a stiff ply would bridge."""

    def holds(self, xy: Array) -> NDArray[np.bool_]:
        """Tell which of the points ``xy`` (..., 2) mm lie over the tool."""
        return (np.abs(xy[..., 0]) <= self.half[0]) & (np.abs(xy[..., 1]) <= self.half[1])

    def height(self, x: Array, y: Array) -> Array:
        """Give z [mm] at ``x``, ``y`` (any one shape, mm)."""
        return self.term(np.ravel(x), np.ravel(y))[0].reshape(np.shape(x))


_Draw = Callable[[np.random.Generator, float], Tool]


def _dome(rng: np.random.Generator, size: float) -> Tool:
    h, s = size * rng.uniform(62.0, 88.0), size * rng.uniform(58.0, 70.0)
    x, y = size * rng.uniform(-6.0, 6.0, 2)
    flat = rng.uniform(0.9, 1.1)
    return Tool("dome", bump(h, x, y, s * flat, s / flat), (size * 152.0, size * 152.0))


def _saddle(rng: np.random.Generator, size: float) -> Tool:
    c = rng.uniform(0.0050, 0.0068, 2) / size
    return Tool("saddle", bowl(c[0], -c[1]), (size * 140.0, size * 140.0))


def _double_bump(rng: np.random.Generator, size: float) -> Tool:
    high, low = size * rng.uniform(50.0, 62.0), size * rng.uniform(28.0, 42.0)
    gap, side = size * rng.uniform(66.0, 78.0), size * rng.uniform(-14.0, 14.0)
    s, t = size * rng.uniform(44.0, 54.0, 2)
    terms = (bump(high, -gap, side, s, s * 1.1), bump(low, gap, -side, t * 1.1, t))
    return Tool("double-bump", added(terms), (size * 165.0, size * 125.0))


def _valley(rng: np.random.Generator, size: float) -> Tool:
    bottom, steep = size * rng.uniform(24.0, 34.0), rng.uniform(0.9, 1.25)
    tops = bottom + size * rng.uniform(38.0, 56.0, 2)
    fillet, shoulder = size * rng.uniform(8.0, 11.0), size * rng.uniform(14.0, 18.0)
    walls = [
        wall
        for heading, top in zip((0.0, 180.0), tops, strict=True)
        for wall in (ramp(steep, bottom, fillet, heading), ramp(-steep, top, shoulder, heading))
    ]
    sweep = bowl(0.0, -rng.uniform(0.0022, 0.0034) / size)
    return Tool("valley", added([*walls, sweep]), (size * 160.0, size * 130.0), concave=True)


def _pan(rng: np.random.Generator, size: float) -> Tool:
    slopes = rng.uniform(0.55, 0.95, 4)
    starts = size * rng.uniform(38.0, 62.0, 4)
    width = size * rng.uniform(7.0, 10.0)
    headings = (0.0, 90.0, 180.0, 270.0)
    walls = [ramp(m, at, width, h) for m, at, h in zip(slopes, starts, headings, strict=True)]
    return Tool("pan", added(walls), (size * 140.0, size * 140.0), concave=True)


def _ridge(rng: np.random.Generator, size: float) -> Tool:
    back = roof(rng.uniform(0.6, 0.9), size * rng.uniform(38.0, 55.0), rng.uniform(-15.0, 15.0))
    crown = bowl(0.0, -rng.uniform(0.0022, 0.0034) / size)
    return Tool("ridge", added([back, crown]), (size * 140.0, size * 150.0))


def _bowl(rng: np.random.Generator, size: float) -> Tool:
    c = rng.uniform(0.0058, 0.0072, 2) / size
    return Tool("bowl", bowl(c[0], c[1]), (size * 140.0, size * 140.0))


def _hat(rng: np.random.Generator, size: float) -> Tool:
    slope, longer = rng.uniform(0.95, 1.2), rng.uniform(0.95, 1.05)
    top = size * rng.uniform(38.0, 46.0)
    foot = top + size * rng.uniform(40.0, 50.0)
    shoulder, fillet = size * rng.uniform(16.0, 20.0), size * rng.uniform(8.0, 11.0)
    boss = frustum(slope, top, foot, shoulder, fillet, longer)
    return Tool("hat", boss, (size * 150.0, size * 150.0), concave=True)


def _joggle(rng: np.random.Generator, size: float) -> Tool:
    slope, heading = rng.uniform(0.95, 1.25), rng.uniform(-15.0, 15.0)
    foot, top = size * rng.uniform(-45.0, -30.0), size * rng.uniform(20.0, 35.0)
    fillet, shoulder = size * rng.uniform(8.0, 11.0), size * rng.uniform(14.0, 18.0)
    sweep = bowl(0.0, -rng.uniform(0.0022, 0.0034) / size)
    walls = [ramp(slope, foot, fillet, heading), ramp(-slope, top, shoulder, heading)]
    return Tool("joggle", added([*walls, sweep]), (size * 150.0, size * 130.0), concave=True)


TOOLS: dict[str, _Draw] = {
    "dome": _dome,
    "saddle": _saddle,
    "double-bump": _double_bump,
    "valley": _valley,
    "pan": _pan,
    "ridge": _ridge,
    "bowl": _bowl,
    "hat": _hat,
    "joggle": _joggle,
}
"""The families, each drawn from a random generator and a size factor (1: about 300 mm long)."""

CONCAVE = ("valley", "pan", "hat", "joggle")
"""The families that a stiff ply bridges."""


def draw_tool(name: str, rng: np.random.Generator, size: float = 1.0) -> Tool:
    """Draw a tool of the family ``name``; ``size`` scales all its lengths. GeomdrapError for an unknown name."""
    if name not in TOOLS:
        raise GeomdrapError(f"there is no blind part '{name}'; choose one of {', '.join(TOOLS)}")
    if not 0.3 <= size <= 4.0:
        raise GeomdrapError(f"size {size:g} is not between 0.3 and 4; 1 is a part of about 300 mm")
    return TOOLS[name](rng, size)


def plane(half: float = 100.0) -> Tool:
    """The plane z = 0, to check the simulator against."""
    return Tool("plane", added([]), (half, half))


def sphere(radius: float, half: float) -> Tool:
    """The top of a sphere, to check the simulator against."""
    return Tool("sphere", cap(radius), (half, half))


def cylinder(radius: float, half: float) -> Tool:
    """A cylinder along y, to check the simulator against."""
    return Tool("cylinder", cap(radius, curved_y=False), (half, half))
