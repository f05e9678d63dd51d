"""Nets of least energy: a fabric that resists shear gives way until stretching and shearing are in balance.

The nodes of the geometric net that have cells move on the part; the seed is held, and the first warp piece keeps its
heading. Newton's method with exact second derivatives, the curvature of the part among them, in two unknowns a node.
A step that does not lower the energy is shortened, then damped (Levenberg). Minimal is the net when the forces along
the surface vanish against those that balance each other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.errors import DrapeError
from geomdrap.fishnet.relax_energy import Law, derivatives, energy
from geomdrap.fishnet.relax_surface import Footing, smooth_normals, stand, tangents

if TYPE_CHECKING:
    from scipy.sparse import csc_array

    from geomdrap.fishnet.fabric import Fabric
    from geomdrap.fishnet.net import Net
    from geomdrap.surface import Surface

DEFAULT_RATIO = 0.003  # shear stiffness where only its asymmetry is given
SOFT_RATIO = 1e-3  # shear stiffness where only a locking angle is given: with none, many nets are minimal
LOCK_STIFFNESS = 1.0  # of the yarns: resistance to shear beyond the locking angle
BALANCED = 1e-6  # of the largest forces at a node: what may be left of them
GOOD_ENOUGH = 1e-3  # beyond, a warning is given
LONGEST_STEP = 1.5  # pieces
LEAST_DAMPING, MOST_DAMPING = 1e-10, 10.0  # of the largest stiffness
ROUNDING = 1e-12
UNEVEN = 1e-6  # of the energy: how much of it facets leave to chance
CLOSE = 0.1  # unrest below which second derivatives are taken in full
PATIENCE = 3  # rounds in which the unrest may fail to halve near the end
ROUNDS = 80


@dataclass(frozen=True, eq=False)
class Problem:
    """What is held fixed while a net relaxes; arrays as in ``relax_energy``.

    ``x0`` (nu, nv, 3) is the geometric net, ``number`` (nu, nv) of the nodes that move, -1 for others; ``fixed`` node
    and ``guided`` node, which moves only in the plane through the seed across ``side``, and where they are, ``held``
    (2, 3) mm.
    """

    surface: Surface
    corner_normals: np.ndarray
    valid: np.ndarray
    target: np.ndarray
    x0: np.ndarray
    rest_u: np.ndarray
    rest_v: np.ndarray
    law: Law
    number: np.ndarray
    fixed: tuple[int, int]
    guided: tuple[int, int]
    held: np.ndarray
    side: np.ndarray


@dataclass(frozen=True, eq=False)
class Relaxed:
    """Where nodes have come to rest.

    ``x`` (nu, nv, 3) mm, ``footing`` of the n that move, ``energy``, and ``unrest``: the largest tangential force
    that is left at a node over the largest sum of forces at a node.
    """

    x: np.ndarray
    footing: Footing
    energy: float
    unrest: float
    rounds: int


def law_of(fabric: Fabric) -> Law:
    """The energy of a fabric; where no stiffness is given it is as small as the rest allows."""
    given = fabric.shear_stiffness
    default = DEFAULT_RATIO if fabric.shear_asymmetry else SOFT_RATIO
    angle = fabric.locking_angle
    return Law(
        ratio=default if given is None else given,
        alpha=fabric.shear_asymmetry or 0.0,
        lock=0.0 if angle is None else LOCK_STIFFNESS,
        lock_sine=1.0 if angle is None else math.sin(math.radians(angle)),
    )


def pose(net: Net, law: Law) -> Problem:
    """The problem of relaxing a net under a law. Raises DrapeError where the seed has no cell beside it."""
    lattice, valid = net.lattice, net.lattice_valid
    moves = np.zeros(net.face.shape, bool)
    for corner in (np.s_[:-1, :-1], np.s_[1:, :-1], np.s_[1:, 1:], np.s_[:-1, 1:]):
        moves[corner] |= valid
    warp, weft = np.zeros(lattice[1:, :, 0].shape, bool), np.zeros(lattice[:, 1:, 0].shape, bool)
    warp[:, :-1] |= valid
    warp[:, 1:] |= valid
    weft[:-1] |= valid
    weft[1:] |= valid
    i, j = int(np.abs(net.u).argmin()), int(np.abs(net.v).argmin())
    beside = [k for k in (i + 1, i - 1) if 0 <= k < len(net.u) and warp[min(i, k), j]]
    if not beside:
        raise DrapeError("the seed has no cell beside it from which a net could relax; move it away from the rim")
    number = np.full(moves.shape, -1)
    number[moves] = np.arange(moves.sum())
    surface = net.surface.lidded
    normals = smooth_normals(surface.triangles, surface.normals, surface.corner_angles, len(surface.points))
    x = np.full(lattice.shape, np.nan)
    x[moves] = stand(surface, normals, lattice[moves]).lifted
    return Problem(
        surface=surface,
        corner_normals=normals,
        valid=valid,
        target=np.zeros((*valid.shape, 2, 2)),
        x0=x,
        rest_u=np.where(warp, np.linalg.norm(np.diff(x, axis=0), axis=2), 0.0),
        rest_v=np.where(weft, np.linalg.norm(np.diff(x, axis=1), axis=2), 0.0),
        law=law,
        number=number,
        fixed=(i, j),
        guided=(beside[0], j),
        held=lattice[[i, beside[0]], j],
        side=np.cross(net.normal0, net.warp0),
    )


def relax(problem: Problem, start: np.ndarray) -> Relaxed:
    """Nodes of least energy, from ``start`` (nu, nv, 3) mm."""
    moves = problem.number >= 0
    x = np.where(moves[..., None], start, 0.0)
    for node, place in zip((problem.fixed, problem.guided), problem.held, strict=True):
        x[node] = place
    footing = stand(problem.surface, problem.corner_normals, x[moves])
    x[moves] = footing.lifted
    now, damping, stuck = _energy(problem, x), 0.0, 0
    full = False  # far from the end second derivatives need not be positive
    best = Relaxed(x, footing, now, math.inf, 0)
    for n in range(ROUNDS):
        equations = _equations(problem, x, footing, full)
        stuck = stuck + 1 if equations.unrest > 0.5 * best.unrest else 0
        if equations.unrest < best.unrest or now < best.energy * (1.0 - UNEVEN):
            best = Relaxed(x, footing, now, equations.unrest, n)
        if best.unrest < BALANCED or (best.unrest < GOOD_ENOUGH and stuck > PATIENCE):
            break
        step = _solve(problem, equations, damping)
        moved = _searched(problem, x, footing, equations, step, now) if equations.gradient @ step < 0.0 else None
        if moved is None and damping > MOST_DAMPING:
            break
        if moved is None:
            damping, full = max(30.0 * damping, LEAST_DAMPING), False
            continue
        x, footing, now, whole = moved
        damping = 0.0 if damping <= LEAST_DAMPING else 0.03 * damping if whole else damping
        full = damping == 0.0 and equations.unrest < CLOSE
    return best


def _energy(problem: Problem, x: np.ndarray) -> float:
    return float(energy(x, problem.valid, problem.target, problem.rest_u, problem.rest_v, problem.law))


@dataclass(frozen=True, eq=False)
class Equations:
    """Newton's equations.

    ``gradient`` (2n,) and ``matrix`` (2n, 2n) along the tangent vectors ``bases`` (n, 3, 2); ``unrest`` as in
    ``Relaxed``; ``yarns`` (k, 2n) changes of the strain sums of k yarns that keep their length.
    """

    gradient: np.ndarray
    matrix: csc_array
    bases: np.ndarray
    unrest: float
    yarns: csc_array | None


def _equations(problem: Problem, x: np.ndarray, footing: Footing, full: bool) -> Equations:
    """Newton's equations at nodes x (nu, nv, 3)."""
    from scipy.sparse import csc_array

    moves = problem.number >= 0
    bases = _bases(problem, footing)
    basis = np.zeros((*moves.shape, 3, 2))
    basis[moves] = bases
    g, h, size = derivatives(
        x, basis, problem.valid, problem.target, problem.rest_u, problem.rest_v, problem.law, full
    )
    gradient = np.einsum("nxa,nx->na", bases, g[moves]).ravel()
    bending = np.einsum("nxa,nxy,nyb->nab", bases, footing.turning, bases)
    if full:
        pressure = (g[moves] * footing.normal).sum(axis=1)
        h[moves, 1, 1] -= pressure[:, None, None] * 0.5 * (bending + bending.swapaxes(1, 2))
    rows, columns, values = _entries(problem.number, h)
    for node, first in ((problem.fixed, 0), (problem.guided, 1)):
        at = 2 * problem.number[node] + np.arange(first, 2)
        rows, columns, values = np.append(rows, at), np.append(columns, at), np.append(values, np.full(len(at), 1.0))
    n = 2 * len(bases)
    left = float(np.linalg.norm(gradient.reshape(-1, 2), axis=1).max())
    matrix = csc_array((values, (rows, columns)), shape=(n, n))
    yarns = _yarn_lengths(problem, x, bases) if problem.law.yarn > 0.0 else None
    return Equations(gradient, matrix, bases, left / max(float(size.max()), 1e-300), yarns)


