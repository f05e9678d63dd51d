"""A simulated ply: the geometric construction, relaxed where the recipe asks for it, and its shear."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from geomdrap.blind.cells import grow
from geomdrap.blind.closing import closed
from geomdrap.blind.lines import generators
from geomdrap.blind.recipe import Recipe
from geomdrap.blind.shear import node_shear
from geomdrap.blind.sheet import Sheet, bare, normals, parallel
from geomdrap.blind.terms import Array
from geomdrap.blind.tools import Tool
from geomdrap.errors import GeomdrapError

AGREE_MM, AGREE_DEG = 0.3, 0.6  # between nets of two finenesses: where both are smooth, the finer errs by a third
CONTINUED = 1.3  # of the tool's size: how far yarns that slip are followed beyond its rim
QUADRANTS = ((1, 1), (-1, 1), (-1, -1), (1, -1))


@dataclass(frozen=True)
class Ply:
    """A net of nodes on a sheet: NaN where the ply does not get."""

    sheet: Sheet
    u: Array
    """(n,) mm, from the seed along the warp."""
    v: Array
    """(n,) mm, along the weft."""
    plan: Array
    """(n, n, 2) plan points, mm."""
    points: Array
    """(n, n, 3) mm."""


def lay(tool: Tool, recipe: Recipe, side: float) -> Ply:
    """Lay a ply with cells of ``side`` mm on ``tool``; GeomdrapError if the seed is not on it."""
    start = np.asarray(recipe.start, dtype=float)
    if not tool.holds(start):
        raise GeomdrapError(f"the seed ({start[0]:g}, {start[1]:g}) is not on the blind part {tool.name}")
    sheet = _sheet(tool, recipe)
    plan = _slid(tool, sheet, recipe, side) if recipe.slip else _pinned(tool, sheet, recipe, side)
    m = len(plan) // 2
    ply = _ply(sheet, side * np.arange(-m, m + 1.0), plan)
    if not recipe.relaxed:
        return ply
    from geomdrap.blind.relax import relaxed

    return _ply(sheet, ply.u, relaxed(sheet, ply.plan, recipe, side))


def _pinned(tool: Tool, sheet: Sheet, recipe: Recipe, side: float) -> Array:
    """Plan points (n, n, 2) of the geometric net, with crossings that do not slip."""
    m = int(np.ceil(1.6 * sum(tool.half) / side))
    axes = _axes(sheet, recipe, side, m)
    return _unfolded(grow(sheet, tool.holds, _in_quadrants(axes), _sides(recipe, side, m)))


def _slid(tool: Tool, sheet: Sheet, recipe: Recipe, side: float) -> Array:
    """Plan points (n, n, 2) of the net whose crossings slip, where it is smooth enough for nodes ``side`` apart.

    Behind a hump yarns that keep their distance meet at an angle. Nodes of the coarser of two nets on which the
    finer does not agree are left out: there is such a kink. Nodes between those have nothing to agree with, and stay.
    """
    from geomdrap.blind.sliding import grow_sliding

    m = int(np.ceil(0.8 * sum(tool.half) / side))
    plans = []
    for size, count in ((side, 2 * m), (2.0 * side, m)):
        axes = _in_quadrants(_axes(sheet, recipe, size, count))
        sides = _sides(recipe, size, count)
        plans.append(_unfolded(grow_sliding(sheet, lambda xy: tool.holds(xy / CONTINUED), axes, sides, recipe.slip)))
    fine, coarse = (_ply(sheet, np.zeros(0), plan).points for plan in plans)
    apart = np.linalg.norm(fine[::2, ::2] - coarse, axis=2)
    turned = np.abs(node_shear(fine)[::2, ::2] - node_shear(coarse))
    plan = plans[0]
    plan[::2, ::2][~((apart < AGREE_MM) & (turned < AGREE_DEG))] = np.nan
    plan[~tool.holds(plan)] = np.nan
    return plan


def warp_direction(tangent_x: Array, normal: Array, angle: float) -> Array:
    """The direction (3,) at ``angle`` deg counter-clockwise about ``normal`` from +x laid into the tangent plane."""
    x = np.array([1.0, 0.0, 0.0])
    x = x - normal * (normal @ x)
    x /= np.linalg.norm(x)
    turn = np.deg2rad(angle)
    return np.cos(turn) * x + np.sin(turn) * np.cross(normal, x)


def _ply(sheet: Sheet, u: Array, plan: Array) -> Ply:
    points = np.full((*plan.shape[:2], 3), np.nan)
    known = np.isfinite(plan[..., 0])
    points[known] = sheet(plan[known])[0]
    return Ply(sheet, u, u.copy(), plan, points)


def _sheet(tool: Tool, recipe: Recipe) -> Sheet:
    if recipe.ball:
        return closed(tool, recipe.ball)
    return parallel(tool.term, recipe.offset) if recipe.offset else bare(tool.term)


def _axes(sheet: Sheet, recipe: Recipe, side: float, m: int) -> Array:
    """Plan points (4, m + 1, 2) of the half-axes +warp, +weft, −warp, −weft."""
    start = np.asarray(recipe.start, dtype=float)[None]
    _, tangent, _ = sheet(start)
    n = normals(sheet, start)[0]
    warp = warp_direction(tangent[0], n, recipe.angle)
    weft = warp_direction(tangent[0], n, recipe.angle + 90.0 + recipe.skew)
    turns = side * np.repeat(_curvatures(recipe)[:, None], m, axis=1)
    turns[:, 0] *= 0.5  # from the tangent at the seed to the first chord
    at, kink = recipe.kink
    if kink:
        turns[0, min(int(at / side), m - 1)] += np.sin(np.deg2rad(kink))
    sides = np.stack([_strained(recipe, axis, side, m) for axis in (0, 1, 0, 1)])
    sides[1::2] /= np.cos(np.deg2rad(recipe.skew)) ** recipe.slip  # the shear along the weft axis is −skew
    return generators(sheet, start[0], np.stack([warp, weft, -warp, -weft]), sides, turns)


def _curvatures(recipe: Recipe) -> Array:
    """Curvature to the left of each half-axis as it is walked from the seed; (4,) 1/mm."""
    warp, weft = recipe.curvature
    return np.array([warp, weft, -warp, -weft])


def _strained(recipe: Recipe, axis: int, side: float, m: int) -> Array:
    """Lengths (m,) mm of successive sides from the axis through the seed outward."""
    middle = side * (np.arange(m) + 0.5)
    return np.asarray(side * (1.0 + recipe.extension[axis] + recipe.gradient[axis] * middle))


def _in_quadrants(axes: Array) -> tuple[Array, Array]:
    """The half-axes (4, m + 1, 2) as warp and weft axes of the four quadrants."""
    half = {(0, 1): 0, (1, 1): 1, (0, -1): 2, (1, -1): 3}
    warp = np.stack([axes[half[0, s]] for s, _ in QUADRANTS])
    weft = np.stack([axes[half[1, t]] for _, t in QUADRANTS])
    return warp, weft


def _sides(recipe: Recipe, side: float, m: int) -> tuple[Array, Array]:
    """Warp sides (4, m, m + 1) and weft sides (4, m + 1, m), mm: the same in all quadrants."""
    warp = np.broadcast_to(_strained(recipe, 0, side, m)[:, None], (4, m, m + 1))
    weft = np.broadcast_to(_strained(recipe, 1, side, m)[None, :], (4, m + 1, m))
    return warp, weft


def _unfolded(quads: Array) -> Array:
    """One net (2m + 1, 2m + 1, 2) out of four quadrants (4, m + 1, m + 1, 2)."""
    m = quads.shape[1] - 1
    plan = np.full((2 * m + 1, 2 * m + 1, 2), np.nan)
    for (s, t), quad in zip(QUADRANTS, quads, strict=True):
        plan[m::s, m::t] = quad
    return plan
