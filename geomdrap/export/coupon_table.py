"""coupon.csv: the curves of test specimens, a row per reading."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from geomdrap.export.whole import write_whole

if TYPE_CHECKING:
    from geomdrap.forming.coupon import Coupon


def write(coupons: Sequence[Coupon], path: Path) -> None:
    """Write the table: case, displacement mm, forces N, shear deg. GeomdrapError if it cannot be written."""
    names = list(coupons[0].result.forces)
    lines = [",".join(["case", "displacement", *names, "shear"])]
    for number, coupon in enumerate(coupons, 1):
        pulled = coupon.result
        columns = [pulled.displacement, *pulled.forces.values(), pulled.shear]
        lines += [",".join([str(number), *(f"{x:.9g}" for x in row)]) for row in zip(*columns, strict=True)]
    write_whole(path, "\n".join([*lines, ""]))
