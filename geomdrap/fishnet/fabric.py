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

    What the pin-jointed net leaves out, neutral unless an effect sets it: ``strain_warp``, ``strain_weft``, by which
    sides are longer than in the flat fabric, and ``strain_growth_warp``, ``strain_growth_weft``, more strain per mm
    from the axis through the seed; ``curvature_warp``, ``curvature_weft`` of the generators, 1/mm, positive to the
    left; ``slip``, the exponent s with which weft sides grow as 1/cos(γ)^s; ``shear_stiffness`` as a share of the
    yarns' own, ``locking_angle`` degrees, ``shear_asymmetry`` from -1 to 1 and ``bending_length`` mm, the root of the
    yarns' stiffness in bending in the surface over the stiffness in shear, with any of which the net is relaxed to
    least energy (None: it is not); ``held_length``, mm of warp from the seed that then keep their heading (None: one
    piece).
    Raises DrapeError for angles out of range.
    """

    limit_angle: float = 45.0
    weft_angle: float = 90.0
    strain_warp: float = 0.0
    strain_weft: float = 0.0
    strain_growth_warp: float = 0.0
    strain_growth_weft: float = 0.0
    curvature_warp: float = 0.0
    curvature_weft: float = 0.0
    slip: float = 0.0
    shear_stiffness: float | None = None
    locking_angle: float | None = None
    shear_asymmetry: float | None = None
    bending_length: float | None = None
    held_length: float | None = None

    def __post_init__(self) -> None:
        if not (math.isfinite(self.limit_angle) and 0.0 < self.limit_angle <= 90.0):
            raise DrapeError(f"the limit angle must lie between 0 and 90 degrees, not {self.limit_angle}")
        if not (math.isfinite(self.weft_angle) and 10.0 < self.weft_angle < 170.0):
            raise DrapeError(f"the weft must leave at 10 to 170 degrees from the warp, not {self.weft_angle}")

    @property
    def relaxes(self) -> bool:
        """Whether the fabric resists shear or bending, so that its net is one of least energy."""
        given = self.shear_stiffness, self.locking_angle, self.shear_asymmetry, self.bending_length
        return any(value is not None for value in given)

    @property
    def stretches(self) -> bool:
        """Whether its yarn pieces are longer or shorter on the part than in the flat fabric."""
        strains = (self.strain_warp, self.strain_weft, self.strain_growth_warp, self.strain_growth_weft, self.slip)
        return any(strains)

    @property
    def is_geodesic(self) -> bool:
        """Whether its yarns leave the seed at right angles and its generators are geodesics."""
        straight = self.curvature_warp == self.curvature_weft == self.slip == 0.0
        return straight and self.weft_angle == 90.0 and not self.relaxes
