"""Cloth that is sheared before it is laid."""

from __future__ import annotations

from dataclasses import replace

from geomdrap.fishnet import Effect, Fabric, Parameter


class WeaveSkew(Effect):
    """Warp and weft cross at another angle than 90° in the flat fabric."""

    name = "weave-skew"
    summary = "Warp and weft do not cross at right angles in the flat fabric."
    equation = "angle from warp to weft generator at the seed = 90° + skew"
    physics = (
        "Take-up rollers and handling shear a cloth on the roll by a few degrees. On the part that offset is added "
        "to the shear everywhere, at the seed, too; skew > 0 opens the +u +v quadrant, so that shear is less there."
    )
    source = "skew of woven cloth on the roll, of which 3 to 5 % are usual limits"
    stage = "fabric"
    seen_by = "shear, fibre directions, marked crossings; the flat cloth itself"
    confounded_with = ("shear-asymmetry", "placement")
    parameters = (Parameter("skew", "deg", -30.0, 30.0, 2.0, 0.0, "angle from warp to weft less 90°"),)

    def on_fabric(self, fabric: Fabric) -> Fabric:
        """The fabric with its weft turned."""
        return replace(fabric, weft_angle=fabric.weft_angle + self.values["skew"])
