"""How kernels are compiled, in one place.

Divisions follow IEEE rules instead of raising, and products may be fused with sums; both matter for speed, neither
for results beyond the last digits. Kernels let other threads run, so that progress is shown while they work.

``tight`` is for kernels that make no array: without the counting of references that others do at every use of one,
the march takes half the time. It may be called from ``kernel`` and call it, but not take slices to keep.
"""

from __future__ import annotations

from pathlib import Path
from typing import Any

from numba import njit

from geomdrap.geodesic.stale import forget_stale_kernels

PACKAGE = Path(__file__).resolve().parent.parent

forget_stale_kernels(PACKAGE)

RULES: dict[str, Any] = {"cache": True, "error_model": "numpy", "fastmath": {"contract"}}

kernel = njit(**RULES | {"nogil": True, "_nrt": True})
tight = njit(**RULES | {"nogil": True, "_nrt": False})
inlined = njit(**RULES | {"inline": "always"})
