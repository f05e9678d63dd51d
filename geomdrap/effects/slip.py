"""Yarns that slide along each other at the crossings instead of turning only."""

from __future__ import annotations

from dataclasses import replace

from geomdrap.fishnet import Effect, Fabric, Parameter


class Slip(Effect):
    """Weft sides that grow with the shear, between a pin-jointed net and one with warp yarns at constant distance."""

    name = "slip"
    summary = "Yarns slide along each other, so that warp yarns draw together less than in a pin-jointed net."
    equation = "side along weft = pitch / cos(γ)^coefficient, γ the shear beside it"
    physics = (
        "In a pin-jointed net shear draws parallel yarns together. In unidirectional and non-crimp cloth they cannot "
        "come closer; they slide over the weft or the stitches instead. 0 is the pin-jointed net, at 1 the warp "
        "yarns keep their distance. A side takes the mean shear of the cells on both of its sides."
    )
    source = "scissor and slide draping, as mixed in laminate modellers; K. Potter, Composites A 33 (2002) for UD"
    stage = "fabric"
    seen_by = "marked crossings, shear, fibre directions"
    confounded_with = ("crossing-slip", "yarn-extension")
    slow = True
    parameters = (
        Parameter("coefficient", "", 0.0, 1.0, 0.3, 0.0, "0: pinned crossings; 1: warp yarns keep their distance"),
    )

    def on_fabric(self, fabric: Fabric) -> Fabric:
        """The fabric with crossings that slide."""
        return replace(fabric, slip=fabric.slip + self.values["coefficient"])
