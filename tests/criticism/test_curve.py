"""A measured bias-extension curve: the theory, the effects on it, and the verdict with its doubt."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from geomdrap.criticism.curve import EFFECTS, Curve, pin_jointed, read_curves
from geomdrap.criticism.curve_fit import ar1_criterion, fit_curve
from geomdrap.criticism.curve_verdict import judge_curves
from geomdrap.errors import MeasurementError

TABLE = Path(__file__).parents[2] / "samples" / "measurements" / "bias-extension-plain-weave.csv"


@pytest.fixture(scope="module")
def curves():
    return read_curves(TABLE, 450.0, 150.0)


@pytest.fixture(scope="module")
def verdict(curves):
    return judge_curves(curves, 75.0)


def made(name, values, noise=0.0, n=40):
    pull = np.linspace(3.0, 105.0, n)
    shear = EFFECTS[name].model(pull, np.asarray(values), 300.0)
    return Curve("made", pull, shear + noise * np.random.default_rng(0).normal(size=n), 300.0)


@pytest.mark.parametrize(("pull", "shear"), [(5.58, 2.15), (50.62, 21.47), (106.55, 56.77)])
def test_the_theory_is_that_of_the_source(pull, shear):
    assert pin_jointed(np.array([pull]), 300.0)[0] == pytest.approx(shear, abs=0.01)


def test_a_strip_at_rest_has_no_shear_and_one_at_its_limit_ninety_degrees():
    assert pin_jointed(np.array([0.0, 300.0 * (np.sqrt(2.0) - 1.0)]), 300.0) == pytest.approx([0.0, 90.0], abs=1e-5)


@pytest.mark.parametrize(
    ("name", "values"),
    [
        ("slip", [0.12]),
        ("clamp slack", [4.0]),
        ("pre-shear", [-2.0]),
        ("constant extension", [0.01]),
        ("growing extension", [0.015]),
        ("saturation", [0.3, 12.0]),
        ("slack + slip from an onset", [3.0, 0.2, 30.0]),
    ],
)
def test_an_effect_that_made_the_curve_is_found_with_its_values(name, values):
    fit = fit_curve(EFFECTS[name], made(name, values), 75.0)
    assert fit.values == pytest.approx(values, rel=1e-3)
    assert fit.held_rms < 1e-3


def test_each_effect_lowers_the_shear():
    pull = np.array([60.0])
    for name in EFFECTS:
        values = np.array([{"pre-shear": -2.0}.get(name, p.high / 2.0) for p in EFFECTS[name].parameters])
        assert EFFECTS[name].model(pull, values, 300.0) <= pin_jointed(pull, 300.0)


@pytest.mark.parametrize(
    ("name", "rms", "held", "value"),
    [
        ("pin-jointed", 5.74, 8.87, None),
        ("clamp slack", 1.78, 4.08, 10.2),
        ("pre-shear", 2.97, 5.89, -4.9),
        ("constant extension", 1.39, 3.36, 0.029),
        ("saturation", 0.86, 2.97, 0.18),
        ("growing extension", 0.76, 0.91, 0.039),
        ("slip", 0.68, 0.44, 0.145),
        ("slack + slip from an onset", 0.33, 1.86, 6.0),
    ],
)
def test_the_errors_on_the_image_points_are_the_known_ones(verdict, name, rms, held, value):
    fit = verdict.fits["image"][name]
    assert fit.rms == pytest.approx(rms, abs=0.006)
    assert fit.held_rms == pytest.approx(held, abs=0.006)
    if value is not None:
        assert fit.values[0] == pytest.approx(value, rel=0.02)


def test_hand_readings_favour_saturation_and_differ_from_the_image_by_three_degrees(verdict):
    assert verdict.fits["hand"]["slip"].held_rms == pytest.approx(4.27, abs=0.01)
    assert verdict.fits["hand"]["saturation"].held_rms == pytest.approx(1.67, abs=0.01)
    assert verdict.disagreement == pytest.approx(3.2, abs=0.05)


def test_the_verdict_on_all_readings_is_ambiguous_and_says_why(verdict):
    assert verdict.verdict == "ambiguous"
    assert verdict.candidates == {"image": "slip", "hand": "saturation"}
    assert any("3.2 deg" in reason for reason in verdict.reasons)


def test_the_verdict_on_the_image_alone_is_slip_and_growing_extension_is_not_plausible(curves):
    alone = judge_curves({"image": curves["image"]}, 75.0)
    assert alone.verdict == "slip"
    assert not alone.fits["image"]["growing extension"].plausible
    assert np.isnan(alone.disagreement)


def test_a_curve_that_follows_the_theory_lacks_nothing():
    assert judge_curves({"made": made("pin-jointed", [], noise=0.1)}, 75.0).verdict in ("none", "pin-jointed")


def test_errors_of_a_smooth_misfit_follow_each_other(verdict):
    assert verdict.fits["image"]["slip"].autocorrelation > 0.95


def test_the_criterion_finds_the_autocorrelation_and_counts_parameters():
    rng = np.random.default_rng(2)
    errors = np.zeros(4000)
    for n in range(1, len(errors)):
        errors[n] = 0.6 * errors[n - 1] + rng.normal()
    rho, criterion = ar1_criterion(errors, 1)
    assert rho == pytest.approx(0.6, abs=0.04)
    assert ar1_criterion(errors, 3)[1] - criterion == pytest.approx(2.0 * np.log(4000))
    independent = len(errors) * (np.log(2.0 * np.pi * np.mean(errors**2)) + 1.0) + 3.0 * np.log(4000)
    assert criterion < independent - 1000.0


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", "header"),
        ("series,displacement,shear\n", "no points"),
        ("series,displacement,shear\nimage,1,x\n", "point 1"),
        ("series,displacement,shear\nimage,1,nan\n", "point 1"),
    ],
)
def test_a_bad_table_is_refused_with_its_name_and_what_to_do(tmp_path, text, says):
    path = tmp_path / "bad.csv"
    path.write_text(text)
    with pytest.raises(MeasurementError, match=says) as error:
        read_curves(path, 450.0, 150.0)
    assert "bad.csv" in str(error.value)


def test_a_strip_wider_than_long_is_refused():
    with pytest.raises(MeasurementError, match="longer than wide"):
        read_curves(TABLE, 150.0, 450.0)


def test_a_split_that_leaves_nothing_to_predict_is_refused(curves):
    with pytest.raises(MeasurementError, match="split"):
        judge_curves(curves, 500.0)


def test_the_mechanical_effects_run_no_case_twice(monkeypatch):
    from types import SimpleNamespace

    from geomdrap.criticism import curve_mechanical
    from geomdrap.forming import Cloth, Fibre

    runs, shares = [], []

    def pulled(cloth, furthest, *_, **__):
        runs.append((cloth.warp.modulus, cloth.warp.undulation))
        d = np.linspace(0.0, furthest, 9)
        return SimpleNamespace(result=SimpleNamespace(displacement=d, shear=pin_jointed(d, 120.0), stopped=""))

    monkeypatch.setattr(curve_mechanical, "bias_extension", pulled)
    straight = Fibre(undulation=0.0)
    effects = curve_mechanical.mechanical_effects(
        Cloth(straight, straight), 150.0, 30.0, 20.0, progress=shares.append
    )
    assert len(runs) == len(set(runs)) == 10
    assert shares == pytest.approx(np.arange(1, 11) / 10.0)
    assert next(iter(effects)) == "mechanical"


def test_a_run_of_the_mechanical_effects_that_diverged_is_named(monkeypatch):
    from types import SimpleNamespace

    from geomdrap.criticism import curve_mechanical
    from geomdrap.forming import Cloth

    def pulled(cloth, furthest, *_, **__):
        d = np.linspace(0.0, furthest, 9)
        stopped = "the run diverged at 3 s" if cloth.warp.modulus > 130_001.0 else ""
        return SimpleNamespace(result=SimpleNamespace(displacement=d, shear=pin_jointed(d, 120.0), stopped=stopped))

    monkeypatch.setattr(curve_mechanical, "bias_extension", pulled)
    with pytest.raises(curve_mechanical.DivergedError, match=r"yarns times 3.16 .* 0.005: the run diverged at 3 s"):
        curve_mechanical.mechanical_effects(Cloth(), 150.0, 30.0, 20.0)
