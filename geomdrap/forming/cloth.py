"""The fabric of the mechanical model: yarns of warp and weft in a membrane of resin.

A. Cherouat, H. Borouchaki, Materials 2 (2009) 1835, Eq. 4 to 6 and Table 1. Units: mm, N, s, MPa, tonne.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Any, TypeVar

from geomdrap.errors import FormingError
from geomdrap.forming.relaxation import RELAXATIONS, Relaxation

THICKNESS_RULES = ("incompressible", "constant")
STRAIN_FORMS = ("hencky", "green-naghdi", "green")


@dataclass(frozen=True)
class Fibre:
    """Yarns of one family.

    ``modulus`` MPa when straight; ``undulation``: the strain that straightens their crimp (ε_sh of Eq. 5);
    ``compression``: stiffness in compression as a share of ``modulus``; ``share``: section of yarn per mm of width,
    as a share of the thickness of the cloth. FormingError where one of them is out of range.
    """

    modulus: float = 130_000.0
    undulation: float = 0.005
    compression: float = 0.01
    share: float = 0.25

    def __post_init__(self) -> None:
        _at_least_zero("fibre modulus", self.modulus, "MPa")
        _at_least_zero("undulation", self.undulation, "(a strain)")
        if not 0.0 <= self.compression <= 1.0:
            raise FormingError(f"the compression share of fibres lies between 0 and 1; got {self.compression:g}")
        if not 0.0 <= self.share <= 1.0:
            raise FormingError(f"the share of the thickness that is fibre lies between 0 and 1; got {self.share:g}")


@dataclass(frozen=True)
class Resin:
    """The membrane: isotropic, viscoelastic, in the frame of the yarns.

    ``modulus`` MPa (instantaneous) and ``poisson``; ``relaxation``, the same for all moduli. ``strain``: ``hencky``,
    the total logarithmic strain, or ``green-naghdi``, the paper's rate form summed up step by step, or ``green``, the
    Saint Venant–Kirchhoff law, for comparison with other programs (the three differ in large strains only).
    ``thickness``: ``incompressible``, thicker as the area falls, or ``constant``, the letter of Eq. 6, which
    ``green`` does not know. FormingError where something is out of range.
    """

    modulus: float = 45.0
    poisson: float = 0.45
    relaxation: Relaxation = field(default_factory=lambda: RELAXATIONS["table"])
    strain: str = "hencky"
    thickness: str = "incompressible"

    def __post_init__(self) -> None:
        _at_least_zero("resin modulus", self.modulus, "MPa")
        if not -1.0 < self.poisson < 0.5:
            raise FormingError(f"Poisson's ratio must lie above -1 and below 0.5; got {self.poisson:g}")
        if self.strain not in STRAIN_FORMS:
            raise FormingError(f"there is no strain '{self.strain}'; choose {', '.join(STRAIN_FORMS)}")
        if self.thickness not in THICKNESS_RULES:
            raise FormingError(f"there is no thickness rule '{self.thickness}'; choose {', '.join(THICKNESS_RULES)}")
        if self.strain == "green" and self.thickness == "constant":
            raise FormingError(
                "the strain 'green' takes the stress over the flat cloth and knows no constant thickness; choose "
                "another strain, or the thickness rule 'incompressible'"
            )

    @property
    def shear_modulus(self) -> float:
        """G in MPa, instantaneous."""
        return self.modulus / (2.0 * (1.0 + self.poisson))

    @property
    def plane_modulus(self) -> float:
        """E / (1 − ν²) in MPa, instantaneous."""
        return self.modulus / (1.0 - self.poisson**2)

    @property
    def is_conservative(self) -> bool:
        """Whether its stored energy is a function of its strain (and of the relaxing stresses)."""
        return self.strain != "green-naghdi" and self.thickness == "incompressible"


@dataclass(frozen=True)
class Cloth:
    """A ply: ``warp`` and ``weft`` yarns, ``resin``, ``thickness`` mm of all plies, ``density`` t/mm³."""

    warp: Fibre = field(default_factory=Fibre)
    weft: Fibre = field(default_factory=Fibre)
    resin: Resin = field(default_factory=Resin)
    thickness: float = 2.0
    density: float = 1.45e-9

    def __post_init__(self) -> None:
        for name, value, unit in (("thickness", self.thickness, "mm"), ("density", self.density, "t/mm³")):
            if not (math.isfinite(value) and value > 0.0):
                raise FormingError(f"the {name} of the cloth must be above 0 {unit}; got {value:g}")

    @property
    def families(self) -> tuple[Fibre, Fibre]:
        """Warp and weft."""
        return self.warp, self.weft


Record = TypeVar("Record", Fibre, Resin, Cloth)


def changed(record: Record, **values: Any) -> Record:
    """A cloth, or a part of one, with those of ``values`` that are not None; FormingError where one cannot be."""
    return replace(record, **{name: value for name, value in values.items() if value is not None})


def _at_least_zero(name: str, value: float, unit: str) -> None:
    if not (math.isfinite(value) and value >= 0.0):
        raise FormingError(f"the {name} must be 0 {unit} or more; got {value:g}")
