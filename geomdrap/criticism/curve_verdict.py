"""Which effect a measured curve lacks: by what foretells held-out points, for every way it was read."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from geomdrap.criticism.curve import EFFECTS, Curve, CurveEffect
from geomdrap.criticism.curve_fit import CurveFit, fit_curve

GAIN = 0.03  # of the theory's held-out error: the least that an effect must win
THEORY = next(iter(EFFECTS))


@dataclass(frozen=True)
class CurveVerdict:
    """The verdict on a curve.

    ``verdict``: an effect, ``none`` or ``ambiguous``; ``candidates`` by series, what foretells each best;
    ``fits``: series -> effect -> fit; ``disagreement``: the largest difference of two series, deg, NaN for one
    series; ``reasons``: sentences.
    """

    verdict: str
    candidates: dict[str, str]
    fits: dict[str, dict[str, CurveFit]]
    disagreement: float
    reasons: tuple[str, ...]


def judge_curves(
    curves: Mapping[str, Curve], split: float, effects: Mapping[str, CurveEffect] = EFFECTS
) -> CurveVerdict:
    """Fit every one of ``effects`` to every series up to ``split`` mm and let it predict the rest.

    The first of ``effects`` is the theory, the others what it may lack (see `effects_on`).
    Only single causes in their physical range can win; where the series name different ones, or deny each other,
    the verdict is ``ambiguous``. MeasurementError where a series cannot be split so.
    """
    fits = {
        series: {name: fit_curve(effect, curve, split) for name, effect in effects.items()}
        for series, curve in curves.items()
    }
    winners = {name: _winner(table) for name, table in fits.items()}
    apart = disagreement(list(curves.values()))
    named = set(winners.values())
    verdict = "ambiguous" if len(named) > 1 else named.pop()
    return CurveVerdict(verdict, winners, fits, apart, tuple(_reasons(fits, winners, apart)))


def _winner(table: Mapping[str, CurveFit]) -> str:
    theory = next(iter(table.values()))
    able = [theory, *(fit for fit in table.values() if fit.plausible and fit.effect.single)]
    best = min(able, key=lambda fit: fit.held_rms)
    enough = best is not theory and best.held_rms < (1.0 - GAIN) * theory.held_rms
    return best.effect.name if enough else "none"


def disagreement(curves: list[Curve]) -> float:
    """The largest difference, deg, between the first curve, taken straight between its points, and the others."""
    first, *others = curves
    apart = [
        np.abs(np.interp(c.displacement, first.displacement, first.shear, np.nan, np.nan) - c.shear) for c in others
    ]
    return float(np.nanmax(np.concatenate(apart))) if apart else float("nan")


def _reasons(fits: Mapping[str, Mapping[str, CurveFit]], winners: Mapping[str, str], apart: float) -> list[str]:
    said = []
    for series, name in winners.items():
        table = fits[series]
        if name == "none":
            said.append(f"{series}: no effect foretells the held-out points better than the theory")
            continue
        before, after = next(iter(table.values())).held_rms, table[name].held_rms
        said.append(f"{series}: {name} foretells the held-out points best, {before:.2f} -> {after:.2f} deg")
        better = [f for f in table.values() if f.held_rms < after and not f.plausible]
        said += [f"{series}: {f.effect.name} would do better, but with values that no cloth has" for f in better]
    if np.isfinite(apart):
        said.append(f"the series differ by up to {apart:.1f} deg")
    if len(set(winners.values())) > 1:
        said.append("they name different causes: mark yarn ends and measure how far they draw in, to tell slip apart")
    return said
