"""fit.png: measured and fitted curves of a test, and the parameters, or the errors of what the curves may lack."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

from geomdrap.export import palette
from geomdrap.export.compare_picture import save
from geomdrap.export.coupon_picture import COLOURS, bare

if TYPE_CHECKING:
    from geomdrap.criticism.curve_verdict import CurveVerdict
    from geomdrap.forming.fit_coupon import CouponFit, FittedCurve

UNITS = {"shear": "shear in the middle [deg]"}


def write(fits: Mapping[str, CouponFit], verdict: CurveVerdict | None, path: Path) -> None:
    """Write fit.png; no date or path in it. GeomdrapError if it cannot be written."""
    save(figure_of(fits, verdict), path)


def figure_of(fits: Mapping[str, CouponFit], verdict: CurveVerdict | None) -> Any:
    """The page: a plot per kind of reading, and what was found."""
    from matplotlib.figure import Figure

    first = next(iter(fits.values()))
    panels = [(n, kind) for n, curve in enumerate(first.curves) for kind in _kinds(curve)]
    figure = Figure(figsize=(6.0 * len(panels) + 6.5, 5.4), dpi=110, facecolor=palette.PAPER, layout="constrained")
    *plots, right = figure.subplots(1, len(panels) + 1)
    for axes, (number, kind) in zip(plots, panels, strict=True):
        _curves(axes, kind, {series: fit.curves[number] for series, fit in fits.items()})
        if len(first.curves) > 1:
            axes.set_title(first.curves[number].label, fontsize=9.5, color=palette.INK)
    if verdict is None:
        _parameters(right, fits)
    else:
        _errors(right, verdict)
    lacks = "" if verdict is None else f"; what it lacks: {_lack(verdict)}"
    tests = "tests, one cloth fitted to all" if len(first.curves) > 1 else "test, fitted"
    named = " and ".join(dict.fromkeys(curve.test for curve in first.curves))
    figure.suptitle(f"{named} {tests}{lacks}", fontsize=12, color=palette.INK)
    return figure


def _kinds(curve: FittedCurve) -> list[str]:
    """Kinds of readings: both forces of a biaxial test are one."""
    return list(dict.fromkeys("force" if c.startswith("force") else c for c in curve.measured))


def _lack(verdict: CurveVerdict) -> str:
    named = " or ".join(dict.fromkeys(verdict.candidates.values()))
    return f"ambiguous, {named}" if verdict.verdict == "ambiguous" else verdict.verdict


def _curves(axes: Any, kind: str, fits: Mapping[str, FittedCurve]) -> None:
    """Readings and what was fitted to them, by series."""
    number = 0
    for series, fit in fits.items():
        for column, values in fit.measured.items():
            if not column.startswith(kind):
                continue
            colour, side = COLOURS[number % len(COLOURS)], column.removeprefix(kind).strip("_")
            label = ", ".join(w for w in (side, series if len(fits) > 1 else "") if w)
            axes.plot(fit.displacement, values, "o", color=colour, markersize=3.5, label=f"measured {label}".strip())
            axes.plot(fit.displacement, fit.fitted[column], color=colour, label=f"fitted {label}".strip())
            number += 1
    axes.set(xlabel="displacement [mm]", ylabel=UNITS.get(kind, "force [N]"))
    axes.set_xlim(left=0.0)
    axes.set_ylim(bottom=0.0)
    axes.legend(frameon=False, fontsize=8.5)
    bare(axes)


def _parameters(axes: Any, fits: Mapping[str, CouponFit]) -> None:
    """Values over the first series' with their 95 % intervals."""
    from geomdrap.forming.parameters import UNITS as PARAMETER_UNITS

    first, apart = next(iter(fits.values())).identified, min(0.2, 0.8 / len(fits))
    for number, (series, fit) in enumerate(fits.items()):
        found = fit.identified
        for k, name in enumerate(found.names):
            low, high = found.interval[k] / first.values[k]
            middle, y = found.values[k] / first.values[k], k + apart * number
            colour = COLOURS[number % len(COLOURS)]
            axes.errorbar(middle, y, xerr=[[middle - low], [high - middle]], fmt="o", color=colour, capsize=4)
            words = f"{name} {found.values[k]:.4g} {PARAMETER_UNITS[name]}".strip()
            axes.annotate(
                words if len(fits) == 1 else f"{words} ({series})", (middle, y), (0, 8), textcoords="offset points",
                ha="center", fontsize=8.5, color=palette.INK,
            )  # fmt: skip
    axes.set(
        yticks=[], xlabel="value over the fitted one, with the 95 % interval", ylim=(-0.5, len(first.names) - 0.2)
    )
    axes.margins(x=0.3)
    axes.invert_yaxis()
    bare(axes)


def _errors(axes: Any, verdict: CurveVerdict) -> None:
    """Errors of each effect and series: of the fit to all points, and of the held-out ones."""
    names = list(next(iter(verdict.fits.values())))
    height = 0.8 / (2 * len(verdict.fits))
    for number, (series, fits) in enumerate(verdict.fits.items()):
        at = [k + (2 * number - len(verdict.fits) + 0.5) * height for k in range(len(names))]
        held, whole = ([getattr(fits[name], key) for name in names] for key in ("held_rms", "rms"))
        colour = COLOURS[number % len(COLOURS)]
        axes.barh(at, held, height, color=colour, label=f"{series}: held out")
        axes.barh([y + height for y in at], whole, height, color=colour, alpha=0.4, label=f"{series}: all points")
        for y, name, error in zip(at, names, held, strict=True):
            mark = "" if fits[name].plausible else " (values not plausible)"
            best = "  best" if name == verdict.candidates[series] else ""
            axes.text(error, y, f" {error:.2f}{mark}{best}", va="center", fontsize=7, color=palette.INK)
    axes.set(yticks=range(len(names)), yticklabels=names, xlabel="root mean square error of the shear [deg]")
    axes.margins(x=0.35)
    axes.set_xlim(left=0.0)
    axes.invert_yaxis()
    axes.legend(frameon=False, fontsize=8)
    bare(axes)
