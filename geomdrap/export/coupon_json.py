"""coupon.json: what test specimens gave (schema geomdrap.coupon/1)."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geomdrap import __version__
from geomdrap.export.report_json import as_text, plain
from geomdrap.export.whole import write_whole

if TYPE_CHECKING:
    from geomdrap.forming.coupon import Coupon
    from geomdrap.forming.specimen import Pulled

SCHEMA = "geomdrap.coupon/1"
DIGITS = 9


def as_dict(coupons: Sequence[Coupon], files: Mapping[str, str | Path] | None = None) -> dict[str, Any]:
    """The JSON object: that of the first case, and all of them under ``cases`` if there are more."""
    document = {"schema": SCHEMA, "version": __version__, "test": coupons[0].test, **_case(coupons[0])}
    if len(coupons) > 1:
        document["cases"] = [_case(c) for c in coupons]
    document["files"] = {key: str(path) for key, path in (files or {}).items()}
    return document


def write(coupons: Sequence[Coupon], path: Path, files: Mapping[str, str | Path] | None = None) -> None:
    """Write coupon.json; the names of ``files`` are kept without their folder."""
    write_whole(path, as_text(as_dict(coupons, {k: Path(p).name for k, p in (files or {}).items()})))


def _case(coupon: Coupon) -> dict[str, Any]:
    pulled, sheet, model = coupon.result, coupon.result.specimen.sheet, coupon.result.run.model
    forces = {"force": next(iter(pulled.forces.values())), **pulled.forces}
    return significant(
        {
            "settings": coupon.settings,
            "cloth": asdict(pulled.specimen.cloth),
            "curve": {"displacement": pulled.displacement, **forces, "shear": pulled.shear},
            "energy": _energy(pulled),
            "mesh": {
                "nodes": len(sheet.fabric),
                "cells": sheet.cells,
                "triangles": len(sheet.triangles),
                "yarn_pieces": len(sheet.pieces),
            },
            "step": {"taken": model.step, "limit": model.limit, "mass_scale": model.mass_scale},
            "complete": not pulled.stopped,
            "warnings": pulled.warnings,
        }
    )


def _energy(pulled: Pulled) -> dict[str, float]:
    last = pulled.run.frames[-1].ledger
    return {
        "balance_error": pulled.balance_error,
        "kinetic_share": pulled.kinetic_share,
        **asdict(last),
        "internal": last.internal,
        "balance": last.balance,
    }


def significant(value: Any) -> Any:
    """Numpy values as JSON's own, floats to nine significant digits: forces and strains differ by powers of ten."""
    return plain(value, lambda number: float(f"{number:.{DIGITS}g}"))
