"""A fabric whose yarns resist bending in the surface."""

from __future__ import annotations

import math
from dataclasses import replace

from geomdrap.fishnet import Effect, Fabric, Parameter


class YarnBending(Effect):
    """The net relaxes to least energy of yarn extension, shear and bending of the yarns in the surface."""

    name = "yarn-bending"
    summary = "Yarns resist bending in the surface, so that shear sets in over a length and not from cell to cell."
    equation = (
        "as shear-stiffness, with ratio·length²·Σ (sin θ/l0)² more over nodes; θ: turn of a yarn in the surface"
    )
    physics = (
        "Where the shear changes along a yarn, the yarns across it turn, and their fibres bend within the ply. Stiff "
        "tows spread that over a transition layer as wide as length, the square root of bending stiffness over shear "
        "stiffness; since yarns hardly stretch, the net depends on little else. Yarns are straight at rest. A length "
        "beyond the radius of a part may straighten them by shearing the whole ply aslant; a locking angle given "
        "as well stops that. Where a yarn crosses an edge of the part its turn does not count. The ratio is that of "
        "shear-stiffness where that is given, else 0.001. At 0 the net is not relaxed at all."
    )
    source = "second gradient energy of woven fabrics: A. Madeo et al., arXiv 1604.04298 (2016)"
    stage = "fabric"
    seen_by = "marked crossings, shear, fibre directions"
    confounded_with = ("shear-stiffness", "steering", "shear-asymmetry")
    costly = True
    acts_at_once = True  # a value near 0 relaxes the net as much as one that is clearly not 0
    includes = ("shear-stiffness",)  # which it is where the length is short
    parameters = (
        Parameter("length", "mm", 0.0, 300.0, 60.0, 0.0, "√(bending stiffness in the surface/shear stiffness)"),
    )

    def on_fabric(self, fabric: Fabric) -> Fabric:
        """The fabric with yarns that are stiff in bending."""
        return replace(fabric, bending_length=math.hypot(fabric.bending_length or 0.0, self.values["length"]))
