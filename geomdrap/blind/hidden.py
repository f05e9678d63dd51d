"""The effects a blind set can hide: what each does to the recipe, how large it is drawn, on which parts it shows.

Names and parameters are those of the library, sizes about those that real plies show.
``amount`` scales how strong the effect is: 1 as drawn, 0.5 half as strong.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from geomdrap.blind.tools import CONCAVE, TOOLS

EVERYWHERE = tuple(TOOLS)
MUCH_SHEARED = ("dome", "saddle", "double-bump", "bowl", "hat")
RELAXING = (*MUCH_SHEARED, "ridge")
SHEARED = (*RELAXING, "pan")
BENT_ALIKE = tuple(part for part in TOOLS if part != "saddle")
"""Where a parallel surface is longer or shorter: a saddle bends as much up as down."""
ASYMMETRIC_RATIO = 0.003  # shear stiffness of the nets whose stiffness depends on the sign of the shear
LONGEST_BENT = 280.0  # mm
BENT_RATIO = 0.001  # with less, yarns stay straight by shearing the whole net to a slant

Draw = Callable[[np.random.Generator, float, float], tuple[dict[str, float], dict[str, Any]]]
"""(random generator, amount, 97th percentile of |γ| without the effect) -> parameters as named, recipe's fields."""


@dataclass(frozen=True)
class Hidden:
    """A family of hidden effects."""

    draw: Draw
    parts: tuple[str, ...] = EVERYWHERE
    known: bool = True
    """Whether it is in the library; others must be called unknown."""


def _signed(rng: np.random.Generator, low: float, high: float) -> float:
    return float(rng.uniform(low, high) * rng.choice([-1.0, 1.0]))


def _extension(rng: np.random.Generator, amount: float, _: float) -> tuple[dict[str, float], dict[str, Any]]:
    warp, weft = amount * rng.uniform(0.006, 0.018), amount * rng.uniform(0.001, 0.008)
    return {"strain_warp": warp, "strain_weft": weft}, {"extension": (warp, weft)}


def _gradient(rng: np.random.Generator, amount: float, _: float) -> tuple[dict[str, float], dict[str, Any]]:
    warp, weft = amount * rng.uniform(0.08, 0.2, 2)
    return {"k_warp": float(warp), "k_weft": float(weft)}, {"gradient": (warp / 1e3, weft / 1e3)}


def _skew(rng: np.random.Generator, amount: float, _: float) -> tuple[dict[str, float], dict[str, Any]]:
    skew = amount * _signed(rng, 1.5, 4.0)
    return {"skew": skew}, {"skew": skew}


def _steering(rng: np.random.Generator, amount: float, _: float) -> tuple[dict[str, float], dict[str, Any]]:
    warp, weft = amount * _signed(rng, 0.4, 1.0), amount * _signed(rng, 0.0, 0.4)
    named = {"curvature_warp": warp, "curvature_weft": weft}
    return named, {"curvature": (warp / 1e3, weft / 1e3)}


def _slip(rng: np.random.Generator, amount: float, _: float) -> tuple[dict[str, float], dict[str, Any]]:
    slip = min(amount * rng.uniform(0.5, 1.0), 1.0)
    return {"coefficient": slip}, {"slip": slip}


def _thickness(rng: np.random.Generator, amount: float, _: float) -> tuple[dict[str, float], dict[str, Any]]:
    offset = amount * rng.uniform(1.5, 4.0)
    return {"offset": offset}, {"offset": offset}


def _bridging(rng: np.random.Generator, amount: float, _: float) -> tuple[dict[str, float], dict[str, Any]]:
    radius = amount * rng.uniform(50.0, 80.0)
    return {"radius": radius}, {"ball": radius}


def _stiffness(rng: np.random.Generator, amount: float, _: float) -> tuple[dict[str, float], dict[str, Any]]:
    ratio = float(amount * 10.0 ** rng.uniform(-3.0, -2.2))
    return {"ratio": ratio}, {"stiffness": ratio}


