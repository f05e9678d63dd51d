"""How much of the warp keeps its heading while a net relaxes: a model is fitted with one length, and drawn with it.

A net turns about its seed the more easily, the shorter the piece is that holds it: with a piece of half the length a
soft net comes to rest some degrees away.
"""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

from geomdrap.fishnet.effect import Effect, Parameter

if TYPE_CHECKING:
    from geomdrap.fishnet.fabric import Fabric


class HeldWarp(Effect):
    """The heading of a net of least energy is held over a length of the warp, not over its first piece."""

    name = "held-warp"
    stage = "fabric"
    parameters = (Parameter("length", "mm", 0.0, 1e6, 8.0, 0.0, "from the seed; 0 is one piece, whatever the pitch"),)

    def on_fabric(self, fabric: Fabric) -> Fabric:
        """The fabric held over that length."""
        return replace(fabric, held_length=self.values["length"])
