"""The result files of ``geomdrap coupon``."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from geomdrap.export import coupon_json, coupon_picture, coupon_table
from geomdrap.export.whole import whole_folder

if TYPE_CHECKING:
    from geomdrap.forming.coupon import Coupon

COUPON_OUTPUTS = {"json": "coupon.json", "csv": "coupon.csv", "png": "coupon.png"}


def write_coupons(coupons: Sequence[Coupon], folder: Path, names: Iterable[str]) -> dict[str, Path]:
    """Write the outputs ``names`` to ``folder``, all together or none; the path of each file by its key.

    Raises `GeomdrapError` if the folder cannot be written.
    """
    wanted = set(names)
    files = {key: folder / name for key, name in COUPON_OUTPUTS.items() if key in wanted}
    if not files:
        return files
    with whole_folder(folder) as scratch:
        for key, path in files.items():
            if key == "json":
                coupon_json.write(coupons, scratch / path.name, files)
            elif key == "csv":
                coupon_table.write(coupons, scratch / path.name)
            else:
                coupon_picture.write(coupons, scratch / path.name)
    return files
