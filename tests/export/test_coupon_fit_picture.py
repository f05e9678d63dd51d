"""fit.png: a page for any number of series."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geomdrap.criticism.curve import EFFECTS, Curve, pin_jointed
from geomdrap.criticism.curve_verdict import judge_curves
from geomdrap.export.coupon_fit_picture import figure_of, write
from geomdrap.forming import Cloth
from geomdrap.forming.fit_coupon import CouponFit, FittedCurve
from geomdrap.forming.identify import identify

D = np.linspace(1.0, 20.0, 9)


def _fit(seed: int) -> CouponFit:
    """A fit of a straight line, as quick as can be."""
    noisy = {"force": 3.0 * D * (1.0 + 0.01 * np.random.default_rng(seed).normal(size=len(D)))}
    found = identify(lambda p: {"force": p["resin-modulus"] * D}, noisy, {"resin-modulus": 1.0})
    curve = FittedCurve("uniaxial", {}, D, noisy, dict(found.curves), found.rms)
    return CouponFit((curve,), Cloth(), found)


@pytest.mark.parametrize("judged", [False, True], ids=["parameters", "verdict"])
def test_eleven_series_have_a_page(judged: bool, tmp_path: Path) -> None:
    fits = {f"reading {n}": _fit(n) for n in range(11)}
    few = dict(list(EFFECTS.items())[:2])
    curves = {name: Curve(name, D, pin_jointed(D, 120.0) + 0.1 * n, 120.0) for n, name in enumerate(fits)}
    verdict = judge_curves(curves, 14.0, few) if judged else None
    left, right = figure_of(fits, verdict).axes
    labels = [t.get_text() for t in left.get_legend().get_texts()]
    assert labels == [f"{what} reading {n}" for n in range(11) for what in ("measured", "fitted")]
    if not judged:
        places = [line.get_ydata()[0] for line in right.lines if line.get_marker() == "o"]
        assert len(set(places)) == 11
        assert min(right.get_ylim()) < min(places) < max(places) < max(right.get_ylim())
    write(fits, verdict, tmp_path / "fit.png")
    assert (tmp_path / "fit.png").stat().st_size > 10_000
