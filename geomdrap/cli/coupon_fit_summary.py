"""What ``geomdrap coupon fit`` says: warnings, parameters, and what the curves lack."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from geomdrap.criticism.curve_verdict import CurveVerdict
    from geomdrap.forming.fit_coupon import CouponFit, FittedCurve
    from geomdrap.forming.further import Advice

UNLIKE = 0.3
"""Share of the readings that a fit may leave before it is no description of the test."""
HELPS = 0.8
"""Share of a sigma below which a further test has to bring it to be worth a word."""


def warnings_of(name: str, found: CouponFit) -> list[str]:
    """What the user should look at."""
    known = found.identified
    said = [] if known.converged else [f"{name}: the fit did not come to an end; what it had is kept"]
    said += [
        f"{name}: the fit leaves {100.0 * share:.0f} % of the {column}: this is not the test that was measured; "
        "check its settings (angle, length, width, speed) and the units of the table"
        for column, share in _left(found).items()
        if share > UNLIKE
    ]
    if known.resized:
        again = "with masses and steps for a cloth stiffer than it began with"
        said.append(f"{name}: the fit started over {_times(known.resized)}, {again}")
    for rival in found.rivals:
        values = ", ".join(f"{n} {v:.4g}" for n, v in rival.items())
        said.append(f"{name}: other values fit about as well: {values}; only other readings can choose")
    said += [f"{name}: {a} and {b} are not told apart (correlation {c:.2f})" for a, b, c in known.confounded]
    said += [f"{name}: {one} is not shown by these readings" for one in known.loose]
    return said + _advised(name, found)


def _left(found: CouponFit) -> dict[str, float]:
    """Share of the readings that the fit leaves, by column: of each force, and of the shear as a whole.

    Readings of shear count by what a camera errs by (see `identify.scales`), which is no share of their size.
    """
    import numpy as np

    left = {c: share for c, share in found.identified.scatter.items() if c.startswith("force")}
    for curve in found.curves:
        if "shear" in curve.measured:
            size = float(np.sqrt(np.nanmean(curve.measured["shear"] ** 2)))
            left["shear"] = max(left.get("shear", 0.0), curve.rms["shear"] / size)
    return left


def _advised(name: str, found: CouponFit) -> list[str]:
    """Which further test would tell most about what is not known, by the test."""
    known = found.identified
    best: dict[str, Advice] = {}
    gains: dict[str, list[str]] = {}
    for one in dict.fromkeys([*known.loose, *(n for a, b, _ in known.confounded for n in (a, b))]):
        k = known.names.index(one)
        advice = min(found.advice, key=lambda a: float(a.sigma[k]), default=None)
        if advice is not None and advice.sigma[k] < HELPS * known.sigma[k]:
            before, after = (100.0 * s / known.values[k] for s in (known.sigma[k], advice.sigma[k]))
            best[advice.name] = advice
            gains.setdefault(advice.name, []).append(f"{one} from {_share(before)} to {_share(after)}")
    return [
        f"{name}: a {test} test on top would bring sigma of {', of '.join(gains[test])}; fit both with --also "
        f"{_also(advice)}"
        for test, advice in best.items()
    ]


def _share(percent: float) -> str:
    return f"{percent:.2g} %" if percent < 100.0 else "more than 100 %"


def _also(advice: Advice) -> str:
    return f"{advice.test}:FILE.csv:" + ",".join(f"{k}={v:g}" for k, v in advice.settings.items())


def _times(count: int) -> str:
    return "once" if count == 1 else f"{count} times"


def summary_of(fits: Mapping[str, CouponFit], verdict: CurveVerdict | None) -> list[str]:
    """Residuals and parameters by series, then what the curves lack."""
    from geomdrap.forming.parameters import UNITS

    lines = []
    for series, found in fits.items():
        known = found.identified
        lines += [f"{curve.label}, {series}: {_residual(curve)}" for curve in found.curves]
        for name, value, sigma, (low, high) in zip(
            known.names, known.values, known.sigma, known.interval, strict=True
        ):
            share = _share(100.0 * sigma / value)
            lines.append(
                f"  {name:15} {f'{value:.5g} {UNITS[name]}'.strip()} (95 %: {low:.4g} to {high:.4g}; sigma {share})"
            )
    return lines if verdict is None else [*lines, *_story(verdict)]


def _residual(curve: FittedCurve) -> str:
    rms = ", ".join(f"{c.replace('_', ' ')} {v:.3g} {'deg' if c == 'shear' else 'N'}" for c, v in curve.rms.items())
    return f"residual {rms} (rms, {len(curve.displacement)} readings)"


def _story(verdict: CurveVerdict) -> list[str]:
    lines = []
    for series, table in verdict.fits.items():
        lines.append(f"{series + ': on top of the given cloth':44} rms  held out")
        for name, one in table.items():
            pairs = zip(one.effect.parameters, one.values, strict=True)
            values = ", ".join(f"{p.name} {v:.3g} {p.unit}".strip() for p, v in pairs)
            doubt = "" if one.plausible else " (not plausible, here or in the first part)"
            lines.append(f"  {name:40} {one.rms:5.2f} {one.held_rms:5.2f}  {values}{doubt}")
    lines.append(f"verdict: {verdict.verdict}" + (f" ({', '.join(dict.fromkeys(verdict.candidates.values()))})"))
    return [*lines, *(f"  {reason}" for reason in verdict.reasons)]
