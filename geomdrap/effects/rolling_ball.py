"""The closing of a tool by a ball: what is left of it when a ball of given radius rolls over it and fills the rest.

The ball's centre c keeps the radius r from every point of the tool. A point p of the tool that no such ball touches
is lifted: with c the nearest allowed centre, p moves to c + r·(p − c)/|p − c|. That point lies on the closed surface,
since any other allowed centre is at least r away from it.

The nearest centre is found by exchange: from an allowed centre, the region is cut down by one tool point after
the other, each time the one nearest to the centre that would be best so far, until that one keeps its distance and
becomes the new centre. Every tool point is a true constraint, made convex by the half-space that it leaves as seen
from the allowed centre, so that each centre is better than the one before. The start, the nearest of the allowed
centres above the facets, picks the right side of a narrow channel.

Source: closing by a ball, J. Serra, Image Analysis and Mathematical Morphology (1982); exchange methods of
semi-infinite programming, R. Hettich and K. Kortanek, SIAM Review 35 (1993).
"""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.effects.disc_tree import DiscTree, disc_tree, nearest_within
from geomdrap.errors import EffectError
from geomdrap.geodesic.compiled import kernel

if TYPE_CHECKING:
    from geomdrap.surface import Surface

TOUCH = 1e-6  # of the radius: a ball that comes this close touches
SETTLED = 1e-4  # of the radius: how closely the best centre is found
ROUNDS = 30
SKIRT = 2.0  # radii: the part goes on straight beyond its rim by as much, so that no ball comes round it
LOOKS = (16, 64)  # centres asked about for each point, before all that are left
UNKNOWN = -1
KEPT = 5  # tool points that a centre is kept away from; further ones replace the one that binds least
SMOOTH_COSINE = math.cos(math.radians(12.0))  # facets that differ less from the vertex normal stand for a curve


def closed_points(surface: Surface, radius: float) -> np.ndarray:
    """The vertices (n, 3) of a surface where a ball of ``radius`` mm, on the side of the normals, leaves them.

    Raises EffectError where no ball of that size touches the part at all.
    """
    points = surface.points
    tool = _with_skirt(surface, SKIRT * radius)
    centre = points + radius * surface.vertex_normals
    room = radius * _least_cosine(surface) * (1.0 - TOUCH)
    lifted = np.flatnonzero(cuts(tool, centre, room))  # whichever side of it is in the way
    out = points.copy()
    if len(lifted) == 0:
        return out
    start = _allowed_centres(surface, tool, radius, centre, lifted)
    p = points[lifted]
    c = _nearest_centres(tool, radius, p, start)
    away = p - c
    gap = np.linalg.norm(away, axis=1, keepdims=True)
    out[lifted] = np.where(gap > radius, c + radius * away / np.maximum(gap, 1e-300), p)
    return out


def cuts(tool: DiscTree, centre: np.ndarray, radius: np.ndarray) -> np.ndarray:
    """Whether balls of a ``radius`` (k,) about centres (k, 3) cut the tool."""
    return nearest_within(tool, centre, radius, first_will_do=True)[0] >= 0


