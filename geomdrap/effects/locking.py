"""A fabric that cannot be sheared beyond an angle."""

from __future__ import annotations

from dataclasses import replace

from geomdrap.fishnet import Effect, Fabric, Parameter


class Locking(Effect):
    """The net relaxes so that shear stops near the locking angle."""

    name = "locking"
    summary = "Shear stops near an angle at which the yarns touch, at the cost of yarn length."
    equation = "min Σ (l/l0 − 1)² over sides + Σ [(|sin γ| − sin angle)²₊ + 0.02·(sin γ − sin γ0)²]/4 over corners"
    physics = (
        "Yarns turn at the crossings until they lie side by side; from there on they would have to be squeezed. "
        "Shear stops near that angle, neighbouring cells shear more, yarns stretch or slide, and finally the ply "
        "wrinkles, which a net on the tool does not show. Below the angle nothing resists but friction at the "
        "crossings, which holds the shear of the ply as it was laid (γ0): of all nets that do not lock it is the one "
        "that has changed least, and yarns under pressure do not buckle from crossing to crossing. How large that "
        "friction is hardly matters. Together with shear-stiffness that takes its place."
    )
    source = "locking after P. Boisse et al., Composites Sci. Tech. 71 (2011); penalty as stiff as the yarns"
    stage = "fabric"
    seen_by = "shear, marked crossings"
    confounded_with = ("shear-stiffness", "crossing-slip")
    costly = True
    parameters = (Parameter("angle", "deg", 1.0, 90.0, 40.0, 90.0, "shear at which the yarns touch"),)

    def on_fabric(self, fabric: Fabric) -> Fabric:
        """The fabric with a locking angle."""
        angles = (self.values["angle"], fabric.locking_angle or 90.0)
        return replace(fabric, locking_angle=min(angles))
