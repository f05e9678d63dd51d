"""Explicit central differences: velocities live between the steps, positions and forces on them.

v⁺ = [(1 − αΔt/2) v⁻ + Δt (f/m + α w)] / (1 + αΔt/2), x ← x + Δt v⁺: the damping force −α m (v − w) works against
what differs from the flow w, the even one that the grips impose, or a mean over the recent past. Work is summed up
by the trapezoidal rule along the way, which is exact for this scheme, so that an energy balance shows errors of the
laws and not of the book-keeping.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geomdrap.forming.contact import PX, PY, PZ, VX, VY, VZ, meet
from geomdrap.forming.membrane import membrane_forces
from geomdrap.forming.truss import truss_forces
from geomdrap.geodesic.compiled import kernel

(LOADS, GRIPS, DAMPING, TOOLS, FRICTION, INTERNAL) = range(6)
"""Work: of loads, of grips, lost to damping, of tools, lost to friction, taken up by the fabric (by its forces)."""
WORKS = 6


@kernel
def advance(
    steps: int, step: float, damping: float, x: NDArray, v: NDArray, f: NDArray, mass: NDArray, free: NDArray,
    load: NDArray, flow: NDArray, driven: NDArray, target: NDArray, corners: NDArray, shape: NDArray,
    history: NDArray, law: NDArray, keep: NDArray, take: NDArray, ends: NDArray, truss_law: NDArray, tools: NDArray,
    impulse: NDArray, reaction: NDArray, works: NDArray, before: NDArray, scratch: NDArray,
) -> None:  # fmt: skip
    """Take ``steps`` steps of ``step`` s.

    ``x``, ``v``, ``f`` (3n,): positions, velocities half a step before, forces of the fabric at ``x``; ``load`` (3n,)
    N; ``flow`` (3n,) mm/s: velocities that are not damped; ``driven`` (d,) nodes go straight to ``target`` (d, 3).
    ``reaction`` (d, 3) and ``impulse`` (t, 3): forces of the grips on the fabric summed over the steps, N, and
    momentum from the tools, N s. ``works`` (WORKS,) N mm. ``before`` (3n,): forces before the last step.
    """
    pace = np.empty_like(target)
    for k in range(driven.shape[0]):
        for c in range(3):
            pace[k, c] = (target[k, c] - x[3 * driven[k] + c]) / (steps * step)
    for number in range(steps):
        for t in range(tools.shape[0]):
            tools[t, PX] += step * tools[t, VX]
            tools[t, PY] += step * tools[t, VY]
            tools[t, PZ] += step * tools[t, VZ]
        _move(step, damping, x, v, f, mass, free, load, flow, tools, impulse, works)
        for k in range(driven.shape[0]):
            for c in range(3):
                at = 3 * driven[k] + c
                v[at] = pace[k, c]
                x[at] += step * pace[k, c]
                works[GRIPS] -= 0.5 * step * f[at] * v[at]
                works[INTERNAL] -= 0.5 * step * f[at] * v[at]
        if number == steps - 1:
            before[:] = f
        f[:] = 0.0
        membrane_forces(x, f, corners, shape, history, law, keep, take, scratch)
        truss_forces(x, f, ends, truss_law, scratch)
        half = 0.0
        for at in range(0, x.shape[0], 3):
            half += f[at] * v[at] + f[at + 1] * v[at + 1] + f[at + 2] * v[at + 2]
        works[INTERNAL] -= 0.5 * step * half
        for k in range(driven.shape[0]):
            for c in range(3):
                at = 3 * driven[k] + c
                reaction[k, c] -= f[at]
                works[GRIPS] -= 0.5 * step * f[at] * v[at]


@kernel
def _move(
    step: float, damping: float, x: NDArray, v: NDArray, f: NDArray, mass: NDArray, free: NDArray, load: NDArray,
    flow: NDArray, tools: NDArray, impulse: NDArray, works: NDArray,
) -> None:  # fmt: skip
    """Move the free nodes through a step."""
    slower, scale = 1.0 - 0.5 * damping * step, 1.0 / (1.0 + 0.5 * damping * step)
    internal, loads, lost = 0.0, 0.0, 0.0
    for node in range(mass.shape[0]):
        if not free[node]:
            continue
        # sums of a node first: each addition to a long sum waits for the one before
        into, by, gone, at, lighter = 0.0, 0.0, 0.0, 3 * node, 1.0 / mass[node]
        for c in range(at, at + 3):
            before = v[c]
            pull = (f[c] + load[c]) * lighter + damping * flow[c]
            after = (slower * before + step * pull) * scale
            into += f[c] * after
            by += load[c] * after
            gone += (0.5 * (before + after) - flow[c]) * (before + after)
            v[c] = after
        internal += into
        loads += by
        lost += 0.5 * damping * step * mass[node] * gone
    for t in range(tools.shape[0]):
        _contact(tools[t], step, x, v, f, mass, free, load, impulse[t], works)
    for node in range(mass.shape[0]):
        if free[node]:
            for at in range(3 * node, 3 * node + 3):
                x[at] += step * v[at]
    works[INTERNAL] -= 0.5 * step * internal
    works[LOADS] += step * loads
    works[DAMPING] += lost


@kernel
def _contact(
    tool: NDArray, step: float, x: NDArray, v: NDArray, f: NDArray, mass: NDArray, free: NDArray, load: NDArray,
    impulse: NDArray, works: NDArray,
) -> None:  # fmt: skip
    """Keep the free nodes out of a tool, and book the work that this takes."""
    push, drag = np.empty(3), np.empty(3)
    for node in range(mass.shape[0]):
        if not free[node]:
            continue
        mine = v[3 * node : 3 * node + 3]
        if not meet(tool, x[3 * node : 3 * node + 3], mine, step, push, drag):
            continue
        for c in range(3):
            at, change = 3 * node + c, push[c] + drag[c]
            impulse[c] += mass[node] * change
            middle = mine[c] - 0.5 * change - 0.5 * step * (f[at] + load[at]) / mass[node]  # of before and after
            works[TOOLS] += mass[node] * change * middle
            works[FRICTION] -= mass[node] * drag[c] * (middle - tool[VX + c])
            works[INTERNAL] -= 0.5 * step * f[at] * change
            works[LOADS] += step * load[at] * change
