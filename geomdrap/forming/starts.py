"""Where a fit starts: several starts on a coarse mesh, since a fit from afar may end in a minimum of its own.

A coarse run takes an eighth of the time of a fine one, and errs by some per cent, which leaves its minima near those
of the fine mesh.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import FormingError
from geomdrap.forming.identify import Curves, Identified, Simulate, identify, scales

Array = NDArray[np.float64]
Simulation = Callable[[Mapping[str, float]], Simulate]
"""Values about which masses and steps are sized -> simulation."""

PER_PARAMETER = 8
"""Starts that are looked at for each parameter."""
SPREAD = 10.0
"""They are scattered over this factor up and down from the start that was given."""
FOLLOWED = 5
"""No more than so many of them are followed to their minima, the given one first."""
AGREED = 3
"""So many that came to the same best minimum are enough."""
APART = 4.0
"""Standard deviations by which minima differ that are two."""
ROUGH = 0.01
"""A coarse fit ends where a step would lower its cost by less than this share."""
RIVAL = 4.0
"""Times the cost of the best minimum on the coarse mesh up to which another one is tried on the fine mesh."""
ALIKE = 10.0
"""Rise of χ² up to which two minima fit about as well: three standard deviations of one parameter."""


def minima(simulation: Simulation, measured: Curves, start: Mapping[str, float]) -> list[dict[str, float]]:
    """Values of the minima that fits come to from several starts, the best first; ``start`` if they come to none.

    Those that cost more than `RIVAL` times the best are left out.
    """
    looks = sorted((_look(simulation, measured, values) for values in scattered(start)), key=lambda look: look[0])
    found: list[Identified] = []
    for values in [dict(start), *(values for _, values in looks[: FOLLOWED - 1])]:
        try:
            found.append(identify(simulation(values), measured, values, enough=ROUGH))
        except FormingError:  # a run at its end lacks a reading: not a minimum
            continue
        found.sort(key=lambda one: cost(one.curves, measured))
        if sum(not are_apart(found[0], one) for one in found) >= AGREED:
            break
    kept: list[Identified] = []
    for one in found:
        if all(are_apart(one, other) for other in kept):
            kept.append(one)
    best = cost(kept[0].curves, measured) if kept else 0.0
    chosen = [k.named for k in kept if cost(k.curves, measured) <= RIVAL * best]
    return chosen or [dict(start)]


def _look(simulation: Simulation, measured: Curves, values: dict[str, float]) -> tuple[float, dict[str, float]]:
    """The cost of values, at the common level of their moduli at which it is least, and those values."""
    curves = dict(simulation(values)(values))
    forces = [c for c in curves if c.startswith("force")]
    if forces and _are_all_moduli(values):
        level = _level(curves, measured, forces)
        curves |= {c: level * curves[c] for c in forces}
        values = {name: value * level if name.endswith("modulus") else value for name, value in values.items()}
    return cost(curves, measured), values


def _are_all_moduli(names: Collection[str]) -> bool:
    """Whether forces are proportional to a common factor of the named moduli, and shear does not depend on it."""
    yarns = "fibre-modulus" in names or {"warp-modulus", "weft-modulus"} <= set(names)
    return yarns and "resin-modulus" in names


def _level(curves: Curves, measured: Curves, forces: list[str]) -> float:
    """The factor on forces that makes their residuals least; 1 where there is none."""
    size = scales(measured)
    pairs = [(curves[c] / size[c], measured[c] / size[c]) for c in forces]
    up = sum(float(np.nansum(a * b)) for a, b in pairs)
    down = sum(float(np.nansum(a * a)) for a, _ in pairs)
    return up / down if up > 0.0 and np.isfinite(up / down) else 1.0


def scattered(start: Mapping[str, float]) -> list[dict[str, float]]:
    """Starts around ``start``, evenly in the logarithms (Halton's sequence)."""
    from scipy.stats.qmc import Halton

    count = PER_PARAMETER * len(start)
    rows = Halton(len(start), scramble=False).random(count + 1)[1:]
    return [
        {name: value * SPREAD ** (2.0 * x - 1.0) for (name, value), x in zip(start.items(), row, strict=True)}
        for row in rows
    ]


def cost(curves: Curves, measured: Curves) -> float:
    """The sum of the squares of the residuals over the sizes of the readings; infinite where a run ended early."""
    size, total = scales(measured), 0.0
    for column, values in measured.items():
        used = np.isfinite(values)
        errors = (curves[column][used] - values[used]) / size[column][used]
        total += float(np.sum(errors**2)) if np.all(np.isfinite(errors)) else np.inf
    return total


def are_apart(a: Identified, b: Identified) -> bool:
    """Whether two minima differ by more than what the readings leave open."""
    far = np.abs(np.log(a.values / b.values))
    known = np.minimum(a.sigma / a.values, b.sigma / b.values)
    return bool(np.any(far > np.maximum(APART * known, 0.02)))


def are_alike(best: Identified, other: Identified, measured: Curves) -> bool:
    """Whether ``other`` fits the readings about as well as ``best``, at values of its own."""
    count = sum(int(np.isfinite(v).sum()) for v in measured.values()) - len(best.names)
    least = max(cost(best.curves, measured), 1e-300)
    return are_apart(best, other) and (cost(other.curves, measured) / least - 1.0) * count < ALIKE
