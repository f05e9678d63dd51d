"""How a simulated ply lies: where it starts, and every physical effect that acts on it, in one record."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Recipe:
    """All that decides a simulated ply; the defaults are a ply without any effect. mm, deg, 1/mm."""

    start: tuple[float, float] = (0.0, 0.0)
    """Plan point of the seed, mm."""
    angle: float = 0.0
    """Heading of the warp from +x laid into the tangent plane, counter-clockwise from above, deg."""
    extension: tuple[float, float] = (0.0, 0.0)
    """Strain of the warp and weft sides."""
    gradient: tuple[float, float] = (0.0, 0.0)
    """Growth of that strain per mm from the axis through the seed."""
    skew: float = 0.0
    """The weft generator leaves at 90° + skew, deg."""
    curvature: tuple[float, float] = (0.0, 0.0)
    """Geodesic curvature of the warp and weft generators, to the left, 1/mm."""
    kink: tuple[float, float] = (0.0, 0.0)
    """A zone that was pressed later: (distance along the warp generator mm, turn there deg)."""
    slip: float = 0.0
    """Weft sides grow as 1/cos(γ)^slip."""
    offset: float = 0.0
    """Distance of the neutral surface from the tool, mm."""
    ball: float = 0.0
    """Radius of the rolling ball whose closing the ply rests on, mm; 0: none."""
    stiffness: float = 0.0
    """Ratio of shear to tension energy of a relaxed net; 0: no relaxation by it."""
    asymmetry: float = 0.0
    """Shear stiffness (1 ± asymmetry) by the sign of the shear."""
    lock: float = 0.0
    """Locking angle, deg; 0: none."""
    bending: float = 0.0
    """In-plane bending energy of the yarns to their tension energy, (mm)² over the side squared; 0: none."""
    share: float = 0.0
    """Share of the shear beyond ``onset`` that is relieved by slip at the crossings."""
    onset: float = 0.0
    """Shear at which the crossings begin to slip, deg."""
    recovery: float = 0.0
    """Share of the shear that springs back."""
    sag: float = 0.0
    """Deepest sag of the span between the edges under its own weight, mm."""
    swell: float = 0.0
    """Strain by which the part grew about its frame's origin, by heat."""

    @property
    def relaxed(self) -> bool:
        """Whether the net is an energy minimum and not a geometric construction."""
        return self.stiffness > 0.0 or self.lock > 0.0 or self.bending > 0.0 or self.share > 0.0
