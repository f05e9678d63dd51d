"""A run in slow motion: grips that move at a given pace, frames on the way, and an end with a reason."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geomdrap.forming.ledger import Ledger, book_resin_loss, ledger_of
from geomdrap.forming.model import Model
from geomdrap.forming.state import State, start, take_steps

Array = NDArray[np.float64]
Path = Callable[[float], Array]
"""Time s -> positions (d, 3) mm of the driven nodes."""

CHUNK = 50
"""Steps between two looks at the energies."""
RUNAWAY = 0.5
"""Share of all energy that may be unaccounted for before a run counts as diverged."""


@dataclass(frozen=True, eq=False)
class Frame:
    """A moment of a run.

    ``time`` s; ``points`` (n, 3) mm; ``reaction`` (d, 3) N: force of each driven node on the fabric, a mean over the
    time from half a frame before to half a frame after, which levels the vibrations; ``ledger`` of the energies.
    """

    time: float
    points: Array
    reaction: Array
    ledger: Ledger


@dataclass(frozen=True, eq=False)
class Run:
    """Frames of a run, the first at rest; ``stopped``: a sentence if it ended before its time, else empty."""

    model: Model
    frames: tuple[Frame, ...]
    final: State
    stopped: str

    @property
    def balance_error(self) -> float:
        """The largest share of energy that was unaccounted for in any frame."""
        return max((f.ledger.balance_error(self.frames[0].ledger) for f in self.frames[1:]), default=0.0)


def drive(
    model: Model,
    path: Path,
    steps: int,
    frames: int,
    flow: Array | None = None,
    progress: Callable[[float], None] | None = None,
    memory: float = math.inf,
) -> Run:
    """Lead the driven nodes along ``path`` for ``frames`` frames of ``steps`` / ``frames`` steps.

    With ``flow`` (n, 3) mm/s all nodes start so, and damping acts on what differs from it. The flow follows the nodes
    with ``memory`` s: slow motion is not held back then, and vibrations are. The path is followed
    straight within chunks of steps, and half a frame beyond the end, for the mean of the last one. A run that
    diverges stops; it keeps the frames before, and says where and when.
    """
    half = max(1, round(0.5 * steps / frames))
    state = start(model, flow)
    if flow is not None:
        state.flow[:] = np.ravel(flow)
    rest = Frame(0.0, state.points.copy(), np.zeros_like(state.reaction), ledger_of(model, state))
    done, waiting = [rest], None
    for number in range(2 * frames + 1):
        mean, fault = _lead(model, state, path, half, rest.ledger, memory)
        if fault:
            return Run(model, tuple(done), state, f"{fault}; what came before is kept")
        if waiting is not None and number % 2 == 0:
            done.append(_averaged(waiting, mean))
        if number % 2 == 1:
            waiting = Frame(state.time, state.points.copy(), mean, ledger_of(model, state))
        if progress:
            progress((number + 1) / (2 * frames + 1))
    return Run(model, tuple(done), state, "")


def _averaged(frame: Frame, after: Array) -> Frame:
    return Frame(frame.time, frame.points, 0.5 * (frame.reaction + after), frame.ledger)


def _lead(model: Model, state: State, path: Path, steps: int, rest: Ledger, memory: float) -> tuple[Array, str]:
    """Take ``steps`` steps along ``path``; the mean reaction (d, 3) N and what went wrong, if anything."""
    total, left = np.zeros_like(state.reaction), steps
    while left:
        now = min(left, CHUNK)
        left -= now
        before = state.x.copy()
        take_steps(model, state, now, path(state.time + now * model.step))
        _follow(state, before, now * model.step, memory)
        book_resin_loss(model, state, now * model.step)
        total += now * state.reaction
        fault = divergence(model, state, rest)
        if fault:
            return total / steps, fault
    return total / steps, ""


def _follow(state: State, before: Array, duration: float, memory: float) -> None:
    """Let the flow forget what it was, for the mean velocity since the nodes were at ``before`` (3n,) mm."""
    mean = (state.x - before) / duration
    state.flow += (mean - state.flow) * -math.expm1(-duration / memory)


def divergence(model: Model, state: State, rest: Ledger) -> str:
    """A sentence on where and when a run that began at ``rest`` has diverged; empty if it has not."""
    if np.isfinite(state.x).all() and ledger_of(model, state).balance_error(rest) <= RUNAWAY:
        return ""
    speed = np.linalg.norm(state.v.reshape(-1, 3), axis=1)
    wild = np.where(np.isfinite(speed) & model.free, speed, np.where(model.free, np.inf, 0.0))
    u, v = model.sheet.fabric[int(np.argmax(wild))]
    return f"the run diverged at {state.time:.4g} s, near u = {u:.4g}, v = {v:.4g} mm of the fabric"
