"""How long a surface takes to be made, part by part: ``python tests/bench/bench_surface.py``.

One core, warm (kernels compiled and cached), the best of three. The aim: a million facets within 3 s.
"""

from __future__ import annotations

import os
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

import numpy as np

from geomdrap.surface import Surface, read_surface
from geomdrap.surface.inspection import inspect
from geomdrap.surface.unfold import unfold

REPEATS = 3


def wavy_sheet(facets: int, shuffled: bool) -> np.ndarray:
    """Corners (facets, 3, 3) of a wavy sheet 1 m wide; shuffled as a CAD system would not, the worst case."""
    n = int(np.sqrt(facets / 2.0)) + 1
    x, y = np.meshgrid(np.linspace(0.0, 1000.0, n), np.linspace(0.0, 1000.0, n), indexing="ij")
    points = np.stack([x, y, 50.0 * np.sin(x / 100.0) * np.cos(y / 80.0)], axis=-1).reshape(-1, 3)
    number = np.arange(n * n).reshape(n, n)
    a, b, c, d = number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]
    faces = np.stack([np.stack([a, b, c], axis=-1), np.stack([a, c, d], axis=-1)], axis=2).reshape(-1, 3)
    if shuffled:
        faces = np.random.default_rng(0).permutation(faces)
    return points[faces].astype(np.float32)


def write_stl(path: Path, corners: np.ndarray) -> None:
    """Write a binary STL."""
    records = np.zeros(len(corners), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    records["corners"] = corners
    path.write_bytes(bytes(80) + len(corners).to_bytes(4, "little") + records.tobytes())


def best(action: Callable[[], object]) -> float:
    """Least time of a few runs, s."""
    times = []
    for _ in range(REPEATS):
        start = time.perf_counter()
        action()
        times.append(time.perf_counter() - start)
    return min(times)


def measure(corners: np.ndarray, folder: Path) -> dict[str, float]:
    """Seconds for each step on a soup of corners (m, 3, 3)."""
    soup = corners.reshape(-1, 3).astype(np.float64)
    triangles = np.arange(len(soup)).reshape(-1, 3)
    path = folder / "sheet.stl"
    write_stl(path, corners)
    surface = Surface(soup, triangles)
    arrays = surface.points, surface.triangles, surface.neighbours, surface.neighbour_edge
    queries = np.random.default_rng(1).uniform(0.0, 1000.0, (10_000, 3)) * [1.0, 1.0, 0.05]

    def everything() -> None:
        whole = read_surface(path)
        _ = whole.unfolded, whole.areas, whole.findings

    return {
        "prepare": best(lambda: Surface(soup, triangles)),
        "unfold": best(lambda: unfold(*arrays)),
        "findings": best(lambda: inspect(surface._mesh, surface.areas, ())),
        "all, from file": best(everything),
        "tree": best(lambda: surface.flipped().nearest(queries[:1])),
        "10,000 nearest": best(lambda: surface.nearest(queries)),
    }


def main() -> None:
    """Print a table: seconds for each step, for a few sizes."""
    print(f"load {os.getloadavg()[0]:.1f}, {os.cpu_count()} cores")
    header = None
    with tempfile.TemporaryDirectory() as folder:
        measure(wavy_sheet(1000, False), Path(folder))  # warm
        for facets in (55_000, 250_000, 1_000_000):
            for shuffled in (False, True):
                corners = wavy_sheet(facets, shuffled)
                row = measure(corners, Path(folder))
                if header is None:
                    header = "  ".join(f"{name:>14}" for name in row)
                    print(f"{'facets':>18}  {header}   [s]")
                numbers = "  ".join(f"{seconds:14.3f}" for seconds in row.values())
                print(f"{len(corners):>9,}{' shuffled' if shuffled else '':>9}  {numbers}")


if __name__ == "__main__":
    main()