def _asymmetry(rng: np.random.Generator, amount: float, _: float) -> tuple[dict[str, float], dict[str, Any]]:
    alpha = amount * _signed(rng, 0.2, 0.5)
    return {"alpha": alpha}, {"stiffness": ASYMMETRIC_RATIO, "asymmetry": alpha}


def _locking(rng: np.random.Generator, amount: float, shear: float) -> tuple[dict[str, float], dict[str, Any]]:
    lock = shear * (1.0 - min(amount * rng.uniform(0.15, 0.4), 0.6))
    return {"angle": lock}, {"lock": lock}


def _springback(rng: np.random.Generator, amount: float, _: float) -> tuple[dict[str, float], dict[str, Any]]:
    fraction = amount * rng.uniform(0.1, 0.3)
    return {"fraction": fraction}, {"recovery": fraction}


def _crossing(rng: np.random.Generator, amount: float, shear: float) -> tuple[dict[str, float], dict[str, Any]]:
    share, onset = min(amount * rng.uniform(0.15, 0.35), 0.9), shear * rng.uniform(0.1, 0.4)
    return {"share": share, "onset": onset}, {"share": share, "onset": onset}


def _sag(rng: np.random.Generator, amount: float, _: float) -> tuple[dict[str, float], dict[str, Any]]:
    depth = amount * rng.uniform(1.5, 4.0)
    return {"depth": depth}, {"sag": depth}


def _order(rng: np.random.Generator, amount: float, _: float) -> tuple[dict[str, float], dict[str, Any]]:
    at, turn = rng.uniform(35.0, 60.0), amount * _signed(rng, 4.0, 8.0)
    return {"distance": at, "turn": turn}, {"kink": (at, turn)}


def _bending(rng: np.random.Generator, amount: float, _: float) -> tuple[dict[str, float], dict[str, Any]]:
    # bending·turn²/side² a bend and ratio·sin²γ/4 a corner: as in the library, where bending = ratio·length² and the
    # side is the mean of two rest lengths; its turn is sin θ, here it is 2 sin(θ/2), which differ as θ³
    length = min(float(amount * rng.uniform(2.5, 5.0) / np.sqrt(BENT_RATIO)), LONGEST_BENT)
    return {"length": length}, {"bending": BENT_RATIO * length**2, "stiffness": BENT_RATIO}


def _heat(rng: np.random.Generator, amount: float, _: float) -> tuple[dict[str, float], dict[str, Any]]:
    strain = amount * _signed(rng, 0.004, 0.01)
    return {"strain": strain}, {"swell": strain}


HIDDEN: dict[str, Hidden] = {
    "yarn-extension": Hidden(_extension),
    "tension-gradient": Hidden(_gradient),
    "weave-skew": Hidden(_skew),
    "steering": Hidden(_steering),
    "slip": Hidden(_slip, MUCH_SHEARED),
    "thickness": Hidden(_thickness, BENT_ALIKE),
    "bridging": Hidden(_bridging, CONCAVE),
    "shear-stiffness": Hidden(_stiffness, RELAXING),
    "locking": Hidden(_locking, MUCH_SHEARED),
    "springback": Hidden(_springback, SHEARED),
    "shear-asymmetry": Hidden(_asymmetry, RELAXING),
    "yarn-bending": Hidden(_bending, MUCH_SHEARED),
    "crossing-slip": Hidden(_crossing, MUCH_SHEARED),
    "gravity-sag": Hidden(_sag, known=False),
    "drape-order": Hidden(_order, known=False),
    "heat-growth": Hidden(_heat, known=False),
}

LIBRARY = tuple(name for name, hidden in HIDDEN.items() if hidden.known)
OUTSIDE = tuple(name for name, hidden in HIDDEN.items() if not hidden.known)
"""What no effect of the library is: the right verdict is ``unknown``."""
