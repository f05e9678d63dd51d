"""What a relaxed net costs: ``python tests/bench/bench_relax.py``.

A cap of a sphere with 20,000 facets. CPU time of one core, warm, the least of three runs: of the whole drape, and of
the relaxation in it, a round of which makes, factors and solves Newton's equations. The aim: a net of 5,000 nodes
within 2 s.
"""

from __future__ import annotations

import re
import time

import numpy as np

import geomdrap as gd
from geomdrap.effects import make
from geomdrap.fishnet import Effect
from geomdrap.surface import Surface, shapes

RADIUS = 100.0
CAP = 60.0  # degrees
NODES = 900, 2_000, 5_000, 8_000
LAWS = (
    ("shear-stiffness", {"ratio": 0.003}),
    ("shear-asymmetry", {"alpha": 0.2}),
    ("yarn-bending", {"length": 60.0}),
    ("locking", {"angle": 20.0}),
    ("crossing-slip", {"share": 0.3, "onset": 5.0}),
)


def drape(surface: Surface, pitch: float, effects: list[Effect]) -> tuple[gd.Net, float]:
    """A net and its CPU time, ms."""
    start = time.process_time()
    net = gd.drape(surface, (6.0, -4.0, 99.7), 20.0, pitch, effects=effects, project=True)
    return net, 1e3 * (time.process_time() - start)


def main() -> None:
    """Print the table."""
    surface = shapes.sphere_cap(RADIUS, CAP, 1.8)
    area = 2.0 * np.pi * RADIUS**2 * (1.0 - np.cos(np.radians(CAP)))
    print(f"{len(surface.triangles):,} facets")
    print(f"{'effect':16} {'nodes':>7} {'drape ms':>9} {'relax ms':>9} {'rounds':>7} {'ms/round':>9}")
    for name, values in LAWS:
        for nodes in NODES:
            pitch = float(np.sqrt(area / nodes))
            plain = min(drape(surface, pitch, [])[1] for _ in range(3))
            runs = [drape(surface, pitch, [make(name, **values)]) for _ in range(3)]
            net, whole = min(runs, key=lambda run: run[1])
            rounds = int(re.findall(r"in (\d+) rounds", net.notes[-1])[0])
            count = int((net.face >= 0).sum())
            spent = whole - plain
            print(f"{name:16} {count:7,} {whole:9.0f} {spent:9.0f} {rounds:7} {spent / max(rounds, 1):9.2f}")


if __name__ == "__main__":
    main()
