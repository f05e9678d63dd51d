"""Whether a ball cuts the part, and where: a tree of discs that hold the facets.

The centre of a ball that rolls on the part is a radius away from it, and over a smooth stretch everything is nearly
as far. Boxes and spheres do not tell such facets apart; flat discs do, since beside the foot of the ball they know
the height and the way to the side. It is also known from the start how near a facet must be to matter.

Source: trees of bounding volumes, C. Ericson, Real-Time Collision Detection (2005), chapter 6.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from geomdrap.fishnet.follow_surface import reach
from geomdrap.geodesic.compiled import kernel, tight

LEAF = 4  # facets in a leaf, at most
DEEP = 64  # levels of the tree, at most


class DiscTree(NamedTuple):
    """A tree over facets (m, 3) of points (n, 3) mm.

    ``order`` (m,) holds the facets, those of a leaf side by side. A node of ``nodes`` (k, 3) holds the first and one
    past the last of its facets, and its first child, whose sister is the next node (-1 for a leaf). ``discs`` (k, 8):
    centre, unit normal, half the thickness and radius of what holds a node. ``across`` (m, 3) are normals of the
    facets, as long as twice their areas.
    """

    points: np.ndarray
    facets: np.ndarray
    across: np.ndarray
    order: np.ndarray
    nodes: np.ndarray
    discs: np.ndarray


def disc_tree(points: np.ndarray, facets: np.ndarray) -> DiscTree:
    """The tree over facets (m, 3) int of points (n, 3) mm."""
    points = np.ascontiguousarray(points, dtype=np.float64)
    facets = np.ascontiguousarray(facets, dtype=np.int64)
    a, b, c = points[facets].swapaxes(0, 1)
    across = np.cross(b - a, c - a)
    return DiscTree(points, facets, across, *halve(points, facets, (a + b + c) / 3.0, across))


@kernel
def halve(
    points: np.ndarray, facets: np.ndarray, middle: np.ndarray, across: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The rest of a tree: facets are halved across the longest side of the box about their ``middle`` (m, 3)."""
    m = len(facets)
    order = np.arange(m)
    nodes, discs = np.full((2 * m + 1, 3), -1), np.empty((2 * m + 1, 8))
    nodes[0, 0], nodes[0, 1], count, node = 0, m, 1, 0
    while node < count:
        a, b = nodes[node, 0], nodes[node, 1]
        axis = enclose(points, facets, middle, across, order, a, b, discs[node])
        if b - a > LEAF:
            half = (a + b) // 2
            select(order, middle, axis, a, b, half)
            nodes[node, 2] = count
            nodes[count, 0], nodes[count, 1], nodes[count + 1, 0], nodes[count + 1, 1] = a, half, half, b
            count += 2
        node += 1
    return order, nodes[:count].copy(), discs[:count].copy()


@tight
def enclose(
    points: np.ndarray,
    facets: np.ndarray,
    middle: np.ndarray,
    across: np.ndarray,
    order: np.ndarray,
    a: int,
    b: int,
    disc: np.ndarray,
) -> int:
    """The ``disc`` (8,) that holds the facets ``order[a:b]``, and the axis along which their centres spread most."""
    axis, widest, size = 0, -1.0, 0.0
    for r in range(3):
        low, high, total = math.inf, -math.inf, 0.0
        for k in range(a, b):
            low, high = min(low, middle[order[k], r]), max(high, middle[order[k], r])
            total += across[order[k], r]
        if high - low > widest:
            axis, widest = r, high - low
        disc[r], disc[3 + r] = 0.5 * (low + high), total
        size += total * total
    for r in range(3):
        disc[3 + r] = disc[3 + r] / math.sqrt(size) if size > 0.0 else (1.0 if r == 2 else 0.0)
    thick = wide = 0.0
    for k in range(a, b):
        for corner in range(3):
            p = facets[order[k], corner]
            x, y, z = points[p, 0] - disc[0], points[p, 1] - disc[1], points[p, 2] - disc[2]
            up = x * disc[3] + y * disc[4] + z * disc[5]
            thick = max(thick, abs(up))
            wide = max(wide, x * x + y * y + z * z - up * up)
    disc[6], disc[7] = thick, math.sqrt(wide)
    return axis


