"""A fabric that resists shear."""

from __future__ import annotations

from dataclasses import replace

from geomdrap.fishnet import Effect, Fabric, Parameter


class ShearStiffness(Effect):
    """The net relaxes to least energy of yarn extension and shear."""

    name = "shear-stiffness"
    summary = "Shear costs energy, so that the net gives way until its energy is least."
    equation = "min Σ (l/l0 − 1)² over sides + ratio·Σ sin²γ/4 over corners; seed and first warp side's heading held"
    physics = (
        "Shear needs work against friction at the crossings and bending of the yarns; stretching yarns needs far "
        "more. A fabric that is free to slide on the tool takes the form in which the sum is least: its generators "
        "are no geodesics then. ratio is the stiffness in shear over that of the yarns; as it goes to 0 the yarns "
        "keep their length, and the generators still bend to save shear. At 0 the net is not relaxed at all."
    )
    source = "energy-minimal nets, e.g. A. Sharma and M. Sutcliffe, Composites A 35 (2004)"
    stage = "fabric"
    seen_by = "marked crossings, shear, fibre directions"
    confounded_with = ("steering", "shear-asymmetry", "locking", "yarn-bending")
    costly = True
    acts_at_once = True  # a value near 0 acts as much as one that is clearly not 0
    parameters = (Parameter("ratio", "", 0.0, 1.0, 0.003, 0.0, "shear stiffness as a share of that of the yarns"),)

    def on_fabric(self, fabric: Fabric) -> Fabric:
        """The fabric with a stiffness in shear."""
        return replace(fabric, shear_stiffness=(fabric.shear_stiffness or 0.0) + self.values["ratio"])
