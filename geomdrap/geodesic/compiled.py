"""How kernels are compiled, in one place.

Divisions follow IEEE rules instead of raising, and products may be fused with sums; both matter for speed, neither
for results beyond the last digits. Kernels let other threads run, so that progress is shown while they work.
"""

from __future__ import annotations

from pathlib import Path

from numba import njit

from geomdrap.geodesic.stale import forget_stale_kernels

PACKAGE = Path(__file__).resolve().parent.parent

forget_stale_kernels(PACKAGE)

kernel = njit(cache=True, nogil=True, error_model="numpy", fastmath={"contract"})
inlined = njit(cache=True, error_model="numpy", fastmath={"contract"}, inline="always")