def _yarn_lengths(problem: Problem, x: np.ndarray, bases: np.ndarray) -> csc_array:
    """How the sum of strains of each warp and weft yarn (nv + nu, 2n) changes as the nodes move."""
    from scipy.sparse import csc_array

    moves = problem.number >= 0
    i, j = np.nonzero(moves)
    rows, values = [], []
    for axis, rest, yarn in ((0, problem.rest_u, j), (1, problem.rest_v, len(moves[0]) + i)):
        piece = np.diff(x, axis=axis)
        length = np.linalg.norm(piece, axis=2)
        slope = np.where(rest > 0.0, 1.0 / np.where(rest > 0.0, rest * length, 1.0), 0.0)[..., None] * piece
        pull = np.zeros(x.shape)
        pull[(np.s_[1:], np.s_[:, 1:])[axis]] += slope
        pull[(np.s_[:-1], np.s_[:, :-1])[axis]] -= slope
        rows.append(np.repeat(yarn, 2))
        values.append(np.einsum("nxa,nx->na", bases, pull[moves]).ravel())
    columns = np.tile(np.arange(2 * len(bases)), 2)
    return csc_array(
        (np.concatenate(values), (np.concatenate(rows), columns)), shape=(sum(moves.shape), 2 * len(bases))
    )


