"""An effect of one's own: a part that was measured warm, and is larger than the tool it was made on.

The story of how it was found is in new_effect.md.
"""

from dataclasses import replace

import geomdrap as gd


class HeatGrowth(gd.Effect):
    """The part and the ply on it grow alike in all directions, about the origin of the measuring frame."""

    name = "heat-growth"
    summary = "The part was measured warm and is larger than when the ply was laid."
    equation = "point → (1 + strain)·point"
    physics = "Steel grows by 1.2 % per 1000 K, aluminium by 2.4 %; what is measured on it grows with it."
    source = "linear thermal expansion; any handbook"
    stage = "net"
    seen_by = "marked crossings; positions off the tool"
    parameters = (gd.Parameter("strain", "", -0.05, 0.05, 0.005, 0.0, "change of all lengths"),)

    def on_net(self, net: gd.Net) -> gd.Net:
        """The net as it is found on the warm part; its shear stays."""
        grown = 1.0 + self.values["strain"]
        warm = net.surface.moved(grown * net.surface.points)
        return replace(net, surface=warm, points=grown * net.points, lattice=grown * net.lattice)
