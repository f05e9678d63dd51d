"""What changes during a run, and how it is taken a number of steps on."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from geomdrap.forming import membrane
from geomdrap.forming.contact import Tool, packed
from geomdrap.forming.explicit import WORKS, advance
from geomdrap.forming.membrane import WIDTH, WORK_ROWS, membrane_forces
from geomdrap.forming.model import Model
from geomdrap.forming.truss import truss_forces

Array = NDArray[np.float64]


@dataclass(eq=False)
class State:
    """Where a run has come to.

    ``x``, ``v``, ``f`` (3n,): positions mm, velocities half a step before mm/s, forces of the fabric N; ``history``
    of the resin (see `membrane`); ``time`` s; ``works`` (see `explicit`) N mm; ``relaxed`` N mm, dissipated by the
    resin, and ``loss`` N mm/s, the rate of it; ``tools`` packed. ``reaction`` (d, 3) N and ``impulse`` (t, 3) N s are
    those of the last call of `take_steps`: mean force of each driven node on the fabric, momentum from each tool.
    ``flow`` (3n,) mm/s: velocities against which motion is damped. ``before`` (3n,) N: ``f`` a step before; ``load``
    (3n,) N: what acts on the nodes besides.
    """

    x: Array
    v: Array
    f: Array
    history: Array
    works: Array
    tools: Array
    reaction: Array
    impulse: Array
    scratch: Array
    flow: Array
    before: Array
    load: Array
    time: float = 0.0
    relaxed: float = 0.0
    loss: float = 0.0

    @property
    def points(self) -> Array:
        """Positions (n, 3), mm."""
        return self.x.reshape(-1, 3)


def start(model: Model, velocity: Array | None = None, tools: tuple[Tool, ...] = ()) -> State:
    """The state at time 0, at rest or with ``velocity`` (n, 3) mm/s."""
    count, terms = len(model.sheet.points), len(model.keep)
    history = np.zeros((len(model.shape), (6 + 3 * terms) * WIDTH))
    history[:, membrane.LAST11 : membrane.LAST11 + WIDTH] = 1.0
    history[:, membrane.LAST22 : membrane.LAST22 + WIDTH] = 1.0
    state = State(
        x=np.ascontiguousarray(model.sheet.points, dtype=np.float64).ravel().copy(),
        v=np.zeros(3 * count),
        f=np.zeros(3 * count),
        history=history,
        works=np.zeros(WORKS),
        tools=packed(tools),
        reaction=np.zeros((len(model.driven), 3)),
        impulse=np.zeros((len(tools), 3)),
        scratch=np.zeros(WORK_ROWS * WIDTH),
        flow=np.zeros(3 * count),
        before=np.zeros(3 * count),
        load=np.zeros(3 * count),
    )
    add_forces(model, state)
    state.before[:] = state.f
    if velocity is not None:  # half a step before
        state.v[:] = np.ravel(velocity) - 0.5 * model.step * state.f / np.repeat(model.mass, 3)
        state.v.reshape(-1, 3)[model.driven] = 0.0
        state.before[:] = _forces_before(model, state)
    return state


def _forces_before(model: Model, state: State) -> Array:
    """Forces (3n,) N of the fabric a step before ``state``, which moved then as it does now."""
    earlier = replace(
        state, x=state.x - model.step * state.v, f=np.zeros_like(state.f), history=state.history.copy()
    )
    add_forces(model, earlier)
    return earlier.f


def add_forces(model: Model, state: State) -> None:
    """Work out the forces of the fabric at the positions of ``state``, in place."""
    state.f[:] = 0.0
    membrane_forces(
        state.x, state.f, model.corners, model.shape, state.history, model.law, model.keep, model.take, state.scratch
    )
    truss_forces(state.x, state.f, model.ends, model.truss_law, state.scratch)


def take_steps(
    model: Model, state: State, steps: int, target: Array | None = None, load: Array | None = None
) -> None:
    """Take ``steps`` steps, in place; driven nodes go straight to ``target`` (d, 3) mm, or stay.

    ``load`` (n, 3) N acts on the nodes meanwhile; ``state.flow`` is not damped.
    """
    goal = state.points[model.driven] if target is None else np.ascontiguousarray(target, dtype=np.float64)
    state.load[:] = 0.0 if load is None else np.ravel(load)
    state.reaction[:] = 0.0
    state.impulse[:] = 0.0
    advance(
        steps, model.step, model.damping, state.x, state.v, state.f, model.mass, model.free, state.load,
        state.flow,
        model.driven, goal,
        model.corners, model.shape, state.history, model.law, model.keep, model.take, model.ends, model.truss_law,
        state.tools, state.impulse, state.reaction, state.works, state.before,
        state.scratch,
    )  # fmt: skip
    state.reaction /= steps
    state.time += steps * model.step
