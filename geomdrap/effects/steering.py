"""Generators that are not laid straight."""

from __future__ import annotations

from dataclasses import replace

from geomdrap.fishnet import Effect, Fabric, Parameter

PER_MM = 1e-3  # 1/m


class Steering(Effect):
    """The yarns through the seed bend sideways at a constant rate."""

    name = "steering"
    summary = "The yarns through the seed are bent sideways as they are laid."
    equation = "geodesic curvature of the warp generator = curvature_warp, of the weft generator = curvature_weft"
    physics = (
        "A hand or a roller that does not work straight outward lays the first yarns along a curve, and all others "
        "follow from them. Curvature is positive to the left of the way along +u (+v); each node turns the generator "
        "by curvature times side, the seed by half of it on either hand."
    )
    source = "Liouville's formula for the nets of generators with given geodesic curvature"
    stage = "fabric"
    seen_by = "marked crossings, fibre directions, shear"
    confounded_with = ("shear-stiffness", "placement")
    parameters = (
        Parameter("curvature_warp", "1/m", -20.0, 20.0, 0.5, 0.0, "geodesic curvature of the warp through the seed"),
        Parameter("curvature_weft", "1/m", -20.0, 20.0, 0.5, 0.0, "geodesic curvature of the weft through the seed"),
    )

    def on_fabric(self, fabric: Fabric) -> Fabric:
        """The fabric with curved generators."""
        return replace(
            fabric,
            curvature_warp=fabric.curvature_warp + self.values["curvature_warp"] * PER_MM,
            curvature_weft=fabric.curvature_weft + self.values["curvature_weft"] * PER_MM,
        )
