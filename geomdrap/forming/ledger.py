"""The energy ledger: where the work that was put in has gone, and by how much the books do not balance.

Stored energy is worked out from strains and relaxing stresses, not summed up from forces, so that the balance tests
laws, elements and integration together. Two options have no stored energy (Green–Naghdi's rate form, constant
thickness): there what the resin takes up is the work of its forces, and the balance tests the integration alone.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geomdrap.forming import explicit, fibre_law
from geomdrap.forming.membrane import WIDTH
from geomdrap.forming.model import Model
from geomdrap.forming.state import State

Array = NDArray[np.float64]


@dataclass(frozen=True)
class Ledger:
    """Energies in N mm at one time.

    ``kinetic`` of the free nodes; ``fibres`` and ``resin``, stored; ``viscous``, dissipated by the resin;
    ``damping``; ``friction``; ``external``: work of grips, loads and tools; ``scheme``: by how much what central
    differences keep is more than kinetic and stored energy, see `scheme_energy`, 0 where motion is damped or
    meets tools; ``balance``: what is unaccounted for.
    """

    kinetic: float
    fibres: float
    resin: float
    viscous: float
    damping: float
    friction: float
    external: float
    scheme: float

    @property
    def internal(self) -> float:
        """Stored in fibres and resin, or dissipated in the resin."""
        return self.fibres + self.resin + self.viscous

    @property
    def balance(self) -> float:
        """What is there, or lost to a known cause, less what was put in."""
        return self.kinetic + self.internal + self.scheme + self.damping + self.friction - self.external

    @property
    def kinetic_share(self) -> float:
        """Kinetic over internal energy; 0 where there is no internal."""
        return self.kinetic / self.internal if self.internal > 0.0 else 0.0

    def balance_error(self, before: Ledger | None = None) -> float:
        """Change of the balance since ``before`` over the largest energy of the two, a share."""
        drift = self.balance - (before.balance if before else 0.0)
        sizes = [e.kinetic + abs(e.internal) + abs(e.external) for e in (self, before) if e]
        return abs(drift) / max(*sizes, 1e-300)


def ledger_of(model: Model, state: State) -> Ledger:
    """The energies of ``state``, at the time of its positions."""
    v, m = state.v, np.repeat(model.mass * model.free, 3)
    a = 0.5 * model.damping * model.step
    push = np.divide(model.step * (state.f + state.load), m, out=np.zeros_like(v), where=m > 0.0)
    after = ((1.0 - a) * v + push + 2.0 * a * state.flow) / (1.0 + a)
    works = state.works
    half_damping = a * float(m @ ((0.5 * (v + after) - state.flow) * v))
    fibres = fibre_energy(model, state)
    resin = resin_energy(model, state) if model.cloth.resin.is_conservative else works[explicit.INTERNAL] - fibres
    return Ledger(
        kinetic=0.5 * float(m @ (v * after)),
        fibres=fibres,
        resin=resin,
        viscous=state.relaxed,
        damping=works[explicit.DAMPING] + half_damping,
        friction=works[explicit.FRICTION],
        external=works[explicit.LOADS] + works[explicit.GRIPS] + works[explicit.TOOLS] + works[explicit.FRICTION],
        scheme=0.0 if model.damping or len(state.tools) else scheme_energy(model, state, after, push),
    )


def scheme_energy(model: Model, state: State, after: Array, push: Array) -> float:
    """Δt²/12 (v·K v + f·M⁻¹ f), N mm: with it and v⁻·M v⁺/2 central differences keep their energy to third order.

    Without it stored energy and motion trade a share of Δt² of the energy where the stiffness changes, as it does
    where yarns go slack; nothing is lost by that (E. Hairer, C. Lubich, G. Wanner, Acta Numerica 12 (2003) 399). K v
    is from the forces before and after the last step; what the scheme keeps of a linear fabric, this keeps exactly.
    ``after`` (3n,) mm/s: velocities half a step on; ``push`` (3n,) mm/s: the change of velocity by the forces. It is
    for free motion: damping and impacts on tools take it along, and nothing books that.
    """
    free = np.repeat(model.free, 3)
    rate = (state.before - state.f) * free
    return (model.step * float(after @ rate) + float(push @ (np.repeat(model.mass, 3) * push))) / 12.0


def fibre_strain(model: Model, state: State) -> Array:
    """Logarithmic strain (k,) of the merged yarn pieces."""
    ends = state.points[model.ends]
    return np.asarray(np.log(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / model.length))


def fibre_energy(model: Model, state: State) -> float:
    """Energy stored in the yarns, N mm."""
    strain, total = fibre_strain(model, state), 0.0
    for number, fibre in enumerate(model.cloth.families):
        mine = model.family == number
        total += float(fibre_law.energy(fibre, strain[mine]) @ (model.section * model.length)[mine])
    return total


def resin_energy(model: Model, state: State) -> float:
    """Energy stored in the resin, N mm: in its lasting stress, and in each that relaxes."""
    resin = model.cloth.resin
    total = 0.5 * resin.relaxation.remaining * _squared(model, _stress(state, 0))
    for number, share in enumerate(resin.relaxation.shares):
        if share > 0.0:
            total += 0.5 * _squared(model, _stress(state, 2 + number)) / share
    return total


def resin_loss(model: Model, state: State) -> float:
    """Power that the resin dissipates, N mm/s."""
    relaxation, total = model.cloth.resin.relaxation, 0.0
    for number, (share, time) in enumerate(zip(relaxation.shares, relaxation.times, strict=True)):
        if share > 0.0:
            total += _squared(model, _stress(state, 2 + number)) / (share * time)
    return total


def book_resin_loss(model: Model, state: State, duration: float) -> None:
    """Add what the resin dissipated in the last ``duration`` s to ``state``, by the trapezoidal rule."""
    if not model.cloth.resin.is_conservative or not len(model.keep):
        return
    now = resin_loss(model, state)
    state.relaxed += 0.5 * duration * (state.loss + now)
    state.loss = now


def _stress(state: State, place: int) -> Array:
    """The three components of a stress in the history, (blocks, 3, WIDTH)."""
    return state.history.reshape(len(state.history), -1, 3, WIDTH)[:, place]


def _squared(model: Model, stress: Array) -> float:
    """∫ σ : C₀⁻¹ : σ over the sheet, N mm."""
    nu, modulus = model.cloth.resin.poisson, model.cloth.resin.modulus
    if modulus == 0.0:
        return 0.0
    a, c, b = stress[:, 0], stress[:, 1], stress[:, 2]  # 11, 12, 22
    density = (a * a + b * b - 2.0 * nu * a * b + 2.0 * (1.0 + nu) * c * c) / modulus
    return float(density.ravel()[: len(model.corners)] @ _volumes(model))


def _volumes(model: Model) -> Array:
    return model.shape.reshape(len(model.shape), -1, WIDTH)[:, -1].ravel()[: len(model.corners)]
