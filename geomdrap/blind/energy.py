"""Residuals whose sum of squares is the energy of a net on a sheet, with derivatives by the points of its nodes.

Energy: Σ (l/l0 − 1)² over the sides + ratio · Σ sin²γ/4 over the corners of the cells, and what the recipe adds.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geomdrap.blind.recipe import Recipe
from geomdrap.blind.terms import Array

LOCKED, SOFT = 0.5, 0.1
"""Stiffness beyond the locking angle, energy per rad² and corner: sides give way before the shear does; and over
how many degrees it sets in, few, or plies lock before their angle."""
RELIEF, RELIEF_SIDES, KEPT = 1.0, 0.02, 300.0
"""Slip at the crossings: energies of missing the relieved shear, of uneven sides and of a yarn's total length."""
RESTING = 0.01
"""Friction at the crossings where only a locking angle is given, as a stiffness about the shear of the ply as it was
laid: a ply that locks moves only where it must. Without it nothing says which of all nets that do not lock it is, and
yarns under pressure buckle from node to node."""
HELD = 1e3  # weight of what is held: the heading of the first warp side

Index = NDArray[np.intp]


@dataclass(frozen=True)
class Topology:
    """Which nodes make sides, corners and bends. Node numbers run over the nodes that exist."""

    sides: Index
    """(s, 2)"""
    along: Index
    """(s,) 0: warp, 1: weft."""
    yarn: Index
    """(s,) number of the yarn."""
    corners: Index
    """(c, 3): the corner's node, its warp neighbour, its weft neighbour."""
    sign: Array
    """(c,) sign of the corner's shear: −1 where just one neighbour lies toward lower u or v."""
    bends: Index
    """(b, 3): successive nodes along a yarn."""


@dataclass(frozen=True)
class Block:
    """Residuals (n,) that each depend on k nodes, and their derivatives by the points of these."""

    value: Array
    nodes: Index
    """(n, k)"""
    slope: Array
    """(n, k, 3)"""


def topology(known: NDArray[np.bool_]) -> Topology:
    """Find the sides, corners and bends of the net whose nodes are ``known`` (n, n)."""
    number: Index = np.full(known.shape, -1, dtype=np.intp)
    number[known] = np.arange(np.count_nonzero(known))
    rows, columns = np.meshgrid(*(np.arange(n) for n in known.shape), indexing="ij")
    warp = np.stack([number[:-1], number[1:]], axis=-1).reshape(-1, 2)
    weft = np.stack([number[:, :-1], number[:, 1:]], axis=-1).reshape(-1, 2)
    yarns = (columns[:-1].ravel(), known.shape[1] + rows[:, :-1].ravel())
    keep = [np.all(pair >= 0, axis=1) for pair in (warp, weft)]
    sides = np.concatenate([warp[keep[0]], weft[keep[1]]])
    along = np.repeat([0, 1], [keep[0].sum(), keep[1].sum()])
    yarn = np.concatenate([y[k] for y, k in zip(yarns, keep, strict=True)])
    corners, sign = _corners(number)
    runs = [number[:-2], number[1:-1], number[2:]], [number[:, :-2], number[:, 1:-1], number[:, 2:]]
    bends = np.concatenate([np.stack(run, axis=-1).reshape(-1, 3) for run in runs])
    return Topology(sides, along, yarn, corners, sign, bends[np.all(bends >= 0, axis=1)])


def _corners(number: Index) -> tuple[Index, Array]:
    """The four corners of each cell that has four nodes: (c, 3) and their signs (c,)."""
    a, b = number[:-1, :-1].ravel(), number[1:, :-1].ravel()
    c, d = number[1:, 1:].ravel(), number[:-1, 1:].ravel()
    whole = np.minimum(np.minimum(a, b), np.minimum(c, d)) >= 0
    four = [(a, b, d, 1.0), (b, a, c, -1.0), (c, d, b, 1.0), (d, c, a, -1.0)]
    corners = np.concatenate([np.stack(three, axis=1)[whole] for *three, _ in four])
    return corners, np.repeat([sign for *_, sign in four], whole.sum())


def strains(p: Array, sides: Index, rest: Array) -> Block:
    """l/l0 − 1 of each side; ``p`` (n, 3) mm, ``rest`` (s,) mm."""
    d = p[sides[:, 1]] - p[sides[:, 0]]
    length = np.linalg.norm(d, axis=1)
    slope = d / (length * rest)[:, None]
    return Block(length / rest - 1.0, sides, np.stack([-slope, slope], axis=1))


