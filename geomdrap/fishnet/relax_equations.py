"""Newton's equations of a net on a part, and their solution.

Two unknowns a node, along tangent vectors of the part; the curvature of the part enters by the pressure of the net.
Where whole yarns have a stiffness, the tension of each is one more unknown, since otherwise all nodes of a yarn would
meet each other.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.fishnet.multifrontal import solve
from geomdrap.fishnet.relax_bending import add_bending
from geomdrap.fishnet.relax_energy import chords, derivatives
from geomdrap.fishnet.relax_surface import tangents
from geomdrap.geodesic.compiled import kernel

if TYPE_CHECKING:
    from geomdrap.fishnet.dissection import Fronts
    from geomdrap.fishnet.relax_problem import Problem
    from geomdrap.fishnet.relax_surface import Footing

ROUNDED_OFF = 1e-13  # of the largest stiffness
UNSTRAINED = 1e-6  # a strain: forces count against those that it makes at least


@dataclass(frozen=True, eq=False)
class Equations:
    """Newton's equations.

    ``gradient`` (2n,) and ``blocks`` (n, 5, 2, 2) of the second derivative along the tangent vectors ``bases``
    (n, 3, 2), of each node and those ``AFTER`` it, with bending (n, 7, 2, 2) those ``FURTHER``; ``unrest`` as in
    ``Relaxed``; ``slopes`` (2, 2n) of the strain sums of the two yarns through a node, 0 where whole yarns have no
    stiffness.
    """

    gradient: np.ndarray
    blocks: np.ndarray
    bases: np.ndarray
    unrest: float
    slopes: np.ndarray


def equations_at(problem: Problem, x: np.ndarray, footing: Footing, full: bool) -> Equations:
    """Newton's equations at nodes x (nu, nv, 3)."""
    bases = _bases(problem, footing)
    basis = np.zeros((*x.shape, 2))
    basis[problem.nodes] = bases
    g, h, size = derivatives(
        x, basis, problem.valid, problem.target, problem.rest_u, problem.rest_v, problem.law, full
    )
    if problem.law.bend > 0.0:
        h = np.concatenate((h, np.zeros((*h.shape[:2], 2, 2, 2))), axis=2)
        turning = np.zeros((*x.shape, 3))
        turning[problem.nodes] = footing.turning
        part = problem.on_net(footing.normal), turning, problem.smooth
        add_bending(x, basis, *part, problem.rest_u, problem.rest_v, problem.law.bend, full, g, h, size)
    force, blocks = g[problem.nodes], h[problem.nodes]
    gradient = along_tangents(force, bases, footing.normal, footing.turning, blocks, full)
    for node, first in ((problem.fixed, 0), (problem.guided, 1)):
        held = np.arange(first, 2)
        blocks[problem.number[node], 0, held, held] += 1.0
    left = float(np.linalg.norm(gradient, axis=1).max())
    whole = problem.law.yarn > 0.0
    slopes = _yarn_slopes(problem, x, bases) if whole else np.zeros((2, 2 * len(bases)))
    # a net that nothing strains has forces of rounding only
    least = UNSTRAINED * max(problem.law.piece, problem.law.ratio) / max(problem.rest_u.max(), problem.rest_v.max())
    return Equations(gradient.ravel(), blocks, bases, left / max(float(size.max()), least), slopes)


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


def _yarn_slopes(problem: Problem, x: np.ndarray, bases: np.ndarray) -> np.ndarray:
    """How the sums of strains of the warp and of the weft yarn (2, 2n) through a node change as it moves."""
    slopes = np.zeros((2, 2 * len(bases)))
    for axis, rest in enumerate((problem.rest_u, problem.rest_v)):
        line = chords(x, rest, 1 - axis, axis)
        slope = line[..., :3] / np.where(rest > 0.0, rest, 1.0)[..., None]
        pull = np.zeros(x.shape)
        pull[(np.s_[1:], np.s_[:, 1:])[axis]] += slope
        pull[(np.s_[:-1], np.s_[:, :-1])[axis]] -= slope
        slopes[axis] = np.einsum("nxa,nx->na", bases, pull[problem.nodes]).ravel()
    return slopes


def newton_step(problem: Problem, fronts: Fronts, equations: Equations, damping: float) -> np.ndarray:
    """Damped Newton step (2n,), not finite where the matrix is singular."""
    blocks = equations.blocks.copy()
    stiffness = np.einsum("naa->na", blocks[:, 0])  # a view
    stiffness += (damping + ROUNDED_OFF) * max(float(stiffness.max()), 1e-300)
    soft = 0.5 / problem.law.yarn if problem.law.yarn > 0.0 else 0.0
    step: np.ndarray = solve(
        fronts, problem.nodes, problem.number, blocks, equations.slopes, soft, -equations.gradient
    )
    return step
