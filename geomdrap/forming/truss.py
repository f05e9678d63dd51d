"""Forces of the yarns: pin-jointed trusses between crossings, many at a time.

N = S₀ σ(ε) with ε = ln(l/L₀) and the section S₀ kept; the law is that of `fibre_law`. Blocks as in `membrane`.
"""

from __future__ import annotations

import math

from numpy.typing import NDArray

from geomdrap.forming.elementary import exp_of_negative, ln
from geomdrap.forming.membrane import WIDTH
from geomdrap.geodesic.compiled import kernel

LAW_ROWS = 5
(PER_LENGTH, STIFFNESS, UNDULATION, PER_UNDULATION, PUSH) = (WIDTH * row for row in range(LAW_ROWS))
"""Rows of a block's law: 1/L₀, Ē S₀ N, ε_sh, 1/ε_sh (0 where there is none), the share of Ē in compression."""

(X, Y, Z, TENSION) = (WIDTH * row for row in range(4))
TRUSS_ROWS = 4


@kernel
def truss_forces(x: NDArray, f: NDArray, ends: NDArray, law: NDArray, work: NDArray) -> None:
    """Add the forces of the yarns at ``x`` (3n,) mm to ``f`` (3n,) N.

    ``ends`` (m, 2) node numbers; ``law`` (blocks, LAW_ROWS × WIDTH); ``work`` scratch, TRUSS_ROWS × WIDTH or more.
    """
    for block in range(law.shape[0]):
        first = block * WIDTH
        count = min(WIDTH, ends.shape[0] - first)
        for u in range(WIDTH):
            t = first + min(u, count - 1)
            i, j = 3 * ends[t, 0], 3 * ends[t, 1]
            work[X + u] = x[j] - x[i]
            work[Y + u] = x[j + 1] - x[i + 1]
            work[Z + u] = x[j + 2] - x[i + 2]
        tensions(work, law[block])
        for u in range(count):
            i, j = 3 * ends[first + u, 0], 3 * ends[first + u, 1]
            for k in range(3):
                force = work[X + k * WIDTH + u]
                f[i + k] += force
                f[j + k] -= force


@kernel
def tensions(w: NDArray, p: NDArray) -> None:
    """Turn the vectors from first to second end into the forces on the first."""
    for u in range(WIDTH):
        length = math.sqrt(w[X + u] * w[X + u] + w[Y + u] * w[Y + u] + w[Z + u] * w[Z + u])
        strain = ln(length * p[PER_LENGTH + u])
        up = strain if strain > 0.0 else 0.0
        slack = p[UNDULATION + u] * (1.0 - exp_of_negative(-up * p[PER_UNDULATION + u]))
        share = strain - slack if strain > 0.0 else p[PUSH + u] * strain
        w[TENSION + u] = p[STIFFNESS + u] * share / length
    for u in range(WIDTH):
        w[X + u] *= w[TENSION + u]
        w[Y + u] *= w[TENSION + u]
        w[Z + u] *= w[TENSION + u]
