"""The grid of marks that was drawn on the flat fabric, read from the marks' own coordinates."""

from __future__ import annotations

import math

import numpy as np

ALIKE = 0.02  # of the spacing: marks drawn by hand stray by less


def mark_spacing(values: np.ndarray | None) -> float | None:
    """Spacing in mm of the marks along one axis from their coordinates (n,), None where they lie on no grid."""
    if values is None or len(values) == 0:
        return None
    levels = np.unique(np.round(values, 6))
    steps = np.diff(levels)
    steps = steps[steps > ALIKE * float(np.ptp(levels)) / len(levels)] if len(steps) else steps
    if len(steps) < 2:
        return None
    spacing = float(steps.min())
    whole = np.round(steps / spacing)
    strays = np.abs(steps / spacing - whole).max() > ALIKE * max(1.0, float(whole.max()))
    if strays or len(levels) > 0.5 * len(values) + 2:
        return None
    return float(steps.sum() / whole.sum())


def pitch_for_marks(spacing: float | None, wanted: float) -> float:
    """A pitch of ``wanted`` mm down to half of it that divides the spacing of the marks, so that they lie on nodes.

    Of marks closer than that, every so-many-th lies on a node.
    """
    if spacing is None:
        return wanted
    if spacing < wanted:
        return spacing * math.floor(wanted / spacing + 1e-9)
    return spacing / math.ceil(spacing / wanted - 1e-9)
