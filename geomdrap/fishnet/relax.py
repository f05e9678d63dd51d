"""Nets of least energy: a fabric that resists shear gives way until stretching and shearing are in balance.

The nodes of the geometric net that have cells move on the part; the seed is held, and the first warp piece keeps its
heading, or a longer stretch if the fabric says so. Newton's method with exact second derivatives, the curvature of
the part among them, in two unknowns a node. A step that does not lower the energy is followed by a second one, which
takes back what that has stretched; if that is in vain it is shortened, then damped (Levenberg). Where Newton's step
leads uphill, over a ridge of the energy, it is turned round. Minimal is the net when the forces along the surface
vanish against those that balance each other.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from geomdrap.fishnet.dissection import dissect
from geomdrap.fishnet.relax_bending import bending_energy
from geomdrap.fishnet.relax_energy import energy
from geomdrap.fishnet.relax_equations import Equations, equations_at, newton_step
from geomdrap.fishnet.relax_surface import Footing, stand

if TYPE_CHECKING:
    from geomdrap.fishnet.dissection import Fronts
    from geomdrap.fishnet.relax_problem import Problem

BALANCED = 1e-6  # of the largest forces at a node: what may be left of them
GOOD_ENOUGH = 1e-3  # beyond, a warning is given
LONGEST_STEP = 1.5  # pieces
LEAST_DAMPING, MOST_DAMPING = 1e-10, 10.0  # of the largest stiffness
ROUNDING = 1e-12
UNEVEN = 1e-6  # of the energy: how much of it facets leave to chance
CLOSE = 0.1  # unrest below which second derivatives are taken in full
PATIENCE = 3  # rounds in which the unrest may fail to halve near the end
AT_THE_END, LAST_ROUNDS = 1e-5, 1  # likewise where facets and rounding are all that is left
IDLE = 8  # rounds in which the unrest may fail to halve and the energy to fall by more than facets leave to chance
ROUNDS = 80
IN_PLANE = 6  # times that a place is moved into a plane and back onto the part, to stand in both
WARY = 5  # rounds without trust after it was in vain


class Place(NamedTuple):
    """Nodes ``x`` (nu, nv, 3) mm, the ``footing`` of the n that move, and their ``energy``."""

    x: np.ndarray
    footing: Footing
    energy: float


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


def placed(problem: Problem, nodes: np.ndarray) -> Footing:
    """Where nodes (nu, nv, 3) mm stand, looked for from the geometric net; seed and heading are where they are held.

    A node that is led astray on a part that folds back is but a worse start.
    """
    x, face = nodes[problem.nodes], problem.footing.face.copy()
    seed, guided = problem.number[problem.fixed], problem.number[problem.guided]
    x[seed] = problem.held[0]
    for _ in range(IN_PLANE):
        off = (x[guided] - problem.held[1]) @ problem.side
        there = stand(problem.surface, x[[guided]] - off * problem.side, face[[guided]])
        x[guided], face[guided] = there.point[0], there.face[0]
    return stand(problem.surface, x, face)


def relax(problem: Problem, footing: Footing, balanced: float = BALANCED) -> Relaxed:
    """Nodes of least energy, from where they stand: ``problem.footing`` is the geometric net.

    ``balanced`` is the share of the largest forces at a node that may be left.
    """
    x = problem.on_net(footing.lifted)
    now, damping, stuck = _energy(problem, x, footing), 0.0, 0
    law = problem.law
    fronts = dissect(problem.number, len(footing.face), law.yarn > 0.0, 2 if law.bend > 0.0 else 1)
    full = False  # far from the end second derivatives need not be positive
    wary = 0  # the round from which on a step that raises the energy is trusted
    best = mark = Relaxed(x, footing, now, math.inf, 0)
    for n in range(ROUNDS):
        equations = equations_at(problem, x, footing, full)
        if equations.unrest < 0.5 * mark.unrest or now < mark.energy * (1.0 - UNEVEN):
            mark = Relaxed(x, footing, now, equations.unrest, n)
        stuck = stuck + 1 if equations.unrest > 0.5 * best.unrest else 0
        if equations.unrest < best.unrest or now < best.energy * (1.0 - UNEVEN):
            best = Relaxed(x, footing, now, equations.unrest, n)
        patience = LAST_ROUNDS if best.unrest < AT_THE_END else PATIENCE
        if best.unrest < balanced or (best.unrest < GOOD_ENOUGH and stuck > patience) or n - mark.rounds > IDLE:
            break
        step = newton_step(problem, fronts, equations, damping)
        downhill = float((equations.gradient * step).sum()) < 0.0  # a BLAS product would wake threads that only spin
        moved = None
        if downhill or damping == 0.0:  # near a ridge of the energy Newton's step leads up to it: away from it, then
            way, place = step if downhill else -step, Place(x, footing, now)
            moved = _searched(problem, fronts, place, equations, way, damping, n >= wary)
            moved = moved if downhill or (moved is not None and moved[0].energy < now) else None
            wary = n + 1 + WARY if moved is None and n >= wary else wary
        if moved is None and damping > MOST_DAMPING:
            break
        if moved is None:
            damping, full = max(30.0 * damping, LEAST_DAMPING), False
            continue
        (x, footing, now), whole, in_vain = moved
        wary = n + 1 + WARY if in_vain else wary
        damping = 0.0 if damping <= LEAST_DAMPING else 0.03 * damping if whole else damping
        full = damping == 0.0 and equations.unrest < CLOSE
    return best


def _energy(problem: Problem, x: np.ndarray, footing: Footing) -> float:
    rests, law = (problem.rest_u, problem.rest_v), problem.law
    total = float(energy(x, problem.valid, problem.target, *rests, law))
    if law.bend > 0.0:
        total += float(bending_energy(x, problem.on_net(footing.normal), problem.smooth, *rests, law.bend))
    return total


def _searched(
    problem: Problem,
    fronts: Fronts,
    place: Place,
    equations: Equations,
    step: np.ndarray,
    damping: float,
    trust: bool,
) -> tuple[Place, bool, bool] | None:
    """Where the longest of a few shares of the step leads that lowers the energy, and whether it is all of it.

    Facets leave the energy a little uneven: near the end, or where the step promises less than that, its slope is
    followed to where it vanishes, and it may rise by a share of ``UNEVEN``.
    A net turns about its seed along circles: a step that is straight stretches it, and the next one takes that back.
    So with ``trust`` a step that raises the energy is followed by another one from where it leads; the last value
    tells that both did in vain.
    """
    way = (equations.bases * step.reshape(-1, 1, 2)).sum(axis=2)
    longest = float(np.linalg.norm(way, axis=1).max())
    if not math.isfinite(longest):
        return None
    share = min(1.0, LONGEST_STEP * float(problem.rest_u.max()) / max(longest, 1e-300))
    whole = share == 1.0
    gain = -0.5 * float((equations.gradient * step).sum())
    in_vain = False
    for _ in range(4):
        there = _moved(problem, place, share * way)
        near = whole and (equations.unrest < GOOD_ENOUGH or gain < UNEVEN * place.energy)
        if there.energy <= place.energy * (1.0 + (UNEVEN if near else ROUNDING)):
            return there, whole, in_vain
        if trust and not in_vain:
            then = equations_at(problem, there.x, there.footing, False)
            second = newton_step(problem, fronts, then, damping)
            back = (then.bases * second.reshape(-1, 1, 2)).sum(axis=2)
            if np.linalg.norm(back, axis=1).max() < LONGEST_STEP * float(problem.rest_u.max()):
                both = _moved(problem, there, back)
                if both.energy < place.energy:
                    return both, whole, False
            in_vain = True
        share, whole = 0.25 * share, False
    return None


def _moved(problem: Problem, place: Place, way: np.ndarray) -> Place:
    """Where steps (n, 3) mm along tangents of the part lead."""
    footing = stand(problem.surface, place.footing.point + way, place.footing.face)
    x = place.x.copy()
    x[problem.nodes] = footing.lifted
    return Place(x, footing, _energy(problem, x, footing))
