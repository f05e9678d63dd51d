"""What a comparison of a net with a measurement holds."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from geomdrap.criticism.compare_places import Places
    from geomdrap.criticism.compare_scores import Scores
    from geomdrap.criticism.compare_structure import Structure
    from geomdrap.criticism.compare_trends import Trend
    from geomdrap.fishnet import Net
    from geomdrap.measurement.match import Matched
    from geomdrap.measurement.measurement import Measurement
    from geomdrap.measurement.noise import Noise
    from geomdrap.measurement.outliers import Outlier


@dataclass(frozen=True, eq=False, repr=False)
class Comparison:
    """Measured less predicted, a row for each row of the measurement; NaN where there is no prediction.

    ``vector`` (n, 3) mm is the residual of the position in space, for marks with fabric coordinates; without those
    it is the distance from the nearest point of the part, along its normal. ``parts`` (n, 3) mm are its components
    along warp, weft and normal, oblique where the fabric is sheared: ``vector`` = warp · parts[0] + weft · parts[1] +
    normal · parts[2]. ``shear`` (n,) degrees or None; ``warp_turn``, ``weft_turn`` (n,) degrees, counter-clockwise
    about the normal, -90 to 90, or None. ``trusted`` (n,) are the rows with a prediction and without an outlier. The
    noises are per coordinate (mm), of shear and of the directions of warp and weft (degrees). ``places`` says where
    the rows lie.
    """

    net: Net
    measurement: Measurement
    matched: Matched
    vector: np.ndarray
    parts: np.ndarray
    shear: np.ndarray | None
    warp_turn: np.ndarray | None
    weft_turn: np.ndarray | None
    noise_xyz: Noise
    noise_shear: Noise
    noise_warp: Noise
    noise_weft: Noise
    outliers: tuple[Outlier, ...]
    trusted: np.ndarray
    places: Places
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()

    def __repr__(self) -> str:
        return f"Comparison({self.measurement.source!r}, {self.used.sum()} of {len(self.used)} points)"

    @property
    def used(self) -> np.ndarray:
        """Rows (n,) with a prediction."""
        return self.matched.used

    @property
    def coordinates(self) -> int:
        """Independent components of a position residual: 3 with fabric coordinates, else 1 (the normal)."""
        return 3 if self.measurement.labelled else 1

    @property
    def size(self) -> np.ndarray:
        """Length (n,) mm of the position residuals."""
        return np.asarray(np.linalg.norm(self.vector, axis=1))

    @cached_property
    def scores(self) -> Scores:
        """Root mean squares, noise and chi² per degree of freedom."""
        from geomdrap.criticism.compare_scores import scores_of

        return scores_of(self)

    @cached_property
    def trends(self) -> tuple[Trend, ...]:
        """How the residuals go with shear, distance from the origin, curvature and distance from the rim."""
        from geomdrap.criticism.compare_trends import trends_of

        return trends_of(self)

    @cached_property
    def structure(self) -> Structure:
        """Whether neighbouring residuals are alike."""
        from geomdrap.criticism.compare_structure import structure_of

        return structure_of(self)
