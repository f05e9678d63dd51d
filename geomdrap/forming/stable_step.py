"""The largest stable step of central differences, by a bound, and the masses that a wanted step needs.

A step is stable below 2/ω of the fastest vibration. Gershgorin's circles bound it by ω² ≤ max Σ_j |K_ij| / m_i over
the nodes, with the stiffness of straight yarns and of unrelaxed resin.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geomdrap.forming.cloth import Cloth
from geomdrap.forming.sheet import Sheet

Array = NDArray[np.float64]

SAFETY = 0.5
"""Share of the bound that is used: yarns that go slack and tight again need more room than the linear bound gives."""


def physical_mass(sheet: Sheet, cloth: Cloth) -> Array:
    """Mass of each node (n,), t: a third of each triangle around it."""
    mass = np.zeros(len(sheet.fabric))
    np.add.at(mass, sheet.triangles, (cloth.density * cloth.thickness / 3.0 * sheet.areas)[:, None])
    return mass


def row_sums(sheet: Sheet, cloth: Cloth) -> Array:
    """Σ_j |K_ij| (n,) N/mm, the largest of the rows of each node."""
    rows = np.zeros(len(sheet.fabric))
    stiffness = np.array([f.modulus * f.share for f in cloth.families])[sheet.family] * cloth.thickness * sheet.width
    length = np.linalg.norm(np.diff(sheet.fabric[sheet.pieces], axis=1)[:, 0], axis=1)
    np.add.at(rows, sheet.pieces, (2.0 * stiffness / length)[:, None])
    np.add.at(rows, sheet.triangles, _triangle_rows(sheet, cloth))
    return rows


def _triangle_rows(sheet: Sheet, cloth: Cloth) -> Array:
    """The largest row sum of each corner of each triangle (m, 3), from the constant-strain stiffness V Bᵀ C B."""
    xy = sheet.fabric[sheet.triangles]
    opposite = np.roll(xy, -1, axis=1) - np.roll(xy, 1, axis=1)
    twice = 2.0 * sheet.areas / sheet.weight
    grad = np.stack([opposite[..., 1], -opposite[..., 0]], axis=-1) / twice[:, None, None]
    b = np.zeros((len(xy), 3, 3, 2))
    b[:, 0, :, 0] = b[:, 2, :, 1] = grad[..., 0]
    b[:, 1, :, 1] = b[:, 2, :, 0] = grad[..., 1]
    nu = cloth.resin.poisson
    law = cloth.resin.plane_modulus * np.array([[1.0, nu, 0.0], [nu, 1.0, 0.0], [0.0, 0.0, 0.5 * (1.0 - nu)]])
    k = np.einsum("mpia,pq,mqjb->miajb", b, law, b) * (cloth.thickness * sheet.areas)[:, None, None, None, None]
    return np.asarray(np.abs(k).sum(axis=(3, 4)).max(axis=2))


def stable_step(mass: Array, rows: Array, free: NDArray[np.bool_]) -> float:
    """The bound on the step, s, over the ``free`` nodes (n,); infinite where none is free or stiff."""
    chosen = free & (rows > 0.0)
    return float(np.min(2.0 * np.sqrt(mass[chosen] / rows[chosen]))) if np.any(chosen) else float("inf")


def mass_for_step(mass: Array, rows: Array, step: float, safety: float = SAFETY) -> Array:
    """Masses (n,) t, no smaller than ``mass``, with which ``step`` s is ``safety`` times the bound.

    In slow forming inertia does not matter as long as little of the energy is kinetic; heavier nodes only vibrate
    more slowly. Time itself is never compressed, since the resin knows it.
    """
    return np.maximum(mass, rows * (step / (2.0 * safety)) ** 2)