@tight
def select(order: np.ndarray, middle: np.ndarray, axis: int, a: int, b: int, half: int) -> None:
    """Order ``order[a:b]`` so that none before ``half`` lies beyond one after it (C. A. R. Hoare, 1961)."""
    low, high = a, b - 1
    while low < high:
        pivot = middle[order[(low + high) // 2], axis]
        i, j = low, high
        while i <= j:
            while middle[order[i], axis] < pivot:
                i += 1
            while middle[order[j], axis] > pivot:
                j -= 1
            if i <= j:
                order[i], order[j] = order[j], order[i]
                i += 1
                j -= 1
        if half <= j:
            high = j
        elif half >= i:
            low = i
        else:
            return


def nearest_within(
    tree: DiscTree, at: np.ndarray, bound: np.ndarray, first_will_do: bool = False
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Facets (k,), their nearest points (k, 3) and distances (k,) to points ``at`` (k, 3).

    Only facets nearer than ``bound`` (k,) count: -1 and an infinite distance where none is. ``first_will_do``: any
    of them, not the nearest.
    """
    return search(tree.points, tree.facets, tree.order, tree.nodes, tree.discs, at, bound, first_will_do)


@kernel
def search(
    points: np.ndarray,
    facets: np.ndarray,
    order: np.ndarray,
    nodes: np.ndarray,
    discs: np.ndarray,
    at: np.ndarray,
    bound: np.ndarray,
    first_will_do: bool,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """``nearest_within`` on the arrays of a tree."""
    face, place, distance = np.full(len(at), -1), np.full((len(at), 3), np.nan), np.full(len(at), np.inf)
    stack, squares = np.empty(DEEP, np.int64), np.empty(DEEP)
    for n in range(len(at)):
        goal = (at[n, 0], at[n, 1], at[n, 2])
        f, x, y, z, d = descend(points, facets, order, nodes, discs, goal, bound[n], first_will_do, stack, squares)
        if f >= 0:
            face[n], distance[n] = f, d
            place[n, 0], place[n, 1], place[n, 2] = x, y, z
    return face, place, distance


@tight
def descend(
    points: np.ndarray,
    facets: np.ndarray,
    order: np.ndarray,
    nodes: np.ndarray,
    discs: np.ndarray,
    goal: tuple[float, float, float],
    bound: float,
    first_will_do: bool,
    stack: np.ndarray,
    squares: np.ndarray,
) -> tuple[int, float, float, float, float]:
    """The nearest facet, its nearest point and distance for one place; the nearer child is looked at first."""
    gx, gy, gz = goal
    best, face, x, y, z = bound * bound, -1, math.nan, math.nan, math.nan
    stack[0], squares[0], top = 0, least_square(discs, 0, gx, gy, gz), 1
    while top > 0:
        top -= 1
        node = stack[top]
        if squares[top] >= best:
            continue
        child = nodes[node, 2]
        if child >= 0:
            one, other = least_square(discs, child, gx, gy, gz), least_square(discs, child + 1, gx, gy, gz)
            near_is_other = other < one
            far, near = max(one, other), min(one, other)
            if far < best:
                stack[top], squares[top] = child + (0 if near_is_other else 1), far
                top += 1
            if near < best:
                stack[top], squares[top] = child + (1 if near_is_other else 0), near
                top += 1
            continue
        for k in range(nodes[node, 0], nodes[node, 1]):
            there = reach(points, facets, order[k], gx, gy, gz)
            if there[0] < best:
                best, face, x, y, z = there[0], order[k], there[1], there[2], there[3]
        if first_will_do and face >= 0:
            break
    return face, x, y, z, math.sqrt(best)


@tight
def least_square(discs: np.ndarray, k: int, gx: float, gy: float, gz: float) -> float:
    """Squared distance of a place from disc k: the least that a facet in it can have."""
    dx, dy, dz = gx - discs[k, 0], gy - discs[k, 1], gz - discs[k, 2]
    up = dx * discs[k, 3] + dy * discs[k, 4] + dz * discs[k, 5]
    side = math.sqrt(max(dx * dx + dy * dy + dz * dz - up * up, 0.0)) - discs[k, 7]
    up = abs(up) - discs[k, 6]
    return max(up, 0.0) ** 2 + max(side, 0.0) ** 2
