"""The neutral surface of the fabric lies beside that of the tool."""

from __future__ import annotations

from geomdrap.effects.parallel import parallel_surface
from geomdrap.fishnet import Effect, Parameter
from geomdrap.surface import Surface


class Thickness(Effect):
    """The net is draped on the parallel surface."""

    name = "thickness"
    summary = "The neutral surface of the fabric lies at a distance from the tool."
    equation = "x → x + offset·normal(x)"
    physics = (
        "A ply has a thickness, and those under it as well: its middle lies half a thickness, or several, off the "
        "tool. On the parallel surface radii are larger or smaller by the offset, and with them the shear. Positive "
        "is the side to which the part's normal points, where the ply lies."
    )
    source = "parallel surfaces, M. do Carmo, Differential Geometry of Curves and Surfaces, 3.5"
    stage = "surface"
    seen_by = "positions measured in the frame of the tool; angles weakly"
    confounded_with = ("bridging",)
    rank = 20.0
    parameters = (Parameter("offset", "mm", -50.0, 50.0, 1.0, 0.0, "distance along the part's normal"),)

    def on_surface(self, surface: Surface) -> Surface:
        """The parallel surface."""
        return parallel_surface(surface, self.values["offset"], self.name)
