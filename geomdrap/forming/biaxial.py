"""The biaxial test: a square sheet, a grip on each side, both pairs pulled apart at once.

A. Cherouat, H. Borouchaki, Materials 2 (2009) 1835, section 3.2: 250 × 250 mm with corners rounded by 50 mm, 200 mm
between the grips, 400 cells with 1,600 pieces of yarn. Read as 20 × 20 cells of 10 mm between the grips, each of
which holds the 150 mm that the rounding leaves of its side.
"""

from __future__ import annotations

import numpy as np

from geomdrap.errors import FormingError
from geomdrap.forming.cloth import Cloth, Fibre, Resin
from geomdrap.forming.relaxation import ELASTIC
from geomdrap.forming.sheet import rectangle
from geomdrap.forming.specimen import Specimen

JERSEY = Cloth(
    warp=Fibre(modulus=32.1, undulation=0.2, compression=0.01),
    weft=Fibre(modulus=92.6, undulation=0.2, compression=0.01),
    resin=Resin(modulus=0.3, poisson=0.45, relaxation=ELASTIC),
    thickness=0.744,
    density=3.09e-10,
)
"""The knit of the paper's test: thickness and mass from its Table 2; moduli so chosen that the forces at 140 mm are
its 620 and 1,180 N, since those that it used are not in it."""


def biaxial_specimen(
    cloth: Cloth = JERSEY, size: float = 200.0, grip: float = 150.0, cells: int = 20, ratio: float = 1.0
) -> Specimen:
    """A square of ``size`` mm, ``cells`` × ``cells`` cells, between grips of ``grip`` mm; the warp along x.

    A displacement is by how much the grips on the warp open; those on the weft open ``ratio`` times as much. Forces
    are ``force_warp`` and ``force_weft``, the means of the two grips.
    """
    if not (size > 0.0 and 0.0 < grip <= size and cells >= 2 and ratio >= 0.0):
        raise FormingError(
            "a biaxial specimen needs a size above 0 mm, grips no wider, 2 cells or more, a ratio of 0 or more; got "
            f"{size:g}, {grip:g}, {cells} and {ratio:g}"
        )
    sheet = rectangle(cells, cells, size / cells, "both")
    sheet = sheet.moved(sheet.points - [0.5 * size, 0.5 * size, 0.0])
    flow = sheet.points / size * [1.0, ratio, 0.0]
    held, readers = [], {}
    for axis, name in enumerate(("force_warp", "force_weft")):
        out, along = sheet.points[:, axis], sheet.points[:, 1 - axis]
        chosen = np.flatnonzero(
            (np.abs(out) > 0.5 * size * (1.0 - 1e-9)) & (np.abs(along) < 0.5 * grip * (1.0 + 1e-9))
        )
        flow[chosen, 1 - axis] = 0.0
        readers[name] = np.zeros_like(sheet.points)
        readers[name][chosen, axis] = 0.5 * np.sign(out[chosen])
        held.append(chosen)
    return Specimen(sheet, cloth, np.unique(np.concatenate(held)), flow, readers)
