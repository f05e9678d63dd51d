"""A fabric that is stiffer when sheared one way than the other."""

from __future__ import annotations

from dataclasses import replace

from geomdrap.fishnet import Effect, Fabric, Parameter


class ShearAsymmetry(Effect):
    """The net relaxes with a shear stiffness that depends on the sign of the shear."""

    name = "shear-asymmetry"
    summary = "Shear is harder one way than the other: stitched non-crimp fabric."
    equation = "as shear-stiffness, with ratio·(1 + alpha) where γ > 0 and ratio·(1 − alpha) where γ < 0"
    physics = (
        "A stitch that runs at 45° to the yarns is stretched by shear of one sign and slack in the other. The net "
        "moves shear from the stiff quadrants to the soft ones. The ratio is that of shear-stiffness where that is "
        "given as well; alone it is 0.003, a size that is usual for dry cloth and on which the net hardly depends."
    )
    source = "unbalanced shear of pillar- and chain-stitched cloth: S. Lomov et al., Composites A 36 (2005)"
    stage = "fabric"
    seen_by = "marked crossings, shear, fibre directions"
    confounded_with = ("weave-skew", "shear-stiffness", "placement")
    parameters = (Parameter("alpha", "", -0.9, 0.9, 0.2, 0.0, "(stiffness of γ > 0 − of γ < 0) / their sum"),)

    def on_fabric(self, fabric: Fabric) -> Fabric:
        """The fabric with an unequal stiffness in shear."""
        return replace(fabric, shear_asymmetry=(fabric.shear_asymmetry or 0.0) + self.values["alpha"])
