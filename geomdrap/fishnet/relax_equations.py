"""Newton's equations of a net on a part, and their solution.

Two unknowns a node, along tangent vectors of the part; the curvature of the part enters by the pressure of the net.
Nodes are counted along the shorter side of the net, so that the matrix is a narrow band, and it is factored as such
(Cholesky): where it is not positive definite there is no step. The stiffness of whole yarns is not narrow; where yarns
have one, it stands in rows of its own, and the matrix is factored as a sparse one.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.fishnet.relax_energy import AFTER, derivatives
from geomdrap.fishnet.relax_surface import tangents
from geomdrap.geodesic.compiled import kernel

if TYPE_CHECKING:
    from scipy.sparse import csc_array

    from geomdrap.fishnet.relax import Problem
    from geomdrap.fishnet.relax_surface import Footing

ROUNDED_OFF = 1e-13  # of the largest stiffness


@dataclass(frozen=True, eq=False)
class Equations:
    """Newton's equations.

    ``gradient`` (2n,) and ``blocks`` (n, 5, 2, 2) of the second derivative along the tangent vectors ``bases``
    (n, 3, 2), of each node and those ``AFTER`` it; ``unrest`` as in ``Relaxed``; ``yarns`` (k, 2n) changes of the
    strain sums of k yarns that keep their length; ``full`` where nothing is left out of the second derivative.
    """

    gradient: np.ndarray
    blocks: np.ndarray
    bases: np.ndarray
    unrest: float
    yarns: csc_array | None
    full: bool


def equations_at(problem: Problem, x: np.ndarray, footing: Footing, full: bool) -> Equations:
    """Newton's equations at nodes x (nu, nv, 3)."""
    bases = _bases(problem, footing)
    basis = np.zeros((*x.shape, 2))
    basis[problem.nodes] = bases
    g, h, size = derivatives(
        x, basis, problem.valid, problem.target, problem.rest_u, problem.rest_v, problem.law, full
    )
    blocks = h[problem.nodes]
    gradient = along_tangents(g[problem.nodes], bases, footing.normal, footing.turning, blocks, full)
    for node, first in ((problem.fixed, 0), (problem.guided, 1)):
        held = np.arange(first, 2)
        blocks[problem.number[node], 0, held, held] += 1.0
    left = float(np.linalg.norm(gradient, axis=1).max())
    yarns = _yarn_lengths(problem, x, bases) if problem.law.yarn > 0.0 else None
    return Equations(gradient.ravel(), blocks, bases, left / max(float(size.max()), 1e-300), yarns, full)


def _bases(problem: Problem, footing: Footing) -> np.ndarray:
    """Tangent vectors (n, 3, 2) along which nodes may move: none for the seed, one for the node beside it."""
    toward = np.zeros_like(footing.normal)
    guided = problem.number[problem.guided]
    toward[guided] = np.cross(problem.side, footing.normal[guided])
    bases = tangents(footing.normal, toward)
    bases[guided, :, 1] = 0.0
    bases[problem.number[problem.fixed]] = 0.0
    return bases


@kernel
def along_tangents(
    g: np.ndarray, bases: np.ndarray, normal: np.ndarray, turning: np.ndarray, blocks: np.ndarray, curved: bool
) -> np.ndarray:
    """The gradient g (n, 3) along tangents (n, 2); where ``curved``, the curvature of the part is added to blocks."""
    out = np.zeros((len(g), 2))
    bent = np.zeros((2, 2))
    for n in range(len(g)):
        for a in range(2):
            out[n, a] = g[n, 0] * bases[n, 0, a] + g[n, 1] * bases[n, 1, a] + g[n, 2] * bases[n, 2, a]
        if curved:
            pressure = g[n, 0] * normal[n, 0] + g[n, 1] * normal[n, 1] + g[n, 2] * normal[n, 2]
            for b in range(2):
                bx, by, bz = bases[n, 0, b], bases[n, 1, b], bases[n, 2, b]
                for a in range(2):
                    bent[a, b] = 0.0
                    for r in range(3):
                        turned = turning[n, r, 0] * bx + turning[n, r, 1] * by + turning[n, r, 2] * bz
                        bent[a, b] += bases[n, r, a] * turned
            for a in range(2):
                for b in range(2):
                    blocks[n, 0, a, b] -= pressure * 0.5 * (bent[a, b] + bent[b, a])
    return out


def _yarn_lengths(problem: Problem, x: np.ndarray, bases: np.ndarray) -> csc_array:
    """How the sum of strains of each warp and weft yarn (nv + nu, 2n) changes as the nodes move."""
    from scipy.sparse import csc_array

    i, j = problem.nodes
    rows, values = [], []
    for axis, rest, yarn in ((0, problem.rest_u, j), (1, problem.rest_v, x.shape[1] + i)):
        piece = np.diff(x, axis=axis)
        length = np.linalg.norm(piece, axis=2)
        slope = np.where(rest > 0.0, 1.0 / np.where(rest > 0.0, rest * length, 1.0), 0.0)[..., None] * piece
        pull = np.zeros(x.shape)
        pull[(np.s_[1:], np.s_[:, 1:])[axis]] += slope
        pull[(np.s_[:-1], np.s_[:, :-1])[axis]] -= slope
        rows.append(np.repeat(yarn, 2))
        values.append(np.einsum("nxa,nx->na", bases, pull[problem.nodes]).ravel())
    columns = np.tile(np.arange(2 * len(bases)), 2)
    shape = (x.shape[0] + x.shape[1], 2 * len(bases))
    return csc_array((np.concatenate(values), (np.concatenate(rows), columns)), shape=shape)


