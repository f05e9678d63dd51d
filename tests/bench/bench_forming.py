"""What a step of the mechanical model costs: ``python tests/bench/bench_forming.py [--small]``.

The full model (Hencky membrane, six-term relaxation, undulated yarns) on 40 × 40 cells, against the vectorised numpy
version that the tests use as an oracle and, where it is installed, against warp-lang on the CPU with straightforward
kernels. All start alike and must end at the same places to 1e-10 mm. CPU times of one core, in turn, medians. Then a
45° specimen with 200,000 steps, unless ``--small``.
"""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).parents[1] / "forming"))

from numpy_step import NumpyStep

from geomdrap.forming import Cloth, make_model, rectangle, start, take_steps
from geomdrap.forming.coupon import uniaxial

CELLS = 40
ROUNDS = 5
SAME = 1e-10


def timed(action: Callable[[], object]) -> float:
    """CPU seconds of an action."""
    before = time.process_time()
    action()
    return time.process_time() - before


def several(step: Callable[[], None], count: int) -> Callable[[], None]:
    """An action that takes ``count`` steps."""

    def action() -> None:
        for _ in range(count):
            step()

    return action


def contenders(model: object, velocity: np.ndarray) -> dict[str, tuple[Callable[[int], None], Callable[[], np.ndarray]]]:
    """Name -> how it takes n steps, and where its nodes are."""
    state, oracle = start(model, velocity), NumpyStep(model, velocity)
    found = {
        "geomdrap": (lambda n: take_steps(model, state, n), lambda: state.points),
        "numpy": (lambda n: several(oracle.step, n)(), lambda: oracle.x),
    }
    try:
        from warp_step import WarpStep
    except ImportError:
        print("warp-lang is not installed: not compared")
        return found
    rival = WarpStep(model, velocity)
    return {**found, "warp-lang, CPU": (rival.steps, rival.points)}


def main(small: bool) -> None:
    """Print the table."""
    print(f"load {os.getloadavg()[0]:.1f}, {os.cpu_count()} cores")
    model = make_model(rectangle(CELLS, CELLS, 10.0), Cloth())
    nodes = len(model.sheet.points)
    print(f"{nodes} nodes, {len(model.corners)} triangles, {len(model.ends)} pieces of yarn")
    velocity = np.random.default_rng(0).normal(0.0, 500.0, model.sheet.points.shape)
    racers = contenders(model, velocity)
    for steps, _ in racers.values():
        steps(50)
    places = {name: where().copy() for name, (_, where) in racers.items()}
    counts = {"geomdrap": 400, "numpy": 40, "warp-lang, CPU": 200}
    costs: dict[str, list[float]] = {name: [] for name in racers}
    for _ in range(ROUNDS):
        for name, (steps, _) in racers.items():
            costs[name].append(timed(lambda s=steps, n=counts[name]: s(n)) / counts[name])
    ours = float(np.median(costs["geomdrap"]))
    print(f"{'':16} {'us/step':>9} {'M node-steps/s':>15} {'times ours':>11} {'apart after 50 steps, mm':>26}")
    for name, seconds in costs.items():
        cost, apart = float(np.median(seconds)), float(np.abs(places[name] - places["geomdrap"]).max())
        same = "" if apart < SAME else "  NOT THE SAME"
        print(f"{name:16} {1e6 * cost:9.0f} {nodes / cost / 1e6:15.1f} {cost / ours:11.1f} {apart:26.1e}{same}")
    if not small:
        seconds = timed(lambda: uniaxial(Cloth(), 45.0, steps=200_000))
        print(f"45° specimen, 1061 nodes, 200,000 steps: {seconds:.1f} s")


if __name__ == "__main__":
    main("--small" in sys.argv)
