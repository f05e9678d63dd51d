"""What a cell costs, against one trace of another tracer: ``python tests/bench/bench_cells.py [--small]``.

CPU time of one core, warm, medians of interleaved runs. The aims: a cell closed (march only) in 0.9 µs and in 0.15
of one potpourri3d trace of the same length on the same mesh; the whole of ``gd.drape`` in 0.25 of it a cell; cost
linear in the cells; at most 200 bytes a node; a million facets prepared within 3 s.
"""

from __future__ import annotations

import importlib
import os
import resource
import statistics
import sys
import time
from collections.abc import Callable

import numpy as np

import geomdrap as gd
from geomdrap.fishnet.grid import Grid
from geomdrap.surface import Surface, shapes

RADIUS = 100.0
SEED = RADIUS * np.array([0.3, 0.45, 0.84]) / np.linalg.norm([0.3, 0.45, 0.84])
ROUNDS = 9


def cpu_us(action: Callable[[], object]) -> float:
    """CPU time of one call, µs."""
    start = time.process_time()
    action()
    return 1e6 * (time.process_time() - start)


def drape(surface: Surface, cells_a_side: int) -> gd.Net:
    """The sphere's net with so many cells a side over |u|, |v| ≤ R."""
    pitch = 2.0 * RADIUS / cells_a_side
    return gd.drape(surface, SEED, 17.0, pitch, (RADIUS, RADIUS), project=True)


class Clock:
    """Adds up the CPU time that ``drape`` spends in the march, and keeps its grid."""

    def __init__(self) -> None:
        self.module = importlib.import_module("geomdrap.fishnet.drape")
        self.spent = 0.0
        self.grid: Grid | None = None
        for name in ("place_seed", "lay_generators", "branch_off", "fill_quadrants", "carry_front_on"):
            if hasattr(self.module, name):
                setattr(self.module, name, self.timed(getattr(self.module, name)))

    def timed(self, kernel: Callable[..., object]) -> Callable[..., object]:
        def call(mesh: object, grid: Grid, *rest: object) -> object:
            self.grid = grid
            start = time.process_time()
            result = kernel(mesh, grid, *rest)
            self.spent += 1e6 * (time.process_time() - start)
            return result

        return call


def traces(surface: Surface, length: float, count: int = 3000) -> Callable[[], object] | None:
    """So many traces by potpourri3d from anywhere, or None where it is not installed."""
    try:
        import potpourri3d
    except ImportError:
        return None
    tracer = potpourri3d.GeodesicTracer(surface.points, surface.triangles)
    rng = np.random.default_rng(0)
    faces = rng.integers(0, len(surface.triangles), count)
    weights = rng.dirichlet(np.ones(3), count)
    turn = rng.uniform(0.0, 2.0 * np.pi, count)[:, None]
    ways = length * (np.cos(turn) * surface.e1[faces] + np.sin(turn) * surface.e2[faces])

    def run() -> None:
        for face, weight, way in zip(faces.tolist(), weights, ways, strict=True):
            tracer.trace_geodesic_from_face(face, weight, way)

    return run


def cells_against_traces(clock: Clock) -> None:
    """The ratios that the design asks for: 81,920 facets, 40,000 cells."""
    surface = shapes.icosphere(RADIUS, 6)
    count = 3000
    run = traces(surface, RADIUS / 100.0, count)
    net = drape(surface, 200)
    cells = int(net.cell_valid.sum())
    march, whole, other = [], [], []
    for _ in range(ROUNDS):
        clock.spent = 0.0
        whole.append(cpu_us(lambda: drape(surface, 200)) / cells)
        march.append(clock.spent / cells)
        if run is not None:
            other.append(cpu_us(run) / count)
    rows = [("a cell closed (march)", march, 0.15), ("a cell, whole gd.drape", whole, 0.25)]
    trace = statistics.median(other) if other else float("nan")
    print(f"{len(surface.triangles):,} facets, {cells:,} cells, side {RADIUS / 100.0:g} mm")
    print(f"  {'one potpourri3d trace':28} {trace:8.3f} µs")
    for name, times, aim in rows:
        middle = statistics.median(times)
        print(f"  {name:28} {middle:8.3f} µs   {middle / trace:6.3f} of a trace (aim {aim})")


def linearity(clock: Clock, sides: tuple[int, ...]) -> None:
    """Cost a cell and memory a node as the net grows on one mesh."""
    surface = shapes.icosphere(RADIUS, 6)
    print(f"{'cells':>12} {'march µs':>10} {'whole µs':>10} {'grid B/node':>12} {'net B/node':>12}")
    for side in sides:
        drape(surface, side)
        march, whole = [], []
        for _ in range(3):
            clock.spent = 0.0
            whole.append(cpu_us(lambda side=side: drape(surface, side)) / side**2)
            march.append(clock.spent / side**2)
        net = drape(surface, side)
        held = {id(a): a.nbytes for a in vars(net).values() if isinstance(a, np.ndarray)}
        grid = sum(a.nbytes for a in clock.grid) if clock.grid is not None else 0
        print(
            f"{side**2:12,} {statistics.median(march):10.3f} {statistics.median(whole):10.3f} "
            f"{grid / net.face.size:12.1f} {sum(held.values()) / net.face.size:12.1f}"
        )


def preparation(facets: int) -> None:
    """Seconds to make a Surface of so many facets, with all that a drape needs of it."""
    sphere = shapes.icosphere(RADIUS, 8)
    points = sphere.points[sphere.triangles[:facets]].reshape(-1, 3)
    triangles = np.arange(len(points)).reshape(-1, 3)

    def prepare() -> None:
        surface = Surface(points, triangles)
        _ = surface.unfolded, surface.areas, surface.require_drapable()

    times = [1e-6 * cpu_us(prepare) for _ in range(3)]
    print(f"{facets:,} facets from loose triangles: {statistics.median(times):.2f} s (aim 3)")


def main() -> None:
    """Print the tables."""
    print(f"load {os.getloadavg()[0]:.1f} on {os.cpu_count()} cores")
    clock = Clock()
    drape(shapes.icosphere(RADIUS, 4), 16)  # compiled
    cells_against_traces(clock)
    linearity(clock, (100, 316, 1000) if "--small" not in sys.argv else (100, 316))
    preparation(1_000_000)
    print(f"most memory held: {resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024:,.0f} MB")


if __name__ == "__main__":
    main()