def sines(p: Array, corners: Index, sign: Array) -> Block:
    """sin γ of each corner, signed."""
    a, b = p[corners[:, 1]] - p[corners[:, 0]], p[corners[:, 2]] - p[corners[:, 0]]
    size_a, size_b = (np.linalg.norm(x, axis=1, keepdims=True) for x in (a, b))
    a, b = a / size_a, b / size_b
    sine = np.sum(a * b, axis=1)
    by_a = sign[:, None] * (b - sine[:, None] * a) / size_a
    by_b = sign[:, None] * (a - sine[:, None] * b) / size_b
    return Block(sign * sine, corners, np.stack([-by_a - by_b, by_a, by_b], axis=1))


def turns(p: Array, bends: Index, normal: Array, turning: Array) -> Block:
    """Turn in the sheet, rad, at each middle node of ``bends``: t' − t along left = n × (t + t'), as a unit vector.

    The ``normal`` (n, 3) turns by ``turning`` (n, 3, 3) per mm: without that, saddles would bend like plates.
    """
    first, second = p[bends[:, 1]] - p[bends[:, 0]], p[bends[:, 2]] - p[bends[:, 1]]
    size_1, size_2 = (np.linalg.norm(x, axis=1, keepdims=True) for x in (first, second))
    t1, t2, n = first / size_1, second / size_2, normal[bends[:, 1]]
    left = np.cross(n, t1 + t2)
    size = np.linalg.norm(left, axis=1, keepdims=True)
    left /= size
    value = np.sum((t2 - t1) * left, axis=1, keepdims=True)
    off = (t2 - t1 - value * left) / size  # what ``left`` sees when it turns itself
    by_1, by_2 = np.cross(off, n) - left, np.cross(off, n) + left
    by_1 = (by_1 - t1 * np.sum(by_1 * t1, axis=1, keepdims=True)) / size_1
    by_2 = (by_2 - t2 * np.sum(by_2 * t2, axis=1, keepdims=True)) / size_2
    by_normal = np.einsum("nr,nrs->ns", np.cross(t1 + t2, off), turning[bends[:, 1]])
    return Block(value[:, 0], bends, np.stack([-by_1, by_1 - by_2 + by_normal, by_2], axis=1))


def scaled(block: Block, factor: Array | float, shift: Array | float = 0.0) -> Block:
    """factor · (value − shift), and the derivatives to match; factor and shift: (n,) or a number."""
    factor = np.broadcast_to(factor, block.value.shape)
    return Block(factor * (block.value - shift), block.nodes, factor[:, None, None] * block.slope)


def blocks(
    p: Array,
    normal: tuple[Array, Array],
    net: Topology,
    rest: Array,
    side: float,
    recipe: Recipe,
    aim: Array,
) -> list[Block]:
    """All residuals of the recipe at the nodes ``p`` (n, 3), whose unit ``normal`` is (n, 3), and turns (n, 3, 3).

    ``aim`` (c,): sin γ that slipping crossings go for, or, where nothing slips, at which friction holds them.
    """
    shear = sines(p, net.corners, net.sign)
    if recipe.share:
        return [
            scaled(strains(p, net.sides, rest), np.sqrt(RELIEF_SIDES)),
            scaled(shear, 0.5 * np.sqrt(RELIEF), aim),
        ]
    found = [strains(p, net.sides, rest)]
    if recipe.stiffness:
        soft = recipe.stiffness * (1.0 + recipe.asymmetry * np.sign(shear.value))
        found.append(scaled(shear, 0.5 * np.sqrt(soft)))
    if recipe.lock:
        found.append(_locked(shear, recipe.lock))
    if recipe.lock and not recipe.stiffness:
        found.append(resting(shear, aim))
    if recipe.bending:
        found.append(scaled(turns(p, net.bends, *normal), np.sqrt(recipe.bending) / side))
    return found


def resting(shear: Block, laid: Array) -> Block:
    """√RESTING/2 times how far the sines of the shear are from those of the ply as it was ``laid`` (c,)."""
    return scaled(shear, 0.5 * np.sqrt(RESTING), laid)


def _locked(shear: Block, lock: float) -> Block:
    """√LOCKED (|γ| − γ_L) in rad where it is positive, else 0; rounded over SOFT degrees, so that it has a slope."""
    sine = np.clip(shear.value, -0.9999, 0.9999)
    soft = np.deg2rad(SOFT)
    beyond = np.abs(np.arcsin(sine)) - np.deg2rad(lock)
    root = np.sqrt(beyond**2 + soft**2)
    slope = 0.5 * (1.0 + beyond / root) * np.sign(sine) / np.sqrt(1.0 - sine * sine)
    value = 0.5 * np.sqrt(LOCKED) * (beyond + root)
    return Block(value, shear.nodes, np.sqrt(LOCKED) * slope[:, None, None] * shear.slope)
