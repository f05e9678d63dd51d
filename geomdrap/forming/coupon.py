"""The paper's test specimens by name, each pulled with settings of its own or the usual ones."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from geomdrap.forming.biaxial import JERSEY, biaxial_specimen
from geomdrap.forming.cloth import Cloth, Fibre
from geomdrap.forming.picture_frame import shear_frame
from geomdrap.forming.specimen import Pulled, Specimen, pull
from geomdrap.forming.uniaxial import kinematic_lock, strip_specimen

Progress = Callable[[float], None] | None

BEYOND_LOCK = 3.0
"""Millimetres by which a strip is pulled beyond the lock of its pin-jointed net, unless told otherwise."""
STEPS_PER_CELL = 30.0
"""Steps a cell along the specimen and a ratio of yarn to shear stiffness of one: little energy is kinetic then."""
FEWEST, MOST = 10_000, 400_000


@dataclass(frozen=True, eq=False)
class Coupon:
    """A test that was made: its name, its ``settings`` by name (mm, mm/min, degrees), and its ``result``.

    Of the settings ``steps`` are those taken up to the last reading.
    """

    test: str
    settings: dict[str, Any]
    result: Pulled


def usual_cloth(test: str) -> Cloth:
    """The cloth of ``test`` unless told otherwise: a knit for ``biaxial``, straight yarns for ``bias-extension``."""
    if test == "biaxial":
        return JERSEY
    straight = Fibre(undulation=0.0)
    return Cloth(straight, straight) if test == "bias-extension" else Cloth()


def uniaxial(
    cloth: Cloth,
    angle: float = 45.0,
    speed: float = 20.0,
    displacement: float | None = None,
    length: float = 150.0,
    width: float = 30.0,
    cells: int = 20,
    steps: int | None = None,
    frames: int = 50,
    keep_mass: bool = False,
    progress: Progress = None,
    sized_for: Cloth | None = None,
) -> Coupon:
    """Pull a strip whose warp lies ``angle`` deg from its length; see `strip_specimen` and `pull`.

    ``displacement`` mm, None: to 3 mm beyond the lock of the pin-jointed net; ``speed`` mm/min; ``steps`` None:
    enough; ``sized_for``: the cloth for which masses are scaled, None: ``cloth``.
    """
    specimen = strip_specimen(cloth, length, width, angle, cells)
    if displacement is None:
        displacement = usual_displacement(angle, length, width)
    taken = steps or enough_steps(specimen)
    pulled = pull(specimen, displacement, speed, taken, frames, progress, not keep_mass, sized_for)
    settings = {"angle": angle, "speed": speed, "length": length, "width": width, "displacement": displacement}
    return Coupon("uniaxial", {**settings, **_run_settings(pulled, cells, frames, keep_mass)}, pulled)


def usual_displacement(angle: float, length: float = 150.0, width: float = 30.0) -> float:
    """How far, mm, a strip is pulled unless told otherwise: a little beyond the lock of its pin-jointed net."""
    return kinematic_lock(length, width, min(angle, 90.0 - angle)) + BEYOND_LOCK


def bias_extension(
    cloth: Cloth, displacement: float = 30.0, length: float = 150.0, width: float = 30.0, **more: Any
) -> Coupon:
    """Pull a strip cut at 45°; the rest as for `uniaxial`."""
    made = uniaxial(cloth, 45.0, displacement=displacement, length=length, width=width, **more)
    return Coupon("bias-extension", {k: v for k, v in made.settings.items() if k != "angle"}, made.result)


def picture_frame(
    cloth: Cloth,
    side: float = 100.0,
    shear: Sequence[float] = (5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0),
    speed: float = 20.0,
    steps: int = 4000,
    progress: Progress = None,
) -> Coupon:
    """Shear a square in a frame with bars of ``side`` mm and read it at each of ``shear`` deg; see `shear_frame`."""
    pulled = shear_frame(cloth, side, shear, speed, steps, progress)
    return Coupon(
        "picture-frame", {"side": side, "shear": list(shear), "speed": speed, "steps": pulled.steps}, pulled
    )


def biaxial(
    cloth: Cloth = JERSEY,
    displacement: float = 140.0,
    speed: float = 240.0,
    ratio: float = 1.0,
    cells: int = 20,
    steps: int | None = None,
    frames: int = 50,
    keep_mass: bool = False,
    progress: Progress = None,
    sized_for: Cloth | None = None,
) -> Coupon:
    """Pull a square along warp and weft at once; see `biaxial_specimen` and `pull`."""
    specimen = biaxial_specimen(cloth, cells=cells, ratio=ratio)
    taken = steps or enough_steps(specimen)
    pulled = pull(specimen, displacement, speed, taken, frames, progress, not keep_mass, sized_for)
    settings = {"displacement": displacement, "speed": speed, "ratio": ratio}
    return Coupon("biaxial", {**settings, **_run_settings(pulled, cells, frames, keep_mass)}, pulled)


def _run_settings(pulled: Pulled, cells: int, frames: int, keep_mass: bool) -> dict[str, Any]:
    return {"cells": cells, "steps": pulled.steps, "frames": frames, "keep_mass": keep_mass}


def enough_steps(specimen: Specimen) -> int:
    """Steps with which a slow test stays slow: by cells along it, and the root of yarn over shear stiffness."""
    sheet, cloth = specimen.sheet, specimen.cloth
    pitch = math.sqrt(sheet.areas.sum() / sheet.cells)
    along = float((sheet.points.max(axis=0) - sheet.points.min(axis=0)).max())
    yarn = max(f.modulus * f.share for f in cloth.families)
    ratio = yarn / cloth.resin.shear_modulus if cloth.resin.modulus > 0.0 else 1e4
    return int(min(max(STEPS_PER_CELL * along / pitch * math.sqrt(max(ratio, 1.0)), FEWEST), MOST))
