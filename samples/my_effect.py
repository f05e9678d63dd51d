"""An effect of one's own: shrinkage of the fibres in the oven.

Try it, in one line:
  geomdrap drape samples/parts/hemisphere.stl
    --plugin samples/my_effect.py --effect oven-shrinkage:strain=0.004
"""

from dataclasses import replace

import geomdrap as gd


class OvenShrinkage(gd.Effect):
    """Both families of yarns get shorter by the same share."""

    name = "oven-shrinkage"
    summary = "Yarns shrink while the ply is heated."
    equation = "side = pitch·(1 − strain)"
    stage = "fabric"
    parameters = (gd.Parameter("strain", "", 0.0, 0.05, 0.004, 0.0, "share by which yarns shrink"),)

    def on_fabric(self, fabric: gd.Fabric) -> gd.Fabric:
        """The fabric with shorter yarns."""
        shrunk = self.values["strain"]
        return replace(fabric, strain_warp=fabric.strain_warp - shrunk, strain_weft=fabric.strain_weft - shrunk)
