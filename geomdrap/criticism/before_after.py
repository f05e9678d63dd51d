"""A measurement against the model before and after: the net with its placement fitted, and with all effects."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.criticism.compare import compare_net

if TYPE_CHECKING:
    from collections.abc import Sequence

    from geomdrap.criticism.comparison import Comparison
    from geomdrap.criticism.diagnosis import Diagnosis
    from geomdrap.fishnet import Effect


def before_and_after(diagnosis: Diagnosis) -> tuple[Comparison, Comparison]:
    """Comparisons with the net as it was meant, and with the final model."""
    return _compared(diagnosis, ()), _compared(diagnosis, diagnosis.effects)


def placed(diagnosis: Diagnosis) -> Comparison:
    """The comparison with only the placement of the final model."""
    return _compared(diagnosis, [e for e in diagnosis.effects if e.name == "placement"])


def _compared(diagnosis: Diagnosis, effects: Sequence[Effect]) -> Comparison:
    experiment = diagnosis.experiment
    net = experiment.draped(effects, experiment.pitches[1])
    return compare_net(net, experiment.measurement, **experiment.noise_told())


def difference(first: Comparison, second: Comparison) -> Comparison:
    """What the second model changes: its signature, in place of a residual."""

    def less(a: np.ndarray | None, b: np.ndarray | None) -> np.ndarray | None:
        return None if a is None or b is None else a - b

    return replace(
        first,
        vector=first.vector - second.vector,
        parts=first.parts - second.parts,
        shear=less(first.shear, second.shear),
        warp_turn=less(first.warp_turn, second.warp_turn),
        weft_turn=less(first.weft_turn, second.weft_turn),
        trusted=first.trusted & second.trusted,
    )


def likeness(first: Comparison, signature: Comparison) -> float:
    """Correlation of a residual with a signature, all measured values over their noise; -1 to 1."""
    pairs = []
    for a, b, noise in (
        (first.vector, signature.vector, first.noise_xyz.typical),
        (first.shear, signature.shear, first.noise_shear.typical),
        (first.warp_turn, signature.warp_turn, first.noise_warp.typical),
        (first.weft_turn, signature.weft_turn, first.noise_weft.typical),
    ):
        if a is not None and b is not None and noise:
            rows = signature.trusted
            pairs.append((a[rows].ravel() / noise, b[rows].ravel() / noise))
    x, y = (np.concatenate(side) for side in zip(*pairs, strict=True))
    known = np.isfinite(x) & np.isfinite(y)
    size = float(np.linalg.norm(x[known]) * np.linalg.norm(y[known]))
    return float(x[known] @ y[known] / size) if size > 0.0 else 0.0
