"""nodes.csv: the net as a table, a row per node."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from geomdrap.export.whole import write_whole

if TYPE_CHECKING:
    from geomdrap.fields import Drape
    from geomdrap.fishnet import Net

HEADER = "i,j,u,v,x,y,z,shear,status\n"
_ROW = "%d,%d,%.6f,%.6f,%.6f,%.6f,%.6f,%.6f,%s\n"


def write(result: Drape, path: Path) -> None:
    """Write nodes.csv: i, j count nodes from the origin; u, v, x, y, z in mm; shear in degrees.

    Absent nodes that the front tried have a row too, with empty coordinates and the reason as status.
    Six decimals, ``\\n`` line ends, the same bytes for the same net.
    """
    write_whole(path, as_text(result.net))


def as_text(net: Net) -> str:
    """Give the table as text, rows in the order of i, then j."""
    row, column = np.nonzero(_listed(net))
    status = net.status[row, column]
    numbers = np.column_stack([net.u[row], net.v[column], net.points[row, column], net.shear[row, column]])
    numbers = np.round(numbers, 6) + 0.0  # + 0.0 turns −0.000000 into 0.000000
    i = row - int(np.argmin(np.abs(net.u)))
    j = column - int(np.argmin(np.abs(net.v)))
    columns = [i.tolist(), j.tolist(), *(values.tolist() for values in numbers.T), _texts(status)]
    cells = [cell for line in zip(*columns, strict=True) for cell in line]
    # one big format is several times faster than one per row
    return HEADER + (_ROW * len(row) % tuple(cells)).replace(",nan", ",")


def _listed(net: Net) -> np.ndarray:
    """Tell which nodes have a row: the present ones, and those that were tried and failed."""
    from geomdrap.fishnet import Status

    return np.isfinite(net.points).all(axis=2) | (net.status != Status.UNREACHED)


def _texts(status: np.ndarray) -> list[str]:
    """Give the reason of each status (k,), quoted where it holds a comma."""
    from geomdrap.fishnet import Status

    reasons = {code: Status(code).reason for code in np.unique(status).tolist()}
    quoted = {code: f'"{text}"' if "," in text else text for code, text in reasons.items()}
    return [quoted[code] for code in status.tolist()]
