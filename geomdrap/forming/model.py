"""What stays the same during a run: sheet, cloth, masses, laws, packed for the kernels."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import FormingError
from geomdrap.forming import membrane, truss
from geomdrap.forming.cloth import STRAIN_FORMS, Cloth
from geomdrap.forming.membrane import WIDTH
from geomdrap.forming.sheet import Sheet
from geomdrap.forming.stable_step import SAFETY, mass_for_step, physical_mass, row_sums, stable_step

Array = NDArray[np.float64]
Whole = NDArray[np.int64]


@dataclass(frozen=True, eq=False)
class Model:
    """A ply ready to be stepped; nothing in it changes.

    ``driven`` (d,) numbers of the nodes whose path is given, ``free`` (n,) whether each is not; ``mass`` (n,) t, as
    scaled, ``mass_scale`` by how much the mass of the sheet has grown; ``step`` s and ``limit`` s, the bound on it;
    ``damping`` 1/s. The rest is packed for the kernels: see `membrane` and `truss`. ``ends``, ``section`` mm²,
    ``length`` mm and ``family`` are those of the yarn pieces with coincident ones made one.
    """

    sheet: Sheet
    cloth: Cloth
    driven: Whole
    free: NDArray[np.bool_]
    mass: Array
    mass_scale: float
    step: float
    limit: float
    damping: float
    corners: NDArray[np.uint64]
    shape: Array
    law: Array
    keep: Array
    take: Array
    ends: NDArray[np.uint64]
    family: Whole
    section: Array
    length: Array
    truss_law: Array


def make_model(
    sheet: Sheet,
    cloth: Cloth,
    step: float | None = None,
    driven: Whole | list[int] | None = None,
    damping: float = 0.0,
    scale_mass: bool = True,
    safety: float = SAFETY,
    sized_for: Cloth | None = None,
) -> Model:
    """Pack ``sheet`` and ``cloth`` for stepping by ``step`` s.

    With ``scale_mass`` nodes are made heavier where the step asks for it, so that it is ``safety`` times the bound;
    without, FormingError where the step is over the bound. ``step`` None: ``safety`` times the bound of the masses as
    they are. ``damping`` 1/s: forces of −damping × mass × velocity. ``sized_for``: masses are scaled as this cloth
    needs, so that runs of cloths that are no stiffer have the same; None: as ``cloth`` does.
    """
    if damping < 0.0 or not 0.0 < safety <= 1.0 or (step is not None and not step > 0.0):
        raise FormingError(
            f"a step above 0 s, a safety between 0 and 1 and a damping of 0 1/s or more are needed; got {step}, "
            f"{safety:g} and {damping:g}"
        )
    where = np.unique(np.asarray([] if driven is None else driven, dtype=np.int64))
    free = np.ones(len(sheet.fabric), dtype=bool)
    free[where] = False
    natural, rows = physical_mass(sheet, cloth), row_sums(sheet, cloth)
    mass = natural
    if step is None:
        step = safety * stable_step(natural, rows, free)
    elif scale_mass:
        needed = rows if sized_for is None else row_sums(sheet, sized_for)
        mass = mass_for_step(natural, needed, step, safety)
    limit = stable_step(mass, rows, free)
    if not step <= limit * (1.0 + 1e-9):
        raise FormingError(
            f"the step of {step:.3g} s is over the stable limit of {limit:.3g} s; take more steps, or let the mass "
            "be scaled"
        )
    ends, family, section, length = _merged_pieces(sheet, cloth)
    keep, take = cloth.resin.relaxation.factors(step)
    return Model(
        sheet, cloth, where, free, mass, float(mass.sum() / natural.sum()), step, limit, damping,
        sheet.triangles.astype(np.uint64), _blocks(_shape_rows(sheet, cloth)), _membrane_law(cloth), keep, take,
        ends.astype(np.uint64), family, section, length, _blocks(_truss_rows(cloth, family, section, length)),
    )  # fmt: skip


def _blocks(rows: Array) -> Array:
    """Rows of numbers per element (r, m) as blocks (b, r × WIDTH); the last is filled up with its last element."""
    count = rows.shape[1]
    index = np.minimum(np.arange(-(-count // WIDTH) * WIDTH), count - 1)
    return np.ascontiguousarray(np.swapaxes(rows[:, index].reshape(len(rows), -1, WIDTH), 0, 1)).reshape(
        -1, len(rows) * WIDTH
    )


def _shape_rows(sheet: Sheet, cloth: Cloth) -> Array:
    """Inverse of the reference edges and the volume of each triangle (5, m)."""
    a, b, c = np.moveaxis(sheet.fabric[sheet.triangles], 1, 0)
    inverse = np.linalg.inv(np.stack([b - a, c - a], axis=-1))
    volume = cloth.thickness * sheet.areas
    return np.stack([inverse[:, 0, 0], inverse[:, 0, 1], inverse[:, 1, 0], inverse[:, 1, 1], volume])


def _membrane_law(cloth: Cloth) -> Array:
    resin = cloth.resin
    law = np.zeros(5)
    law[membrane.PLANE], law[membrane.POISSON] = resin.plane_modulus, resin.poisson
    law[membrane.REMAINING] = resin.relaxation.remaining
    law[membrane.CONSTANT] = float(resin.thickness == "constant")
    law[membrane.FORM] = float(STRAIN_FORMS.index(resin.strain))
    return law


def _merged_pieces(sheet: Sheet, cloth: Cloth) -> tuple[Whole, Whole, Array, Array]:
    """Ends, family, section mm² and length mm of the yarn pieces; those between the same nodes are one."""
    ordered = np.column_stack([np.sort(sheet.pieces, axis=1), sheet.family])
    unique, inverse = np.unique(ordered, axis=0, return_inverse=True)
    share = np.array([f.share for f in cloth.families])[sheet.family]
    section = np.bincount(inverse.ravel(), share * cloth.thickness * sheet.width, len(unique))
    ends = np.ascontiguousarray(unique[:, :2])
    length = np.asarray(np.linalg.norm(np.diff(sheet.fabric[ends], axis=1)[:, 0], axis=1), dtype=np.float64)
    return ends.astype(np.int64), unique[:, 2].astype(np.int64), section.astype(np.float64), length


def _truss_rows(cloth: Cloth, family: Whole, section: Array, length: Array) -> Array:
    """Numbers of the law of each yarn piece (5, k), see `truss`."""
    modulus, undulation, push = (
        np.array([getattr(f, name) for f in cloth.families])[family]
        for name in ("modulus", "undulation", "compression")
    )
    per = np.divide(1.0, undulation, out=np.zeros_like(undulation), where=undulation > 0.0)
    rows = np.zeros((truss.LAW_ROWS, len(length)))
    for at, values in (
        (truss.PER_LENGTH, 1.0 / length),
        (truss.STIFFNESS, modulus * section),
        (truss.UNDULATION, undulation),
        (truss.PER_UNDULATION, per),
        (truss.PUSH, push),
    ):
        rows[at // WIDTH] = values
    return rows
