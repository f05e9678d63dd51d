"""Where physics that the fishnet leaves out comes in: before, on surface or fabric, or after, on the net."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable

    from geomdrap.fishnet.fabric import Fabric
    from geomdrap.fishnet.net import Net
    from geomdrap.surface import Surface


class Effect:
    """A physical effect; a subclass overrides the one stage at which it acts and leaves the others alone."""

    def on_surface(self, surface: Surface) -> Surface:
        """The surface that the fabric really lies on."""
        return surface

    def on_fabric(self, fabric: Fabric) -> Fabric:
        """The fabric as it really comes."""
        return fabric

    def on_net(self, net: Net) -> Net:
        """The net as it really ends up."""
        return net


def before(effects: Iterable[Effect], surface: Surface, fabric: Fabric) -> tuple[Surface, Fabric]:
    """Surface and fabric with the effects that act before the drape, in their order."""
    for effect in effects:
        surface, fabric = effect.on_surface(surface), effect.on_fabric(fabric)
    return surface, fabric


def after(effects: Iterable[Effect], net: Net) -> Net:
    """The net with the effects that act after the drape, in their order."""
    for effect in effects:
        net = effect.on_net(net)
    return net
