"""Yarns longer on the part than in the flat fabric."""

from __future__ import annotations

from dataclasses import replace

from geomdrap.fishnet import Effect, Fabric, Parameter


class YarnExtension(Effect):
    """Cell sides grow by a strain, one for each family of yarns."""

    name = "yarn-extension"
    summary = "Yarns are stretched: crimp straightens under tension."
    equation = "side = pitch·(1 + strain_warp) along warp, pitch·(1 + strain_weft) along weft"
    physics = (
        "Forming pulls the crimp out of woven yarns before the fibres themselves carry load, so that crossings lie "
        "further from the seed than in the flat fabric. Shear at a place on the part hardly changes: a net does not "
        "know the size of its cells."
    )
    source = "extensible net; crimp straightening after J. Cao et al., Composites A 39 (2008)"
    stage = "fabric"
    seen_by = "marked crossings, lengths of yarns, the outline; not angles alone"
    confounded_with = ("tension-gradient",)
    parameters = (
        Parameter("strain_warp", "", -0.1, 0.2, 0.005, 0.0, "strain of the warp yarns"),
        Parameter("strain_weft", "", -0.1, 0.2, 0.005, 0.0, "strain of the weft yarns"),
    )

    def on_fabric(self, fabric: Fabric) -> Fabric:
        """The fabric with longer sides."""
        return replace(
            fabric,
            strain_warp=fabric.strain_warp + self.values["strain_warp"],
            strain_weft=fabric.strain_weft + self.values["strain_weft"],
        )
