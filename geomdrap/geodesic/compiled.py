"""How kernels are compiled, in one place.

Divisions follow IEEE rules instead of raising, and products may be fused with sums; both matter for speed, neither
for results beyond the last digits.
"""

from __future__ import annotations

import contextlib
import hashlib
from pathlib import Path

from numba import njit

STAMP = "kernels.stamp"
PACKAGE = Path(__file__).resolve().parent.parent


def sources_stamp(package: Path) -> str:
    """What changes when any source of the package does: names, sizes and times of all files."""
    files = sorted(package.rglob("*.py"))
    parts = [f"{f.relative_to(package)} {f.stat().st_size} {f.stat().st_mtime_ns}" for f in files]
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()


def forget_stale_kernels(package: Path) -> int:
    """Delete compiled kernels beside sources that have changed since; how many.

    The compiler's own check looks at the file of a kernel only, not at the files whose kernels it has built in: an
    edited helper would leave the old one at work, silently. Where nothing may be written nothing can have changed.
    """
    place = package / "__pycache__" / STAMP
    stamp = sources_stamp(package)
    with contextlib.suppress(OSError):
        if place.exists() and place.read_text() == stamp:
            return 0
        stale = [f for kind in ("nbi", "nbc") for f in package.rglob(f"__pycache__/*.{kind}")]
        for file in stale:
            file.unlink(missing_ok=True)
        place.parent.mkdir(exist_ok=True)
        place.write_text(stamp)
        return len(stale)
    return 0


forget_stale_kernels(PACKAGE)

kernel = njit(cache=True, error_model="numpy", fastmath={"contract"})
inlined = njit(cache=True, error_model="numpy", fastmath={"contract"}, inline="always")
