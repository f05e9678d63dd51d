"""The mesh of a ply: crossings of yarns, triangles of resin, pieces of yarn that belong to cells.

Each cell owns a piece of yarn per side, with half the yarn section that lies between its sides. Pieces on a side that
two cells share lie double here, so that cells can be clipped one by one; a `Model` makes them one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from geomdrap.errors import FormingError

Array = NDArray[np.float64]
Whole = NDArray[np.int64]

DIAGONALS = ("alternate", "both")


@dataclass(frozen=True, eq=False)
class Sheet:
    """A meshed ply.

    ``fabric`` (n, 2) mm, u along warp and v along weft in the flat cloth; ``points`` (n, 3) mm at rest; ``triangles``
    (m, 3) and ``weight`` (m,), the share of the thickness that each stands for; ``pieces`` (k, 2) of yarn, ``family``
    (k,) 0 warp, 1 weft, and ``width`` (k,) mm of cloth whose yarn each stands for; ``cells`` counts the cells.
    """

    fabric: Array
    points: Array
    triangles: Whole
    weight: Array
    pieces: Whole
    family: Whole
    width: Array
    cells: int

    def moved(self, points: Array) -> Sheet:
        """The same cloth with its crossings at other places (n, 3) mm, at rest there."""
        return Sheet(
            self.fabric, np.asarray(points, dtype=np.float64), self.triangles, self.weight, self.pieces, self.family,
            self.width, self.cells,
        )  # fmt: skip

    @property
    def areas(self) -> Array:
        """Area of each triangle in the flat cloth (m,), mm², times its weight."""
        a, b, c = np.moveaxis(self.fabric[self.triangles], 1, 0)
        e, d = b - a, c - a
        return 0.5 * np.abs(e[:, 0] * d[:, 1] - e[:, 1] * d[:, 0]) * self.weight


def rectangle(warp: int, weft: int, pitch: float, diagonals: str = "alternate") -> Sheet:
    """A rectangular ply of ``warp`` × ``weft`` cells with sides of ``pitch`` mm, from the origin, flat at z = 0.

    ``diagonals``: ``alternate``, two triangles a cell, their diagonals in a chequered pattern; or ``both``, four
    triangles of half weight, which keeps every symmetry. Node i, j has number i (weft + 1) + j.
    """
    if min(warp, weft) < 1 or not pitch > 0.0:
        raise FormingError(f"a ply needs a cell or more with sides above 0 mm; got {warp} × {weft} of {pitch:g} mm")
    if diagonals not in DIAGONALS:
        raise FormingError(f"there are no diagonals '{diagonals}'; choose {', '.join(DIAGONALS)}")
    i, j = np.meshgrid(np.arange(warp + 1), np.arange(weft + 1), indexing="ij")
    fabric = pitch * np.stack([i.ravel(), j.ravel()], axis=1).astype(np.float64)
    number = np.arange(len(fabric)).reshape(i.shape)
    a, b, c, d = (x.ravel() for x in (number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]))
    odd = (i[:-1, :-1] + j[:-1, :-1]).ravel() % 2 == 1
    triangles, weight = _triangles(a, b, c, d, odd, diagonals)
    pieces = np.stack([np.stack(pair, axis=1) for pair in ((a, b), (d, c), (a, d), (b, c))], axis=1).reshape(-1, 2)
    family = np.tile(np.array([0, 0, 1, 1]), len(a))
    width = np.full(len(pieces), 0.5 * pitch)
    points = np.column_stack([fabric, np.zeros(len(fabric))])
    return Sheet(fabric, points, triangles, weight, pieces, family, width, len(a))


def _triangles(a: Whole, b: Whole, c: Whole, d: Whole, odd: NDArray[np.bool_], diagonals: str) -> tuple[Whole, Array]:
    """Triangles of the cells and their weights."""
    even = [np.stack([a, b, c], axis=1), np.stack([a, c, d], axis=1)]
    other = [np.stack([a, b, d], axis=1), np.stack([b, c, d], axis=1)]
    if diagonals == "both":
        all_four = np.stack([*even, *other], axis=1).reshape(-1, 3)
        return all_four, np.full(len(all_four), 0.5)
    pairs = np.where(odd[:, None, None], np.stack(other, axis=1), np.stack(even, axis=1))
    return pairs.reshape(-1, 3), np.ones(2 * len(a))