def _bases(problem: Problem, footing: Footing) -> np.ndarray:
    """Tangent vectors (n, 3, 2) along which nodes may move: none for the seed, one for the node beside it."""
    toward = np.eye(3)[np.abs(footing.normal).argmin(axis=1)]
    guided = problem.number[problem.guided]
    toward[guided] = np.cross(problem.side, footing.normal[guided])
    bases = tangents(footing.normal, toward)
    bases[guided, :, 1] = 0.0
    bases[problem.number[problem.fixed]] = 0.0
    return bases


def _entries(number: np.ndarray, h: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rows, columns and values of the sparse second derivative."""
    here = np.argwhere(number >= 0)
    rows, columns, values = [], [], []
    for di in (-1, 0, 1):
        for dj in (-1, 0, 1):
            k, m = here[:, 0] + di, here[:, 1] + dj
            ok = (k >= 0) & (m >= 0) & (k < number.shape[0]) & (m < number.shape[1])
            ok[ok] = number[k[ok], m[ok]] >= 0
            i, j = here[ok].T
            a, b = np.divmod(np.arange(4), 2)
            rows.append((2 * number[i, j][:, None] + a).ravel())
            columns.append((2 * number[k[ok], m[ok]][:, None] + b).ravel())
            values.append(h[i, j, di + 1, dj + 1].reshape(-1))
    return np.concatenate(rows), np.concatenate(columns), np.concatenate(values)


def _solve(problem: Problem, equations: Equations, damping: float) -> np.ndarray:
    """Damped Newton step (2n,); the stiffness of whole yarns stands in rows of its own, since it is dense."""
    from scipy.sparse import block_array, diags_array
    from scipy.sparse.linalg import splu

    matrix, gradient, yarns = equations.matrix, equations.gradient, equations.yarns
    shift = (damping + 1e-13) * max(float(matrix.diagonal().max()), 1e-300)
    system = (matrix + diags_array(np.full(len(gradient), shift))).tocsc()
    if yarns is not None:
        soft = diags_array(np.full(yarns.shape[0], -0.5 / problem.law.yarn))
        system = block_array([[system, yarns.T], [yarns, soft]], format="csc")
    factors = splu(system, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    right = np.zeros(system.shape[0])
    right[: len(gradient)] = -gradient
    step: np.ndarray = factors.solve(right)[: len(gradient)]
    return step


def _searched(
    problem: Problem, x: np.ndarray, footing: Footing, equations: Equations, step: np.ndarray, now: float
) -> tuple[np.ndarray, Footing, float, bool] | None:
    """Nodes after the longest of a few shares of the step that lowers the energy, and whether it is all of it.

    Facets leave the energy a little uneven: near the end, where its slope is followed to where it vanishes, it may
    rise by a share of ``UNEVEN``.
    """
    moves = problem.number >= 0
    way = np.einsum("nxa,na->nx", equations.bases, step.reshape(-1, 2))
    longest = float(np.linalg.norm(way, axis=1).max())
    if not math.isfinite(longest):
        return None
    share = min(1.0, LONGEST_STEP * float(problem.rest_u.max()) / max(longest, 1e-300))
    whole = share == 1.0
    for _ in range(4):
        moved = stand(problem.surface, problem.corner_normals, footing.point + share * way, footing)
        y = x.copy()
        y[moves] = moved.lifted
        then = _energy(problem, y)
        near = whole and equations.unrest < GOOD_ENOUGH
        if then <= now * (1.0 + (UNEVEN if near else ROUNDING)):
            return y, moved, then, whole
        share, whole = 0.25 * share, False
    return None
