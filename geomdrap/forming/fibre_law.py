"""The law of an undulated yarn: slack at first, straight in the end.

Eq. 5 of A. Cherouat, H. Borouchaki, Materials 2 (2009) 1835 is printed E = Ē (1 + exp(−ℓ/(ℓ ε_sh))), whose exponent
is a constant: it would show no undulation at all, and the sign would make a crimped yarn twice as stiff as a straight
one. Read here as E = Ē (1 − exp(−ε/ε_sh)) with ε = ln ℓ: no stiffness at first, Ē in the end, and a curve that lies
ε_sh behind that of a straight yarn. In compression E is a small share of Ē. The compiled form is in `truss`.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from geomdrap.forming.cloth import Fibre

Array = NDArray[np.float64]


def stress(fibre: Fibre, strain: Array) -> Array:
    """Stress (n,) MPa at logarithmic ``strain`` (n,): Ē [ε − ε_sh (1 − exp(−ε/ε_sh))] in tension."""
    e = np.asarray(strain, dtype=np.float64)
    slack = -fibre.undulation * np.expm1(-np.maximum(e, 0.0) / fibre.undulation) if fibre.undulation else 0.0
    return fibre.modulus * np.where(e < 0.0, fibre.compression * e, e - slack)


def tangent(fibre: Fibre, strain: Array) -> Array:
    """Modulus dσ/dε (n,) MPa at logarithmic ``strain`` (n,)."""
    e = np.asarray(strain, dtype=np.float64)
    straight = -np.expm1(-np.maximum(e, 0.0) / fibre.undulation) if fibre.undulation else np.ones_like(e)
    return fibre.modulus * np.where(e < 0.0, fibre.compression, straight)


def energy(fibre: Fibre, strain: Array) -> Array:
    """Energy (n,) per volume of the unstretched yarn, MPa: ∫ σ dℓ with ℓ = exp(ε), the section kept.

    It is not ∫ σ dε: the force is σ times the section as it was, and works along the length as it is.
    """
    e = np.asarray(strain, dtype=np.float64)
    linear = e * np.expm1(e) - (np.expm1(e) - e)
    crimp = np.zeros_like(e)
    if fibre.undulation:
        b, up = 1.0 - 1.0 / fibre.undulation, np.maximum(e, 0.0)
        rest = up if b == 0.0 else np.expm1(b * up) / b
        crimp = fibre.undulation * (np.expm1(up) - rest)
    return fibre.modulus * np.where(e < 0.0, fibre.compression * linear, linear - crimp)
