"""A test specimen: what is held, how it is pulled, and what the machine and the camera read."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import FormingError
from geomdrap.forming import fibre_law
from geomdrap.forming.cloth import Cloth
from geomdrap.forming.model import make_model
from geomdrap.forming.run import Run, drive
from geomdrap.forming.sheet import Sheet

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

DAMPING = 48.0
"""Mass damping times the duration of a run: vibrations fade within a twentieth of it."""
MEMORY = 0.02
"""Share of the duration over which the flow is a mean: longer than vibrations, shorter than what a curve shows."""
BREAKS, STIFF = 0.05, 10_000.0
"""Strain beyond the crimp by which yarns with a modulus from so many MPa on have broken: aramid does at 0.03."""
SLOW = 0.02
"""Share of kinetic energy, from a quarter of the way on, beyond which a run is no longer a slow one."""


@dataclass(frozen=True, eq=False)
class Specimen:
    """A sheet in grips.

    ``held`` (d,) nodes; ``flow`` (n, 3): by how much each node moves per mm of displacement; for those that are not
    held only a first guess, at which they start. ``readers``: for each force
    that the machine reads, its name and weights (n, 3), which make one number of the reactions.
    """

    sheet: Sheet
    cloth: Cloth
    held: Whole
    flow: Array
    readers: dict[str, Array]


@dataclass(frozen=True, eq=False)
class Pulled:
    """A specimen after its test.

    ``displacement`` (f,) mm; ``forces`` N by the name of the reader, each (f,); ``shear`` (f,) deg in the middle of
    the specimen; ``kinetic_share`` the largest from a quarter of the way on.
    """

    specimen: Specimen
    run: Run
    displacement: Array
    forces: dict[str, Array]
    shear: Array
    kinetic_share: float

    @property
    def stopped(self) -> str:
        """A sentence if the test ended early, else empty."""
        return self.run.stopped

    @property
    def steps(self) -> int:
        """The time steps up to the last reading."""
        return round(self.run.frames[-1].time / self.run.model.step)

    @property
    def balance_error(self) -> float:
        """The largest share of energy that was unaccounted for."""
        return self.run.balance_error

    @property
    def warnings(self) -> list[str]:
        """What the user should look at."""
        said = [self.stopped] if self.stopped else []
        if self.kinetic_share > SLOW:
            share = f"{100 * self.kinetic_share:.1f} %" if self.kinetic_share < 1.0 else "more than half"
            said.append(f"{share} of the energy is kinetic, so that inertia shows in the forces; take more steps")
        if (strain := yarn_strain(self)) > BREAKS:
            said.append(
                f"many yarns are strained by {100 * strain:.2g} % and more beyond their crimp at the end: no such "
                "yarn bears that; pull less far"
            )
        return said


def pull(
    specimen: Specimen,
    displacement: float,
    speed: float,
    steps: int = 60_000,
    frames: int = 50,
    progress: Callable[[float], None] | None = None,
    scale_mass: bool = True,
    sized_for: Cloth | None = None,
) -> Pulled:
    """Pull ``specimen`` by ``displacement`` mm at ``speed`` mm/min in ``steps`` steps, and read it ``frames`` times.

    Masses are scaled so that the steps are stable, unless ``scale_mass`` is false; for the cloth ``sized_for``, if
    one is given (see `make_model`). FormingError where a number is out of range.
    """
    if not (displacement > 0.0 and speed > 0.0 and np.isfinite(displacement) and np.isfinite(speed)):
        raise FormingError(f"displacement and speed must be above 0; got {displacement:g} mm and {speed:g} mm/min")
    if frames < 1 or steps < 4 * frames:
        raise FormingError(f"{steps} steps are too few for {frames} frames; take at least {4 * frames}")
    pace = speed / 60.0
    half = max(1, round(0.5 * steps / frames))
    duration = displacement / pace
    step = duration / (2 * half * frames)
    damping = DAMPING / duration
    model = make_model(specimen.sheet, specimen.cloth, step, specimen.held, damping, scale_mass, sized_for=sized_for)
    rest, way = model.sheet.points[model.driven], specimen.flow[model.driven]

    def path(time: float) -> Array:
        return rest + pace * time * way

    run = drive(model, path, 2 * half * frames, frames, pace * specimen.flow, progress, MEMORY * duration)
    return _read(specimen, run, pace)


def _read(specimen: Specimen, run: Run, pace: float) -> Pulled:
    forces = {
        name: np.array([np.sum(weights[run.model.driven] * f.reaction) for f in run.frames])
        for name, weights in specimen.readers.items()
    }
    shear = np.array([middle_shear(specimen.sheet, f.points) for f in run.frames])
    late = [f.ledger.kinetic_share for f in run.frames[1:] if f.time >= 0.25 * run.frames[-1].time]
    displacement = pace * np.array([f.time for f in run.frames])
    return Pulled(specimen, run, displacement, forces, shear, max(late, default=0.0))


def gradients(sheet: Sheet, points: Array) -> Array:
    """Deformation gradient of each triangle (m, 3, 2): images of the unit vectors along warp and weft."""
    flat, space = sheet.fabric[sheet.triangles], points[sheet.triangles]
    d = np.stack([flat[:, 1] - flat[:, 0], flat[:, 2] - flat[:, 0]], axis=-1)
    e = np.stack([space[:, 1] - space[:, 0], space[:, 2] - space[:, 0]], axis=-1)
    return np.asarray(e @ np.linalg.inv(d))


def shear_of(gradient: Array) -> Array:
    """Shear (…,) deg of deformation gradients (…, 3, 2): 90° less the angle between warp and weft."""
    warp, weft = gradient[..., 0], gradient[..., 1]
    sine = np.sum(warp * weft, axis=-1) / (np.linalg.norm(warp, axis=-1) * np.linalg.norm(weft, axis=-1))
    return np.rad2deg(np.arcsin(np.clip(sine, -1.0, 1.0)))


def middle_shear(sheet: Sheet, points: Array) -> float:
    """Shear, deg, of the mean deformation around the middle of the sheet at rest, over about two cells each way."""
    middle = 0.5 * (sheet.points.min(axis=0) + sheet.points.max(axis=0))
    away = np.linalg.norm(sheet.points[sheet.triangles].mean(axis=1) - middle, axis=1)
    reach = 2.0 * np.sqrt(sheet.areas.sum() / sheet.cells)
    near = away <= max(reach, float(away.min()) * 1.001)
    weights = (sheet.areas * near)[:, None, None]
    mean = (gradients(sheet, points) * weights).sum(axis=0) / weights.sum()
    return float(shear_of(mean))


def yarn_strain(pulled: Pulled) -> float:
    """Strain beyond the crimp that a tenth of the stiff yarns of a family reach at the end: stress over modulus.

    Not the largest: that at the corner of a clamp grows as the mesh is made finer.
    """
    _, tension, family = tensions(pulled)
    cloth, most = pulled.specimen.cloth, 0.0
    for number, fibre in enumerate(cloth.families):
        if fibre.modulus >= STIFF and fibre.share > 0.0:
            high = float(np.percentile(tension[family == number], 90.0))
            most = max(most, high / (fibre.modulus * fibre.share * cloth.thickness))
    return most


def tensions(pulled: Pulled) -> tuple[Array, Array, Whole]:
    """Ends (k, 2, 3) mm of the yarn pieces at the end, their tension (k,) N per mm of cloth, family (k,)."""
    model = pulled.run.model
    ends = pulled.run.frames[-1].points[model.ends]
    strain = np.log(np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1) / model.length)
    tension = np.empty(len(strain))
    for number, fibre in enumerate(model.cloth.families):
        mine = model.family == number
        tension[mine] = fibre_law.stress(fibre, strain[mine]) * fibre.share * model.cloth.thickness
    return ends, tension, model.family
