"""What is known of the cloth itself."""

from __future__ import annotations

import math
from dataclasses import dataclass

from geomdrap.errors import DrapeError


@dataclass(frozen=True)
class Fabric:
    """A woven fabric.

    ``limit_angle``: shear in degrees beyond which a cell is shown and counted as critical (about 45° for plain
    glass; J. Cao et al., Composites A 39, 2008). ``weft_angle``: degrees from warp to weft in the flat fabric.
    Raises DrapeError for angles out of range.
    """

    limit_angle: float = 45.0
    weft_angle: float = 90.0

    def __post_init__(self) -> None:
        if not (math.isfinite(self.limit_angle) and 0.0 < self.limit_angle <= 90.0):
            raise DrapeError(f"the limit angle must lie between 0 and 90 degrees, not {self.limit_angle}")
        if not (math.isfinite(self.weft_angle) and 10.0 < self.weft_angle < 170.0):
            raise DrapeError(f"the weft must leave at 10 to 170 degrees from the warp, not {self.weft_angle}")