def clearance(tool: DiscTree, at: np.ndarray, bound: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Nearest points (k, 3) to places (k, 3), and their distances (k,), negative behind the tool.

    ``bound`` (k,) mm: distances that the nearest ones do not exceed.
    """
    face, near, distance = nearest_within(tool, at, bound)
    behind = ((at - near) * tool.across[face]).sum(axis=1) < 0.0
    return near, np.where(behind, -distance, distance)


def _with_skirt(surface: Surface, width: float) -> DiscTree:
    """The part with a strip beyond its rim that goes on in the plane of the facets."""
    f, k = np.nonzero(surface.neighbours < 0)
    a, b = surface.triangles[f, k], surface.triangles[f, (k + 1) % 3]
    along = surface.points[b] - surface.points[a]
    outward = np.cross(along / np.linalg.norm(along, axis=1, keepdims=True), surface.normals[f])
    way = np.zeros_like(surface.points)
    np.add.at(way, a, outward)
    np.add.at(way, b, outward)
    rim, place = np.unique(np.concatenate([a, b]), return_inverse=True)
    length = np.linalg.norm(way[rim], axis=1, keepdims=True)
    beyond = surface.points[rim] + width * way[rim] / np.maximum(length, 1e-12)
    c, d = (len(surface.points) + part for part in np.split(place, 2))
    strip = np.vstack([np.column_stack([b, a, c]), np.column_stack([b, c, d])])
    return disc_tree(np.vstack([surface.points, beyond]), np.vstack([surface.triangles, strip]))


def _allowed_centres(
    surface: Surface, tool: DiscTree, radius: float, over_vertices: np.ndarray, lifted: np.ndarray
) -> np.ndarray:
    """For each lifted vertex the nearest centre at which a ball rests on the part without cutting it (k, 3).

    Raises EffectError where there is none on the whole part.
    """
    over_facets = surface.points[surface.triangles].mean(axis=1) + radius * surface.normals
    resting = np.ones(len(over_vertices), bool)
    resting[lifted] = False
    centres = np.vstack([over_facets, over_vertices[resting]])
    nearest = _nearest_allowed(
        centres, surface.points[lifted], lambda c: ~cuts(tool, c, np.full(len(c), radius * (1.0 - TOUCH)))
    )
    if nearest is None:
        raise EffectError(
            f"effect bridging: a ball of radius {radius:g} mm touches {surface.source} nowhere without cutting it; "
            "use a smaller radius, or turn the part's normal (--flip) if the ply lies on its other side"
        )
    return centres[nearest]


def _nearest_allowed(
    centres: np.ndarray, points: np.ndarray, allowed: Callable[[np.ndarray], np.ndarray]
) -> np.ndarray | None:
    """Numbers (k,) of the allowed centres nearest to points (k, 3); None if none is allowed.

    Those nearest to the points are asked about first where that is few of all, as it mostly is.
    """
    from scipy.spatial import cKDTree

    tree = cKDTree(centres)
    verdict = np.full(len(centres), UNKNOWN)
    found = np.full(len(points), -1)
    todo, seen = np.arange(len(points)), 0
    for many in LOOKS if LOOKS[0] * len(points) < len(centres) else ():
        look = min(many, len(centres))
        near = np.asarray(tree.query(points[todo], k=range(seen + 1, look + 1))[1])
        asked = np.unique(near[verdict[near] == UNKNOWN])
        verdict[asked] = allowed(centres[asked])
        good = verdict[near] == 1
        has = good.any(axis=1)
        found[todo[has]] = near[has, good[has].argmax(axis=1)]
        todo, seen = todo[~has], look
        if len(todo) == 0:
            return found
    asked = np.flatnonzero(verdict == UNKNOWN)
    verdict[asked] = allowed(centres[asked])
    good = np.flatnonzero(verdict == 1)
    if len(good) == 0:
        return None
    found[todo] = good[cKDTree(centres[good]).query(points[todo])[1]]
    return found


def _least_cosine(surface: Surface) -> np.ndarray:
    """Cosine (n,) of the vertex normal to the facet there that differs most; 1 where facets meet in an edge.

    On facets that stand for a hollow of a larger radius, a ball on a vertex cuts the facets beside it by that much;
    it does not cut the hollow.
    """
    facing = np.einsum("fkx,fx->fk", surface.vertex_normals[surface.triangles], surface.normals)
    least = np.ones(len(surface.points))
    np.minimum.at(least, surface.triangles.ravel(), facing.ravel())
    return np.where(least < SMOOTH_COSINE, 1.0, least)


def _nearest_centres(tool: DiscTree, radius: float, p: np.ndarray, start: np.ndarray) -> np.ndarray:
    """The allowed centres (k, 3) nearest to points (k, 3), from allowed ones."""
    c, trial = start.copy(), start.copy()
    touched = np.full((len(p), KEPT, 3), np.inf)
    todo = np.arange(len(p))
    for _ in range(ROUNDS):
        here = (c[todo], trial[todo], touched[todo])
        near, distance = clearance(tool, trial[todo], _known_distance(p[todo], *here[1:], TOUCH * radius))
        going = exchange(p[todo], *here, near, distance, radius)
        c[todo], trial[todo], touched[todo] = here
        todo = todo[going]
        if len(todo) == 0:
            break
    return c


def _known_distance(p: np.ndarray, trial: np.ndarray, touched: np.ndarray, more: float) -> np.ndarray:
    """The distances (k,) of trials (k, 3) from the nearest points of the tool that are known, and ``more``."""
    known = np.concatenate([p[:, None], touched], axis=1)
    return np.asarray(np.linalg.norm(known - trial[:, None], axis=2).min(axis=1) + more)


@kernel
def exchange(
    p: np.ndarray,
    c: np.ndarray,
    trial: np.ndarray,
    touched: np.ndarray,
    near: np.ndarray,
    distance: np.ndarray,
    radius: float,
) -> np.ndarray:
    """One round for k points p (k, 3): which of them go on (k,).

    A ``trial`` (k, 3) whose nearest tool point ``near`` (k, 3) keeps its ``distance`` (k,) becomes the centre ``c``;
    that point is among those that the next trial keeps away from, ``touched`` (k, KEPT, 3). A trial behind the tool,
    its distance negative, is taken back half the way. It ends where an allowed trial has not moved.
    """
    going = np.ones(len(p), np.bool_)
    for n in range(len(p)):
        step = trial[n] - c[n]
        if distance[n] >= radius * (1.0 - SETTLED):
            c[n] = trial[n]
            if (step**2).sum() < (SETTLED * radius) ** 2 and np.isfinite(touched[n, 0, 0]):
                going[n] = False
                continue
        elif distance[n] < 0.0:
            trial[n] = c[n] + 0.5 * step
            continue
        slot, most = 0, -1.0
        for m in range(KEPT):
            away = np.sqrt(((touched[n, m] - c[n]) ** 2).sum())
            if away > most:
                slot, most = m, away
        touched[n, slot] = near[n]
        trial[n] = nearest_in_halves(p[n], c[n], touched[n], radius)
    return going


@kernel
def nearest_in_halves(p: np.ndarray, c: np.ndarray, touched: np.ndarray, radius: float) -> np.ndarray:
    """The point (3,) nearest to p that stays, for each touched point q, beyond its plane.

    The plane is across c − q at the distance ``radius`` from q, so that what lies beyond it keeps that distance.
    The shortest move that reaches one, two or three planes and crosses all is the answer; c where none does.
    """
    d = np.empty((KEPT, 3))
    b = np.empty(KEPT)
    used = 0
    for m in range(KEPT):
        if np.isfinite(touched[m, 0]):
            norm = np.sqrt(((c - touched[m]) ** 2).sum())
            d[used] = (c - touched[m]) / norm
            b[used] = min(radius, norm) - (d[used] * (p - touched[m])).sum()  # how far p is short of the plane
            used += 1
    none = -1
    for i in range(used):
        for j in range(none, i):
            for k in range(none, j if j > none else none + 1):
                x, y, z = reach_planes(d, b, i, j, k)
                good = True
                for m in range(used):
                    if not d[m, 0] * x + d[m, 1] * y + d[m, 2] * z >= b[m] - 1e-9 * radius:
                        good = False
                        break
                if good:
                    return p + np.array([x, y, z])
    return c.copy()


@kernel
def reach_planes(d: np.ndarray, b: np.ndarray, i: int, j: int, k: int) -> tuple[float, float, float]:
    """The shortest move that reaches planes i, j and k (-1: none); NaN where one of them would pull, not push."""
    si, sj, sk = b[i], 0.0, 0.0
    if j >= 0:
        ij = (d[i] * d[j]).sum()
        det = 1.0 - ij * ij
        si, sj = (b[i] - ij * b[j]) / det, (b[j] - ij * b[i]) / det
    if k >= 0:
        ik, jk = (d[i] * d[k]).sum(), (d[j] * d[k]).sum()
        det = 1.0 + 2.0 * ij * ik * jk - ij * ij - ik * ik - jk * jk
        si = (b[i] * (1.0 - jk * jk) + b[j] * (ik * jk - ij) + b[k] * (ij * jk - ik)) / det
        sj = (b[i] * (ik * jk - ij) + b[j] * (1.0 - ik * ik) + b[k] * (ij * ik - jk)) / det
        sk = (b[i] * (ij * jk - ik) + b[j] * (ij * ik - jk) + b[k] * (1.0 - ij * ij)) / det
    if not (si >= 0.0 and sj >= 0.0 and sk >= 0.0 and si + sj + sk < math.inf):  # planes that coincide reach no end
        return math.nan, math.nan, math.nan
    x, y, z = si * d[i, 0], si * d[i, 1], si * d[i, 2]
    if j >= 0:
        x, y, z = x + sj * d[j, 0], y + sj * d[j, 1], z + sj * d[j, 2]
    if k >= 0:
        x, y, z = x + sk * d[k, 0], y + sk * d[k, 1], z + sk * d[k, 2]
    return x, y, z
