"""Yarn strain that grows with the distance from the axes, where tension is lost to friction."""

from __future__ import annotations

from dataclasses import replace

from geomdrap.fishnet import Effect, Fabric, Parameter

PER_MM = 1e-3  # 1/m


class TensionGradient(Effect):
    """Cell sides grow in proportion to their distance from the axis through the seed."""

    name = "tension-gradient"
    summary = "Yarns are stretched the more, the further they lie from the seed."
    equation = "side along warp = pitch·(1 + k_warp·|u|), along weft = pitch·(1 + k_weft·|v|), u, v of its middle in m"
    physics = (
        "A blank holder pulls at the ends of the yarns, and friction on the tool takes the tension away towards the "
        "middle (or the reverse, where yarns are held in the middle: k < 0). Yarns stretch with the tension."
    )
    source = "capstan friction, to first order; extensible net"
    stage = "fabric"
    seen_by = "marked crossings, lengths of yarns, the outline"
    confounded_with = ("yarn-extension",)
    parameters = (
        Parameter("k_warp", "1/m", -1.0, 1.0, 0.1, 0.0, "strain of the warp per metre from the weft axis"),
        Parameter("k_weft", "1/m", -1.0, 1.0, 0.1, 0.0, "strain of the weft per metre from the warp axis"),
    )

    def on_fabric(self, fabric: Fabric) -> Fabric:
        """The fabric with sides that grow outward."""
        return replace(
            fabric,
            strain_growth_warp=fabric.strain_growth_warp + self.values["k_warp"] * PER_MM,
            strain_growth_weft=fabric.strain_growth_weft + self.values["k_weft"] * PER_MM,
        )
