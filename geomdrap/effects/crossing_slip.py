"""Yarns that slide at their crossings, so that shear is relieved while each yarn keeps its length."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from geomdrap.fishnet import Effect, Net, Parameter
from geomdrap.fishnet.relax import relax
from geomdrap.fishnet.relax_energy import Law
from geomdrap.fishnet.relax_net import Balance, as_net
from geomdrap.fishnet.relax_problem import Problem, chord_sines, pose
from geomdrap.fishnet.sway import stepped

SLIDING = 0.02  # what a piece resists changing its length by sliding, as a share of shear
WHOLE_YARN = 1e4  # what a whole yarn resists: it keeps its length
SOFTER = (1.0, 1e2)  # the same, in the nets on the way,
CLOSE = 1e-2  # whose forces are balanced so far
ASTRAY = 0.4  # of the way to a net beside another one: further off it is led astray


class CrossingSlip(Effect):
    """Part of the shear beyond an onset is relieved; pieces of a yarn change their lengths, their sum does not."""

    name = "crossing-slip"
    summary = "Yarns slide at the crossings and relieve part of the shear; each keeps its total length."
    equation = (
        "min Σ (sin γ − sin γ*)²/4 over corners + 0.02·Σ e² over sides, Σ e = 0 along each yarn, e the strain of a "
        "side by sliding, γ* = γ0 − share·(|γ0| − onset)₊·sign γ0, γ0 the shear without slip"
    )
    physics = (
        "Beyond some shear it is easier for yarns to slide at the crossings than to turn further. Crossings move "
        "along their yarns to where the shear is less; their spacing becomes uneven, but no yarn gets longer, and "
        "shear is below that of the pin-jointed net, the more the larger it is."
    )
    source = "slip share as found in bias-extension tests by J. Cao et al., Composites A 39 (2008), fig. 36"
    stage = "net"
    seen_by = "marked crossings; angles only together with other effects"
    confounded_with = ("locking", "springback", "yarn-extension")
    rank = 80.0
    costly = True
    parameters = (
        Parameter("share", "", 0.0, 1.0, 0.15, 0.0, "share of the shear beyond the onset that slip is to relieve"),
        Parameter("onset", "deg", 0.0, 80.0, 25.0, 25.0, "shear at which yarns begin to slide"),
    )

    @property
    def is_neutral(self) -> bool:
        """Whether nothing is relieved, whatever the onset."""
        return self.values["share"] == 0.0

    def on_net(self, net: Net) -> Net:
        """The net with crossings that have slid; the same net where no shear is beyond the onset."""
        if not np.nanmax(np.abs(net.cell_shear), initial=0.0) > self.values["onset"]:
            return net
        problem = pose(net, Law(ratio=1.0, piece=SLIDING, yarn=WHOLE_YARN))
        problem = replace(problem, target=self._target(net, problem))
        start = problem.footing
        for stiffness in SOFTER:
            start = relax(replace(problem, law=problem.law._replace(yarn=stiffness)), start, CLOSE).footing
        found = relax(problem, start)
        return replace(as_net(net, problem, found), slid=Balance(net, problem, found))

    def beside(self, near: Net) -> Net | None:
        """The net of the ply as it was laid for one ``near``, to first order in how values differ from those there.

        None where no crossing has slid there.
        """
        if near.slid is None or type(self).on_net is not CrossingSlip.on_net:
            return None
        laid, problem, found = near.slid
        other = replace(problem, target=self._target(laid, problem))
        careful, there = (stepped(near.slid, other, found.footing, full) for full in (False, True))
        if careful is None or there is None:
            return None
        # where yarns that keep their lengths are nearly free to go some way, all second derivatives lead far off
        apart, way = (np.linalg.norm((one.x - careful.x)[problem.nodes]) for one in (there, found))
        return as_net(laid, problem, there if apart < ASTRAY * way else careful)

    def _target(self, net: Net, problem: Problem) -> np.ndarray:
        """Sines of the shear that slip is to leave at the corners of cells."""
        shear = np.nan_to_num(net.cell_shear)
        left = np.abs(shear) - self.values["share"] * np.maximum(np.abs(shear) - self.values["onset"], 0.0)
        relief = np.sin(np.radians(left)) * np.sign(shear) - np.sin(np.radians(shear))
        target = chord_sines(problem.x0, problem.valid) + relief[..., None, None]
        return np.where(problem.valid[..., None, None], target, 0.0)
