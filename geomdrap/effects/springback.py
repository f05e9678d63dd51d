"""Shear that is partly recovered once the ply is released."""

from __future__ import annotations

from dataclasses import replace

from geomdrap.fishnet import Effect, Net, Parameter


class Springback(Effect):
    """Shear falls by a fraction of itself; crossings stay where they are."""

    name = "springback"
    summary = "Shear recovers by a fraction once the ply is released."
    equation = "γ → (1 − fraction)·γ"
    physics = (
        "Part of the shear is elastic: yarns bent sideways at the crossings straighten when the load is taken off. "
        "Measured angles are then smaller than formed ones by a constant share, while crossings hardly move."
    )
    source = "elastic recovery of shear, to first order"
    stage = "net"
    seen_by = "shear angles; crossings do not move"
    confounded_with = ("crossing-slip",)
    rank = 90.0
    parameters = (Parameter("fraction", "", 0.0, 0.9, 0.1, 0.0, "share of the shear that is recovered"),)

    def on_net(self, net: Net) -> Net:
        """The net with less shear."""
        keep = 1.0 - self.values["fraction"]
        return replace(net, shear=keep * net.shear, cell_shear=keep * net.cell_shear)
