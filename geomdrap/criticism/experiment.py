"""A measurement and the model of it: what was measured as one vector, and the model's prediction of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.criticism.kept import kept
from geomdrap.criticism.prediction import predicted
from geomdrap.criticism.smooth import Split, smoothed
from geomdrap.fishnet import Effect, Fabric, Net, drape
from geomdrap.fishnet.effect import fabric_with, in_order, net_with, surface_with
from geomdrap.fishnet.held_warp import HeldWarp
from geomdrap.fishnet.laid_down import laid_down
from geomdrap.fishnet.relax_net import UNREST
from geomdrap.fishnet.sway import swayed, taken_along

if TYPE_CHECKING:
    from geomdrap.criticism.layup import Layup
    from geomdrap.criticism.likelihood import Judge
    from geomdrap.fishnet.laid_down import Start
    from geomdrap.measurement import Measurement
    from geomdrap.surface import Surface

KEPT = 12  # surfaces with effects on them that are kept, and corrections of coarse nets
KEPT_NETS = 3
ALIKE = 0.3  # of their typical sizes: values differ by less where a net is relaxed from another one
HARDLY_DIFFERENT = 0.5  # likewise: what a coarse net gets wrong is the same, 1 mm of what varies over centimetres
TOP = 97.0  # percentile of the shear that counts as the largest
FINE, COARSE = 7000, 900  # nodes of the net, for what costs milliseconds and for what costs seconds


@dataclass(frozen=True, eq=False)
class Experiment:
    """Measured values, in one order for all models.

    ``at`` (n, 2) mm fabric coordinates of the points; ``channels`` (c,) of those in ``prediction``; ``mask`` (n, c)
    which were measured; ``noise`` (m,) their standard deviations, mm or degrees; ``measured`` (m,); vectors hold the
    true entries of ``mask``, channel by channel. ``refused``: why a drape with an effect could not be made at some of
    the values tried, by its name; ``warnings`` of the table. ``frames`` (n, 3, 3): along the warp, across it, and the
    normal. What is costly is kept: ``surfaces`` with effects on them and how their facets were split (``splits``),
    the ``coarseness`` of nets, the last ``costly`` nets, and ``judges`` of some values. ``coarser``: the pitch, mm,
    of the nets which those for what is costly refine, None where they are the first. ``takes_along``: whether relaxed
    nets may keep the cells of one like them.
    """

    surface: Surface
    measurement: Measurement
    layup: Layup
    at: np.ndarray
    frames: np.ndarray
    channels: tuple[str, ...]
    mask: np.ndarray
    noise: np.ndarray
    measured: np.ndarray
    pitches: tuple[float, float]
    warnings: tuple[str, ...] = ()
    surfaces: dict[str, Surface] = field(default_factory=dict)
    refused: dict[str, str] = field(default_factory=dict)
    coarseness: list[tuple[Sequence[Effect], np.ndarray]] = field(default_factory=list)
    costly: dict[str, Net] = field(default_factory=dict)
    splits: list[Split] = field(default_factory=list)
    last: dict[str, tuple[Sequence[Effect], Net | None]] = field(default_factory=dict)
    judges: dict[bytes, Judge] = field(default_factory=dict)
    on_facets: bool = False
    takes_along: bool = True
    coarser: float | None = None

    def predict(self, effects: Sequence[Effect] = ()) -> np.ndarray:
        """The model's values (m,), NaN where it has none."""
        if not any(e.costly for e in effects):
            return self._flat(self.draped(effects))
        # what is costly is done on a coarse net, with what the coarseness changes in the same net without it
        stiff = [e for e in effects if not e.costly]
        return self._flat(self.draped(effects, self.pitches[1])) + self._coarseness(stiff)

    @cached_property
    def top_shear(self) -> float:
        """Nearly the largest shear (degrees, absolute) of the net without effects."""
        return float(np.nanpercentile(np.abs(self.draped((), self.pitches[1]).cell_shear), TOP))

    def _coarseness(self, effects: Sequence[Effect]) -> np.ndarray:
        """What the fine net gives more than the coarse one (m,), at these values or others hardly different."""
        acting = in_order(effects)
        apart = [_apart(before, acting) for before, _ in self.coarseness]
        if min(apart, default=math.inf) <= HARDLY_DIFFERENT:
            entry = self.coarseness.pop(int(np.argmin(apart)))
        else:
            fine, coarse = (self._flat(self.draped(effects, pitch)) for pitch in self.pitches)
            entry = acting, fine - coarse
        self.coarseness.append(entry)
        del self.coarseness[:-KEPT]
        return entry[1]

    def draped(self, effects: Sequence[Effect] = (), pitch: float | None = None) -> Net:
        """The model's net with effects, at the model's own pitch (mm) unless another is given."""
        pitch = pitch or self.pitches[0]
        if not any(e.costly for e in effects):
            return self._draped(effects, pitch)
        key = f"{pitch!r} {'+'.join(map(repr_of, effects))}"
        return kept(self.costly, key, lambda: self._relaxed(effects, pitch), KEPT_NETS)

    def _relaxed(self, effects: Sequence[Effect], pitch: float) -> Net:
        """A net of what is costly, from the last one with the same effects if that is much like it.

        On the same cells many short ways lead where one long one does; a long one takes as many rounds as a drape's.
        """
        acting = in_order(effects)
        names = f"{pitch!r} {'+'.join(e.name for e in acting)}"
        before, last = self.last.get(names, (acting, None))
        near = last if _apart(before, acting) <= ALIKE else None
        net = None if near is None else self._from(near, acting, pitch)
        if net is None or restless(net):
            net = self._first(acting, pitch)
        if not restless(net):
            self.last[names] = acting, net
        return net

    def _from(self, near: Net, effects: Sequence[Effect], pitch: float) -> Net:
        """A net of what is costly from one near it: taken along, else draped and relaxed from where that has gone."""
        if self.takes_along and near.balance is not None:
            net = self._beside(near, effects, taken_along)
            if net is not None:
                return net
        return self._draped(effects, pitch, near)

    def _first(self, effects: Sequence[Effect], pitch: float) -> Net:
        """A net of what is costly, from a coarser one if that is of least energy and at rest."""
        finest = self.coarser is not None and pitch == self.pitches[1]
        if finest and fabric_with(effects, Fabric()).relaxes:
            near = self.draped(effects, self.coarser)
            net = near if restless(near) else self._draped(effects, pitch, near)
            if not restless(net):
                return net
        return self._draped(effects, pitch)

    @property
    def held(self) -> float:
        """The length of warp, mm, that holds the heading of relaxed nets: a piece of the coarsest."""
        return self.coarser or self.pitches[1]

    def beside(self, effects: Sequence[Effect], others: Sequence[Effect]) -> np.ndarray | None:
        """What the model's values (m,) are more with others, to first order in how far these are from the effects.

        None where that takes a drape.
        """
        if not any(e.costly for e in others):
            return None
        if not fabric_with(in_order(others), Fabric()).relaxes:
            return self._on_net_beside(effects, others)
        near = self.draped(effects, self.pitches[1])
        net = None if restless(near) else self._beside(near, others, swayed)
        return None if net is None or restless(net) else self._flat(net) - self._flat(near)

    def _beside(self, near: Net, effects: Sequence[Effect], how: Callable[[Net, Start], Net | None]) -> Net | None:
        """The net of a ply with effects, from one near and ``how`` its start makes a net of that; None for none."""
        lay, (surface, others) = self.layup, self._with_hold(effects)
        acting = in_order(others)
        start = laid_down(surface, lay.origin, lay.angle, near.pitch, Fabric(), acting, lay.reference, lay.project)
        net = how(near, start)
        return None if net is None else replace(net_with(acting, net), effects=acting)

    def _on_net_beside(self, effects: Sequence[Effect], others: Sequence[Effect]) -> np.ndarray | None:
        """Likewise where what is costly acts on the net, and where the ply is laid hardly matters to that."""
        acting = [e for e in in_order(others) if e.costly or e.stage == "net"]
        if not acting or type(acting[-1]).beside is Effect.beside or sum(e.costly for e in acting) > 1:
            return None
        same = [[repr_of(e) for e in in_order(some) if e.stage != "placement"] for some in (effects, others)]
        if same[0] == same[1]:  # only the placement differs
            there, here = (self._flat(self.draped([e for e in some if not e.costly])) for some in (others, effects))
            return there - here
        if _apart(*(in_order([e for e in some if not e.costly]) for some in (effects, others))) > 0.0:
            return None
        near = self.draped(effects, self.pitches[1])
        net = None if restless(near) else acting[-1].beside(near)
        return None if net is None else self._flat(net) - self._flat(near)

    def _draped(self, effects: Sequence[Effect], pitch: float, near: Net | None = None) -> Net:
        lay, (surface, others) = self.layup, self._with_hold(effects)
        return drape(
            surface,
            lay.origin,
            lay.angle,
            pitch,
            effects=others,
            reference=lay.reference,
            project=lay.project,
            near=near,
        )

    def _with_hold(self, effects: Sequence[Effect]) -> tuple[Surface, list[Effect]]:
        """As ``_surface_under``, with what holds the heading of relaxed nets."""
        surface, others = self._surface_under(effects)
        hold = [HeldWarp(length=self.held)] if any(e.costly for e in others) else []
        return surface, [*others, *hold]

    def _surface_under(self, effects: Sequence[Effect]) -> tuple[Surface, list[Effect]]:
        """The smooth surface with the effects that act on it, made once for each of their values; other effects."""
        acting = [e for e in effects if e.stage == "surface"]
        others = [e for e in effects if e.stage != "surface"]
        key = "+".join(map(repr_of, in_order(acting)))

        def make() -> Surface:
            surface = surface_with(in_order(acting), self.surface)
            return surface if self.on_facets else smoothed(surface, self.splits)

        return kept(self.surfaces, key, make, KEPT), others

    def _flat(self, net: Net) -> np.ndarray:
        return flatten(predicted(net, self.measurement, self.frames, self.channels), self.mask)

    def finer(self) -> Experiment:
        """The same experiment with the net for what is costly twice as fine, but no finer than the other one."""
        first, pitch = self.pitches
        half = max(0.5 * pitch, first)
        return replace(self, pitches=(first, half), coarser=pitch if half < pitch else None, coarseness=[])

    def of_half_pitch(self) -> Experiment:
        """The same experiment with all nets of half the pitch."""
        return replace(self, pitches=(0.5 * self.pitches[0], 0.5 * self.pitches[1]), coarseness=[])

    def as_meant(self, effects: Sequence[Effect]) -> dict[str, str | float | tuple[float, ...]]:
        """How the ply was meant to lie, as a model file with effects holds it: with what relaxed nets depend on."""
        nets = {"pitch": self.pitches[1], "held": self.held} if any(e.costly for e in effects) else {}
        return {**self.layup.as_meant(), **nets}

    def without(self, drop: np.ndarray) -> Experiment:
        """The same experiment without the values ``drop`` (n, c) bool."""
        left = ~flatten(drop, self.mask)
        values = {"noise": self.noise[left], "measured": self.measured[left]}
        return replace(self, mask=self.mask & ~drop, coarseness=[], judges={}, **values)

    def at_the_end(self) -> Experiment:
        """The same experiment without what is large and soon made again."""
        return replace(self, surfaces={}, judges={}, coarseness=[])

    def draping_anew(self) -> Experiment:
        """The same experiment in which every relaxed net is draped, with the cells that are on the part there."""
        return replace(self, takes_along=False, costly={}, last={}, coarseness=[])

    def unsmoothed(self) -> Experiment:
        """The same experiment with nets on the facets themselves, not on the smooth tool that they stand for."""
        empty: dict[str, dict[str, object]] = {name: {} for name in ("surfaces", "costly", "last", "refused")}
        return replace(self, on_facets=True, coarseness=[], **empty)  # type: ignore[arg-type]

    def white(self, values: np.ndarray) -> np.ndarray:
        """Values (m,) or slopes (m, p) over the noise."""
        return values / (self.noise if values.ndim == 1 else self.noise[:, None])

    def noise_by_kind(self) -> tuple[float | None, float | None, float | None]:
        """Typical noise of positions (mm), shear and directions (degrees); None where not measured."""
        channel = np.array(self.channels)[self.channel_of()]
        own = [self.noise[np.isin(channel, names)] for names in (("normal",), ("shear",), ("warp", "weft"))]
        return tuple(float(np.median(noise)) if len(noise) else None for noise in own)  # type: ignore[return-value]

    def noise_told(self) -> dict[str, float | None]:
        """The typical noise by the names that it has as an argument, as of ``compare_net``."""
        return dict(zip(("sigma_xyz", "sigma_shear", "sigma_direction"), self.noise_by_kind(), strict=True))

    def channel_of(self) -> np.ndarray:
        """Number of the channel of each value (m,)."""
        return np.repeat(np.arange(len(self.channels)), self.mask.sum(axis=0))

    def point_of(self) -> np.ndarray:
        """Number of the point of each value (m,)."""
        return np.nonzero(self.mask.T)[1]


def restless(net: Net) -> bool:
    """Whether a net has not come to rest."""
    return any(UNREST in warning for warning in net.warnings)


def _apart(some: Sequence[Effect], others: Sequence[Effect]) -> float:
    """By how much of their typical sizes values of the same effects differ at most; infinite for other effects."""
    if [e.name for e in some] != [e.name for e in others]:
        return math.inf
    sizes = [abs(q.typical - q.neutral) or abs(q.typical) for e in some for q in e.parameters]
    values = [[e.values[q.name] for e in effects for q in e.parameters] for effects in (some, others)]
    return max((abs(a - b) / size for a, b, size in zip(*values, sizes, strict=True)), default=0.0)


def repr_of(effect: Effect) -> str:
    """An effect with all digits of its values."""
    return f"{effect.name}{sorted(effect.values.items())}"


def flatten(table: np.ndarray, mask: np.ndarray) -> np.ndarray:
    """The true entries (m,) of a table (n, c), channel by channel."""
    return table.T[mask.T]
