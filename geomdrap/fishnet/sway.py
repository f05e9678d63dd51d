"""Nets of least energy beside one that is at rest: to first order, for slopes.

One Newton step on the nodes and cells of the net at rest takes the place of a drape and of all the rounds to a new
balance. For a placement the net goes with its seed as a rigid body first, so that the step is small.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.fishnet.dissection import dissect
from geomdrap.fishnet.relax import Relaxed, placed
from geomdrap.fishnet.relax_equations import equations_at, newton_step
from geomdrap.fishnet.relax_net import as_net, frame
from geomdrap.fishnet.relax_problem import law_of, needs_no_hold
from geomdrap.fishnet.relax_surface import stand

if TYPE_CHECKING:
    from geomdrap.fishnet.fabric import Fabric
    from geomdrap.fishnet.laid_down import Start
    from geomdrap.fishnet.net import Net
    from geomdrap.fishnet.relax_net import Balance
    from geomdrap.fishnet.relax_problem import Problem
    from geomdrap.fishnet.relax_surface import Footing

LAW = {name: None for name in ("shear_stiffness", "locking_angle", "shear_asymmetry", "bending_length")}


def swayed(near: Net, start: Start) -> Net | None:
    """The net that a ply at its ``start`` would have, to first order in how that differs from a net ``near`` at rest.

    Before the effects that act on nets. None where it differs in more than its placement and the law of its fabric,
    or the other net is not one of least energy.
    """
    if near.balance is None or start.part is not near.surface or not _alike(start.fabric, near.fabric):
        return None
    laid, problem, found = near.balance
    # of the rounded part: facets beside each other are at degrees, with which the far end would leave the part
    normals = stand(problem.surface, np.array([laid.origin, start.seed.point])).normal
    turn = frame(laid.warp0, normals[0]).T @ frame(start.seed.warp, normals[1])
    carried = start.seed.point + (np.concatenate((found.footing.point, problem.held)) - laid.origin) @ turn
    there = replace(
        problem,
        law=law_of(start.fabric),
        held=np.array([start.seed.point, carried[-1]]),
        side=np.cross(start.seed.normal, start.seed.warp),
        footing=found.footing,
    )
    beside = stepped(near.balance, there, placed(there, there.on_net(carried[:-2], math.nan)))
    return None if beside is None else as_net(replace(laid, fabric=start.fabric), problem, beside)


def stepped(rest: Balance, there: Problem, footing: Footing, full: bool = True) -> Relaxed | None:
    """Where one Newton step leads under another problem ``there``, on the nodes and cells of a net at ``rest``.

    It begins at ``footing``. ``full``: with all second derivatives, not only those that cannot be negative. None
    where no step can be made.
    """
    _, problem, found = rest
    x = found.x.copy()
    x[problem.nodes] = footing.lifted
    at_rest = equations_at(problem, found.x, found.footing, full)
    moved = equations_at(there, x, footing, full)
    # what is left of the forces where the other net came to rest is none of the difference
    moved = replace(moved, gradient=moved.gradient - at_rest.gradient)
    fronts = dissect(problem.number, len(footing.face), there.law.yarn > 0.0, 2 if there.law.bend > 0.0 else 1)
    step = newton_step(there, fronts, moved, 0.0)
    if not np.isfinite(step).all():
        return None
    way = (moved.bases * step.reshape(-1, 1, 2)).sum(axis=2)
    footing = stand(there.surface, footing.point + way, footing.face)
    x[problem.nodes] = footing.lifted
    return Relaxed(x, footing, math.nan, found.unrest, 1)


def _alike(one: Fabric, other: Fabric) -> bool:
    """Whether fabrics differ in the size of their stiffness only."""
    kinds = [[f.relaxes, needs_no_hold(f), bool(f.bending_length)] for f in (one, other)]
    return kinds[0] == kinds[1] and one.relaxes and replace(one, **LAW) == replace(other, **LAW)  # type: ignore[arg-type]
