"""The ply was laid down elsewhere than meant: no physics, but first of all to be found out."""

from __future__ import annotations

from dataclasses import replace

from geomdrap.fishnet import Effect, Parameter, Shift


class Placement(Effect):
    """Seed and heading of the ply, displaced."""

    name = "placement"
    summary = "The seed or the heading lay elsewhere than meant."
    equation = "seed = exp(du·warp + dv·weft) from the seed meant; warp carried along, then turned by dangle"
    physics = (
        "Not physics: a ply is laid by hand or robot within a millimetre or two and a degree or two. The whole net "
        "slides with it, which looks like many effects at once, so it is fitted before any of them. u and v are "
        "counted from the seed where it really lies."
    )
    source = "by definition; the seed slides along a geodesic, the warp is transported in parallel"
    stage = "placement"
    seen_by = "marked crossings; shear and fibre directions at places in space"
    confounded_with = ("weave-skew", "steering")
    parameters = (
        Parameter("du", "mm", -200.0, 200.0, 2.0, 0.0, "how far the seed lies along the warp"),
        Parameter("dv", "mm", -200.0, 200.0, 2.0, 0.0, "how far the seed lies along the weft"),
        Parameter("dangle", "deg", -45.0, 45.0, 1.0, 0.0, "how far the warp is turned, counter-clockwise"),
    )

    def on_placement(self, shift: Shift) -> Shift:
        """The seed moved and turned."""
        v = self.values
        return replace(shift, du=shift.du + v["du"], dv=shift.dv + v["dv"], dangle=shift.dangle + v["dangle"])
