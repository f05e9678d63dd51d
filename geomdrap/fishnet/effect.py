"""Where physics that the fishnet leaves out comes in: before, on surface, seed or fabric, or after, on the net.

An effect is a subclass of ``Effect`` with one method. Which order effects are given in makes no difference: all act
on the surface first, then on where the ply is laid down, then on the fabric, then on the net, and at one stage in
the order of their ``rank``.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from geomdrap.errors import EffectError
from geomdrap.fishnet.parameter import Parameter

if TYPE_CHECKING:
    from collections.abc import Sequence

    from geomdrap.fishnet.fabric import Fabric
    from geomdrap.fishnet.net import Net
    from geomdrap.fishnet.shift import Shift
    from geomdrap.surface import Surface


class Effect:
    """A physical effect; a subclass overrides the one stage at which it acts and leaves the others alone.

    What a subclass says of itself: ``name``, by which it is found; ``summary``, one sentence; ``equation``, plain
    text; ``physics``, two or three sentences; ``source``; ``stage``, one of surface, placement, fabric, net;
    ``parameters``; ``seen_by``, the data that can show it; ``confounded_with``, names of effects that look alike.
    ``rank`` orders effects of one stage; ``slow`` and ``costly`` say that a net with it takes a few, or many, times
    as long as without; ``acts_at_once`` that the smallest values act as fully as others, so that ``diagnose`` finds
    it wherever it is not neutral, and does not ask that its values differ clearly from their neutral ones;
    ``includes`` names effects that it comes to at small values: beside these it must do better, and with a value that
    is clearly not small.
    ``values`` are its parameters' values by name.
    Raises EffectError for parameters that it does not have, and values out of bounds.
    """

    name: ClassVar[str] = ""
    summary: ClassVar[str] = ""
    equation: ClassVar[str] = ""
    physics: ClassVar[str] = ""
    source: ClassVar[str] = ""
    stage: ClassVar[str] = ""
    parameters: ClassVar[tuple[Parameter, ...]] = ()
    seen_by: ClassVar[str] = ""
    confounded_with: ClassVar[tuple[str, ...]] = ()
    rank: ClassVar[float] = 100.0
    slow: ClassVar[bool] = False
    costly: ClassVar[bool] = False
    acts_at_once: ClassVar[bool] = False
    includes: ClassVar[tuple[str, ...]] = ()

    def __init__(self, **values: float) -> None:
        known = {p.name: p for p in self.parameters}
        for name in values:
            if name not in known:
                takes = f"takes {', '.join(known)}" if known else "takes no parameters"
                raise EffectError(f"effect {self.title()} has no parameter {name!r}; it {takes}")
        self.values = {n: p.checked(values.get(n, p.neutral), self.title()) for n, p in known.items()}

    @classmethod
    def title(cls) -> str:
        """The name, or that of the class where it has none."""
        return cls.name or cls.__name__

    def __repr__(self) -> str:
        return f"{self.title()}({', '.join(f'{k}={v:g}' for k, v in getattr(self, 'values', {}).items())})"

    @property
    def is_neutral(self) -> bool:
        """Whether all parameters have their neutral values, so that the effect changes nothing."""
        values: dict[str, float] = getattr(self, "values", {})
        return bool(self.parameters) and all(values.get(p.name) == p.neutral for p in self.parameters)

    def on_surface(self, surface: Surface) -> Surface:
        """The surface that the fabric really lies on."""
        return surface

    def on_placement(self, shift: Shift) -> Shift:
        """Where the ply was really laid down."""
        return shift

    def on_fabric(self, fabric: Fabric) -> Fabric:
        """The fabric as it really comes."""
        return fabric

    def on_net(self, net: Net) -> Net:
        """The net as it really ends up. Where its points move to other facets, ``face`` must follow them."""
        return net

    def beside(self, near: Net) -> Net | None:
        """The net of the ply as it was laid for one ``near``, to first order in how values differ from those there.

        None where that takes as long as the net itself. Where the ply was laid must hardly matter to what it changes.
        """
        return None


def in_order(effects: Sequence[Effect]) -> tuple[Effect, ...]:
    """The effects that change something, in the order in which they act at one stage.

    Raises EffectError for what is no effect.
    """
    for effect in effects:
        if not isinstance(effect, Effect):
            raise EffectError(
                f"effects must be objects such as gd.effects.make('slip', coefficient=0.6), not {effect!r}"
            )
    return tuple(sorted((e for e in effects if not e.is_neutral), key=lambda e: e.rank))


def surface_with(effects: Sequence[Effect], surface: Surface) -> Surface:
    """The surface with the effects that act on it."""
    for effect in effects:
        surface = effect.on_surface(surface)
    return surface


def shift_with(effects: Sequence[Effect], shift: Shift) -> Shift:
    """Where the ply is laid down with the effects that act on that."""
    for effect in effects:
        shift = effect.on_placement(shift)
    return shift


def fabric_with(effects: Sequence[Effect], fabric: Fabric) -> Fabric:
    """The fabric with the effects that act on it."""
    for effect in effects:
        fabric = effect.on_fabric(fabric)
    return fabric


def net_with(effects: Sequence[Effect], net: Net) -> Net:
    """The net with the effects that act after the drape."""
    for effect in effects:
        net = effect.on_net(net)
    return net
