"""Nets of least energy beside one that is at rest, on its nodes and cells.

To first order, for slopes: one Newton step takes the place of a drape and of all the rounds to a new balance. Or at
rest again, which takes a few rounds. For a placement the net goes with its seed as a rigid body first.
"""

from __future__ import annotations

import math
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.fishnet.dissection import dissect
from geomdrap.fishnet.relax import Relaxed, placed, relax
from geomdrap.fishnet.relax_equations import equations_at, newton_step
from geomdrap.fishnet.relax_net import Balance, as_net, frame
from geomdrap.fishnet.relax_problem import law_of, needs_no_hold
from geomdrap.fishnet.relax_surface import stand

if TYPE_CHECKING:
    from geomdrap.fishnet.laid_down import Start
    from geomdrap.fishnet.net import Net
    from geomdrap.fishnet.relax_problem import Problem
    from geomdrap.fishnet.relax_surface import Footing

TAKEN = 0.25  # of the pitch: how far from where a net was laid its nodes and cells serve another one
LAW = {name: None for name in ("shear_stiffness", "locking_angle", "shear_asymmetry", "bending_length")}


def swayed(near: Net, start: Start) -> Net | None:
    """The net that a ply at its ``start`` would have, to first order in how that differs from a net ``near`` at rest.

    Before the effects that act on nets. None where it differs in more than its placement and the law of its fabric,
    or the other net is not one of least energy.
    """
    if near.balance is None or not _alike(near, start):
        return None
    there, footing, _ = _gone_with(near, near.balance, start)
    beside = stepped(near.balance, there, footing)
    return None if beside is None else _of_start(start, near.balance.laid, near.balance.problem, beside)


def taken_along(near: Net, start: Start) -> Net | None:
    """The net of least energy of a ply at its ``start``, on the nodes and cells of a net ``near`` at rest.

    That takes less time than a drape, and what lies at the rim does not change from one net to the next. Before the
    effects that act on nets. None as of ``swayed``, and where the ply lies further than ``TAKEN`` of the pitch from
    where those nodes were laid: others would be on the part.
    """
    if near.balance is None or not _alike(near, start):
        return None
    laid = near.balance.laid
    there, footing, gone = _gone_with(near, near.balance, start)
    if not np.linalg.norm(gone - there.footing.point, axis=1).max() <= TAKEN * laid.pitch:
        return None
    found = relax(there, footing)
    moved = there.on_net(found.footing.point - gone, math.nan)
    return replace(_of_start(start, laid, there, found), moved=moved, balance=Balance(laid, there, found))


def _of_start(start: Start, laid: Net, problem: Problem, found: Relaxed) -> Net:
    """The net of a ply at its ``start``, on the nodes and cells of another that was ``laid``."""
    seed = start.seed
    return replace(
        as_net(replace(laid, fabric=start.fabric), problem, found),
        origin=seed.point,
        origin_face=seed.face,
        warp0=seed.warp,
        weft0=seed.weft,
        normal0=seed.normal,
        angle=start.angle,
    )


def _gone_with(near: Net, rest: Balance, start: Start) -> tuple[Problem, Footing, np.ndarray]:
    """A net ``near`` at ``rest`` gone with its seed to a ``start``, as a rigid body.

    The problem of the ply there, where its nodes stand, and where those (n, 3) of the geometric net have gone.
    """
    laid, problem, found = rest
    # of the rounded part: facets beside each other are at degrees, with which the far end would leave the part
    origins = np.array([laid.origin, near.origin, start.seed.point])
    normals = stand(problem.surface, origins).normal
    warps = laid.warp0, near.warp0, start.seed.warp
    first, before, now = (frame(warp, normal) for warp, normal in zip(warps, normals, strict=True))
    carried = start.seed.point + (np.concatenate((found.footing.point, problem.held)) - near.origin) @ before.T @ now
    there = replace(
        problem,
        law=law_of(start.fabric),
        held=np.array([start.seed.point, carried[-1]]),
        side=np.cross(start.seed.normal, start.seed.warp),
    )
    footing = placed(replace(there, footing=found.footing), there.on_net(carried[:-2], math.nan))
    gone = start.seed.point + (problem.footing.point - laid.origin) @ first.T @ now
    return there, footing, stand(problem.surface, gone, problem.footing.face).point


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


def _alike(near: Net, start: Start) -> bool:
    """Whether a ply differs from a net in its placement and in the size of its stiffness only."""
    one, other = near.fabric, start.fabric
    kinds = [[f.relaxes, needs_no_hold(f), bool(f.bending_length)] for f in (one, other)]
    same = kinds[0] == kinds[1] and replace(one, **LAW) == replace(other, **LAW)  # type: ignore[arg-type]
    return start.part is near.surface and one.relaxes and same
