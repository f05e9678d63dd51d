"""The result files of ``geomdrap coupon fit``: fit.json and fit.png."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geomdrap import __version__
from geomdrap.export import coupon_fit_picture
from geomdrap.export.coupon_json import significant
from geomdrap.export.report_json import as_text
from geomdrap.export.whole import whole_folder, write_whole

if TYPE_CHECKING:
    from geomdrap.criticism.curve_verdict import CurveVerdict
    from geomdrap.forming.fit_coupon import CouponFit, FittedCurve

SCHEMA = "geomdrap.coupon-fit/1"
FIT_OUTPUTS = {"json": "fit.json", "png": "fit.png"}


def as_dict(
    fits: Mapping[str, CouponFit], verdict: CurveVerdict | None = None, files: Mapping[str, str | Path] | None = None
) -> dict[str, Any]:
    """The JSON object: the fit of the first series, all of them under ``series``, and what the curves lack.

    A fit of several tests at once has them under ``tests``, the first as well as the others.
    """
    first = next(iter(fits.values()))
    document: dict[str, Any] = {"schema": SCHEMA, "version": __version__, "test": first.curves[0].test, **_fit(first)}
    if len(fits) > 1:
        document["series"] = {name: _fit(fit) for name, fit in fits.items()}
    if verdict is not None:
        document["lacks"] = significant(_lacks(verdict))
    document["files"] = {key: str(path) for key, path in (files or {}).items()}
    return document


def _fit(fit: CouponFit) -> dict[str, Any]:
    from geomdrap.forming.parameters import UNITS

    found, first = fit.identified, fit.curves[0]
    parameters = {
        name: {"value": value, "sigma": sigma, "low": low, "high": high, "unit": UNITS[name]}
        for name, value, sigma, (low, high) in zip(
            found.names, found.values, found.sigma, found.interval, strict=True
        )
    }
    return significant(
        {
            "parameters": parameters,
            "correlation": found.correlation,
            "rms": first.rms,
            "scatter": found.scatter,
            "readings": sum(len(curve.displacement) for curve in fit.curves),
            "runs": found.runs,
            "resized": found.resized,
            "converged": found.converged,
            "not_told_apart": [list(pair) for pair in found.confounded],
            "not_shown": found.loose,
            "further_tests": [
                {"test": a.name, "sigma": dict(zip(found.names, a.sigma, strict=True))} for a in fit.advice
            ],
            "fits_as_well": list(fit.rivals),
            "curve": _curve(first),
            **({"tests": [_test(curve) for curve in fit.curves]} if len(fit.curves) > 1 else {}),
        }
    )


def _test(curve: FittedCurve) -> dict[str, Any]:
    return {"test": curve.test, "settings": curve.settings, "rms": curve.rms, "curve": _curve(curve)}


def _curve(curve: FittedCurve) -> dict[str, Any]:
    return {"displacement": curve.displacement, "measured": curve.measured, "fitted": curve.fitted}


def _lacks(verdict: CurveVerdict) -> dict[str, Any]:
    return {
        "verdict": verdict.verdict,
        "candidates": verdict.candidates,
        "reasons": list(verdict.reasons),
        "effects": {
            series: {
                name: {
                    "rms": fit.rms,
                    "held_rms": fit.held_rms,
                    "plausible": fit.plausible,
                    "values": {p.name: v for p, v in zip(fit.effect.parameters, fit.values, strict=True)},
                }
                for name, fit in fits.items()
            }
            for series, fits in verdict.fits.items()
        },
    }


def write_fit(
    fits: Mapping[str, CouponFit], verdict: CurveVerdict | None, folder: Path, names: Iterable[str]
) -> dict[str, Path]:
    """Write the outputs ``names`` to ``folder``, all together or none; the path of each file by its key.

    Raises `GeomdrapError` if the folder cannot be written.
    """
    wanted = set(names)
    files = {key: folder / name for key, name in FIT_OUTPUTS.items() if key in wanted}
    if files:
        with whole_folder(folder) as scratch:
            if "json" in files:
                short = {key: path.name for key, path in files.items()}
                write_whole(scratch / FIT_OUTPUTS["json"], as_text(as_dict(fits, verdict, short)))
            if "png" in files:
                coupon_fit_picture.write(fits, verdict, scratch / FIT_OUTPUTS["png"])
    return files
