"""How the ply that was measured is believed to lie."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from geomdrap.fishnet.seed import Origin


@dataclass(frozen=True)
class Layup:
    """How the ply is believed to lie: seed, heading (degrees), reference direction, and the pitch (mm) of the model.

    ``project`` allows a seed further from the part than a pitch.
    """

    origin: Origin
    angle: float
    reference: tuple[float, float, float] | None = None
    pitch: float | None = None
    project: bool = True

    def as_meant(self) -> dict[str, str | float | tuple[float, ...]]:
        """Origin, heading and reference as a model file holds them."""
        origin = self.origin
        if isinstance(origin, (int, np.integer)):
            origin = f"vertex:{origin}"
        out: dict[str, str | float | tuple[float, ...]] = {
            "origin": origin if isinstance(origin, str) else tuple(float(x) for x in origin),
            "angle": float(self.angle),
        }
        return out if self.reference is None else {**out, "reference": tuple(float(x) for x in self.reference)}