def newton_step(problem: Problem, equations: Equations, damping: float) -> np.ndarray | None:
    """Damped Newton step (2n,); None where the matrix is singular or, as a band, not positive definite."""
    stiffest = float(np.einsum("naa->na", equations.blocks[:, 0]).max())
    shift = (damping + ROUNDED_OFF) * max(stiffest, 1e-300)
    if equations.yarns is not None:
        return _sparse_step(problem, equations, shift)
    from scipy.linalg.lapack import dpbtrf, dpbtrs

    band = band_of(problem.nodes[0], problem.nodes[1], problem.number, equations.blocks, problem.width)
    band[:, 0] += shift
    factor, failed = dpbtrf(band.T, lower=1, overwrite_ab=1)
    if failed:
        return None
    step: np.ndarray = dpbtrs(factor, -equations.gradient, lower=1, overwrite_b=1)[0]
    return step


def half_width(number: np.ndarray) -> int:
    """Diagonals below the main one, for nodes of two unknowns numbered (nu, nv), -1 for none."""
    widest = 1
    for di, dj in AFTER[1:]:
        here = number[: number.shape[0] - di, max(-dj, 0) : number.shape[1] - max(dj, 0)]
        there = number[di:, max(dj, 0) : number.shape[1] - max(-dj, 0)]
        both = (here >= 0) & (there >= 0)
        widest = max(widest, 2 * int(np.abs(here - there)[both].max(initial=0)) + 1)
    return widest


@kernel
def band_of(at_i: np.ndarray, at_j: np.ndarray, number: np.ndarray, blocks: np.ndarray, width: int) -> np.ndarray:
    """Lower half of the matrix by diagonals (2n, width + 1): element [k, d] is that of row k + d and column k."""
    band = np.zeros((2 * len(at_i), width + 1))
    for n in range(len(at_i)):
        band[2 * n, 0], band[2 * n + 1, 0] = blocks[n, 0, 0, 0], blocks[n, 0, 1, 1]
        band[2 * n, 1] = blocks[n, 0, 1, 0]
        for k in range(1, len(AFTER)):
            i, j = at_i[n] + AFTER[k][0], at_j[n] + AFTER[k][1]
            if i >= number.shape[0] or j < 0 or j >= number.shape[1]:
                continue
            m = number[i, j]
            if m < 0:
                continue
            for a in range(2):
                for b in range(2):
                    row, column = 2 * n + a, 2 * m + b
                    band[min(row, column), abs(row - column)] = blocks[n, k, a, b]
    return band


def _sparse_step(problem: Problem, equations: Equations, shift: float) -> np.ndarray:
    """The step with the stiffness of whole yarns in rows of its own."""
    from scipy.sparse import block_array, csc_array, diags_array
    from scipy.sparse.linalg import splu

    gradient, yarns = equations.gradient, equations.yarns
    assert yarns is not None
    rows, columns, values = entries_of(*problem.nodes, problem.number, equations.blocks, shift)
    matrix = csc_array((values, (rows, columns)), shape=(len(gradient), len(gradient)))
    soft = diags_array(np.full(yarns.shape[0], -0.5 / problem.law.yarn))
    system = block_array([[matrix, yarns.T], [yarns, soft]], format="csc")
    factors = splu(system, permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options={"SymmetricMode": True})
    right = np.zeros(system.shape[0])
    right[: len(gradient)] = -gradient
    step: np.ndarray = factors.solve(right)[: len(gradient)]
    return step


@kernel
def entries_of(
    at_i: np.ndarray, at_j: np.ndarray, number: np.ndarray, blocks: np.ndarray, shift: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Rows, columns and values of the whole matrix, ``shift`` added to its diagonal."""
    most = 8 * len(AFTER) * len(at_i)
    rows, columns, values = np.empty(most, np.int32), np.empty(most, np.int32), np.empty(most)
    count = 0
    for n in range(len(at_i)):
        for k in range(len(AFTER)):
            i, j = at_i[n] + AFTER[k][0], at_j[n] + AFTER[k][1]
            m = number[i, j] if i < number.shape[0] and 0 <= j < number.shape[1] else -1
            if m < 0:
                continue
            for a in range(2):
                for b in range(2):
                    rows[count], columns[count], values[count] = 2 * n + a, 2 * m + b, blocks[n, k, a, b]
                    if k == 0 and a == b:
                        values[count] += shift
                    count += 1
                    if k > 0:
                        rows[count], columns[count] = 2 * m + b, 2 * n + a
                        values[count] = blocks[n, k, a, b]
                        count += 1
    return rows[:count], columns[:count], values[:count]
