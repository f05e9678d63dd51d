"""``geomdrap coupon``: what it prints and writes, and what it refuses."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result

QUICK = ("--cells", 4, "--steps", 800, "--frames", 8, "--outputs", "none")


def test_the_frame_gives_a_reading_at_each_shear_that_was_asked_for(run: Callable[..., Result]) -> None:
    result = run(
        "coupon", "picture-frame", "--side", 100, "--thickness", 2, "--shear", "10,30,45", "--elastic", "--json"
    )
    document = json.loads(result.stdout)
    assert result.exit_code == 0
    assert document["schema"] == "geomdrap.coupon/1"
    curve = document["curve"]
    assert curve["shear"] == pytest.approx([0.0, 10.0, 30.0, 45.0], abs=1e-7)
    assert curve["force"][1:] == pytest.approx([894.40, 5295.88, 17518.13], abs=0.005)
    assert 0.0 <= document["energy"]["balance_error"] < 1e-6
    assert {Path(f).name for f in document["files"].values()} == {"coupon.json", "coupon.csv", "coupon.png"}


def test_the_settings_are_those_of_the_run_that_was_made(run: Callable[..., Result]) -> None:
    options = ("--cells", 4, "--steps", 810, "--frames", 8, "--displacement", 5, "--outputs", "none", "--json")
    for test in ("uniaxial", "bias-extension", "biaxial"):
        document = json.loads(run("coupon", test, *options).stdout)
        settings = document["settings"]
        taken = settings["displacement"] / (settings["speed"] / 60.0) / document["step"]["taken"]
        assert settings["steps"] == pytest.approx(taken, rel=1e-7)
        assert settings["steps"] != 810  # frames need a whole and even number each
        assert (settings["cells"], settings["frames"], settings["keep_mass"]) == (4, 8, False)


def test_the_files_hold_what_was_printed(run: Callable[..., Result], tmp_path: Path) -> None:
    result = run("coupon", "picture-frame", "--shear", "10,20", "-o", "frame", "--json")
    printed = json.loads(result.stdout)
    written = json.loads((tmp_path / "frame" / "coupon.json").read_text(encoding="utf-8"))
    assert written["curve"] == printed["curve"]
    table = np.genfromtxt(tmp_path / "frame" / "coupon.csv", delimiter=",", names=True)
    assert table["force"] == pytest.approx(printed["curve"]["force"], rel=1e-8)
    assert (tmp_path / "frame" / "coupon.png").stat().st_size > 10_000


def test_lists_of_settings_make_a_case_for_each_combination(run: Callable[..., Result], tmp_path: Path) -> None:
    options = ("--angle", "0,45", "--speed", "20,80", "--displacement", 2, *QUICK[:-2], "--outputs", "csv,png")
    result = run("coupon", "uniaxial", *options, "--json")
    cases = json.loads(result.stdout)["cases"]
    assert [(c["settings"]["angle"], c["settings"]["speed"]) for c in cases] == [(0, 20), (0, 80), (45, 20), (45, 80)]
    assert cases[0]["curve"]["force"][-1] > 10 * cases[2]["curve"]["force"][-1]
    rows = (tmp_path / "coupon" / "coupon.csv").read_text(encoding="utf-8").splitlines()
    assert rows[0] == "case,displacement,force,shear"
    assert len(rows) == 1 + 4 * 9


def test_the_summary_names_the_case_the_force_and_the_energy(run: Callable[..., Result]) -> None:
    result = run("coupon", "bias-extension", "--displacement", 10, "--elastic", "--fibre-modulus", 5000, *QUICK)
    assert "bias-extension: speed 20" in result.stdout
    assert "at 10 mm: force " in result.stdout
    assert "% of the energy unaccounted for" in result.stdout


def test_a_biaxial_test_has_two_forces(run: Callable[..., Result]) -> None:
    options = ("--ratio", 0.5, "--warp-modulus", 40, "--weft-modulus", 40, "--undulation", 0.1, "--displacement", 50)
    curve = json.loads(run("coupon", "biaxial", *options, *QUICK, "--json").stdout)["curve"]
    assert curve["force_warp"][-1] > curve["force_weft"][-1] > 0.0
    assert curve["force"] == curve["force_warp"]


def test_quiet_prints_nothing(run: Callable[..., Result]) -> None:
    result = run("coupon", "picture-frame", "--shear", "10", "--quiet", "--outputs", "none")
    assert (result.exit_code, result.output) == (0, "")


def test_a_test_with_too_few_steps_says_that_inertia_shows(run: Callable[..., Result]) -> None:
    result = run("coupon", "bias-extension", "--displacement", 20, *QUICK)
    assert "of the energy is kinetic" in result.stderr


def test_a_test_that_diverges_keeps_what_it_had_and_ends_with_1(
    run: Callable[..., Result], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("geomdrap.forming.model.mass_for_step", lambda mass, rows, step, _: rows * (step / 3.0) ** 2)
    monkeypatch.setattr("geomdrap.forming.model.stable_step", lambda *_: np.inf)
    result = run("coupon", "bias-extension", "--displacement", 20, *QUICK, "--json")
    document = json.loads(result.stdout)
    assert result.exit_code == 1
    assert document["complete"] is False
    assert "diverged at" in document["warnings"][0]
    assert "near u =" in result.stderr
    assert 2 <= len(document["curve"]["displacement"]) < 9  # frames before it, and not all


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--resin-modulus", "-5"), "the resin modulus must be 0 MPa or more; got -5"),
        (("--fibre-modulus", "-5"), "the fibre modulus must be 0 MPa or more; got -5"),
        (("--poisson", "0.5"), "Poisson's ratio must lie above -1 and below 0.5; got 0.5"),
        (("--prony", "10=0.1,1=0.2"), "relaxation times must ascend; sort 10, 1, with their shares"),
        (("--prony", "10=0.1", "--elastic"), "leave out --relaxation and --elastic"),
        (("--prony", "10"), "pairs of numbers"),
        (("--speed", "0"), "displacement and speed must be above 0; got 30 mm and 0 mm/min"),
        (("--steps", "10"), "10 steps are too few for 50 frames; take at least 200"),
        (("--cells", "1"), "1 is not in the range x>=2"),
        (("--relaxation", "creep", "--elastic"), "--elastic and --relaxation creep contradict each other"),
        (("--keep-mass",), "over the stable limit of "),
        (("--thickness", "0"), "the thickness of the cloth must be above 0 mm"),
        (("--displacement", "nan"), "not a finite number"),
        (("--relaxation", "fast"), "is not one of"),
    ],
)
def test_bad_input_is_refused_in_one_sentence(error_of: Callable[..., str], options: tuple, said: str) -> None:
    assert said in error_of("coupon", "bias-extension", *options)


def test_a_list_that_is_not_numbers_is_refused(error_of: Callable[..., str]) -> None:
    assert "not a finite number, or several with commas" in error_of("coupon", "picture-frame", "--shear", "10,x")


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--speed", "20,-1"), "a speed must be above 0 mm/min; got -1"),
        (("--angle", "45,100"), "an angle lies between 0 and 90 degrees; got 100"),
        (("--undulation", "0,-1"), "the undulation must be 0 (a strain) or more; got -1"),
    ],
)
def test_a_list_is_checked_before_its_first_case_is_pulled(
    error_of: Callable[..., str], monkeypatch: pytest.MonkeyPatch, options: tuple, said: str
) -> None:
    def never(*_: object, **__: object) -> None:
        raise AssertionError("a case was pulled")

    monkeypatch.setattr("geomdrap.forming.coupon.uniaxial", never)
    assert said in error_of("coupon", "uniaxial", *options)


def test_yarns_that_would_have_broken_are_warned_of(run: Callable[..., Result]) -> None:
    strip = ("coupon", "uniaxial", "--angle", 0, "--cells", 2, "--steps", 4000, "--frames", 8, "--outputs", "none")
    assert "beyond their crimp at the end: no such yarn bears that" in run(*strip, "--displacement", 30).stderr
    assert "crimp" not in run(*strip, "--displacement", 3).stderr


def test_an_unknown_test_is_refused(error_of: Callable[..., str]) -> None:
    assert "torsion" in error_of("coupon", "torsion")


def test_choices_on_the_command_line_are_those_of_the_library() -> None:
    from geomdrap.cli import coupon_also, coupon_fit, coupon_options
    from geomdrap.export.coupon_fit_outputs import FIT_OUTPUTS
    from geomdrap.export.coupon_outputs import COUPON_OUTPUTS
    from geomdrap.forming import RELAXATIONS, cloth, parameters

    assert set(coupon_options.RELAXATIONS) == set(RELAXATIONS)
    assert coupon_options.THICKNESS_RULES == cloth.THICKNESS_RULES
    assert coupon_options.STRAIN_FORMS == cloth.STRAIN_FORMS
    assert tuple(COUPON_OUTPUTS) == coupon_options.COUPON_OUTPUTS
    assert tuple(FIT_OUTPUTS) == coupon_fit.FIT_OUTPUTS
    assert coupon_also.TESTS == parameters.TESTS
    assert set(coupon_fit.FITTED) == set(parameters.UNITS)
    assert set(coupon_also.SETTINGS) == set(parameters.TESTS)


def _shear_table(path: Path, text: str) -> None:
    path.write_text("series,displacement,force,shear\n" + text, encoding="utf-8")


@pytest.fixture
def one_start(monkeypatch: pytest.MonkeyPatch) -> None:
    """Fits begin at the given cloth: what is looked at here does not depend on where they begin."""
    monkeypatch.setattr("geomdrap.forming.fit_coupon.minima", lambda _, __, start: [start])


@pytest.fixture
def no_fit(monkeypatch: pytest.MonkeyPatch) -> None:
    """No fit may begin."""

    def never(*_: object) -> None:
        raise AssertionError("the fit has begun")

    monkeypatch.setattr("geomdrap.forming.fit_coupon.fit_coupons", never)


@pytest.mark.usefixtures("no_fit")
@pytest.mark.parametrize("split", [0, 2, 50])
def test_a_split_that_leaves_too_few_points_is_refused_before_the_fit(
    error_of: Callable[..., str], tmp_path: Path, split: float
) -> None:
    _shear_table(tmp_path / "t.csv", "".join(f"a,{d},{9 * d},{0.9 * d}\n" for d in range(1, 13)))
    said = error_of("coupon", "fit", "bias-extension", "t.csv", "--split", split)
    assert f"the split at {split} mm leaves {min(split, 12)} of 12 points of the series 'a'" in said


@pytest.mark.usefixtures("no_fit")
@pytest.mark.parametrize(
    ("test", "rows"),
    [("uniaxial", "a,1,9,1\na,2,18,2\n"), ("bias-extension", "a,1,9,\n"), ("bias-extension", "a,1,9,1\nb,1,9,\n")],
)
def test_a_split_of_no_use_is_refused(error_of: Callable[..., str], tmp_path: Path, test: str, rows: str) -> None:
    _shear_table(tmp_path / "t.csv", rows)
    assert "a bias-extension test whose every series has shear" in error_of(
        "coupon", "fit", test, "t.csv", "--split", 1
    )


@pytest.mark.usefixtures("no_fit")
def test_a_table_of_several_cases_is_not_taken_for_one_test(error_of: Callable[..., str], tmp_path: Path) -> None:
    rows = "".join(f"{c},{d},{d}\n" for c in ("0 deg", "45 deg") for d in (1, 2))
    (tmp_path / "t.csv").write_text("case,displacement,force\n" + rows)
    said = error_of("coupon", "fit", "uniaxial", "t.csv")
    assert "holds 2 cases (0 deg, 45 deg), and a file is one test: keep the rows of one" in said


def test_a_fit_that_describes_nothing_is_warned_of() -> None:
    from types import SimpleNamespace

    from geomdrap.cli.coupon_fit_summary import warnings_of

    known = SimpleNamespace(
        converged=True, resized=0, confounded=[], loose=[], scatter={"force": 0.99, "shear": 0.01}
    )
    said = warnings_of("test", SimpleNamespace(identified=known, rivals=(), advice=()))
    assert len(said) == 1
    assert "leaves 99 % of the force" in said[0]


@pytest.mark.usefixtures("one_start")
@pytest.mark.parametrize(
    ("rows", "said"),
    [
        ("".join(f"a,{d},,{d}\nb,{d},{9 * d},\n" for d in range(1, 9)), "no verdict: the series b has no shear"),
        ("a,1,,1\na,2,,2\n", "no verdict: the split at 1.4 mm leaves 1 of 2 points of the series 'a'"),
    ],
)
def test_a_fit_without_a_verdict_says_why(run: Callable[..., Result], tmp_path: Path, rows: str, said: str) -> None:
    _shear_table(tmp_path / "t.csv", rows)
    options = ("--cells", 2, "--steps", 800, "--fit", "fibre-modulus", "--elastic", "--outputs", "none")
    result = run("coupon", "fit", "bias-extension", "t.csv", *options, "--json")
    assert said in result.stderr
    assert "lacks" not in json.loads(result.stdout)


@pytest.mark.usefixtures("one_start")
def test_a_fit_is_kept_where_a_run_for_the_verdict_diverges(
    run: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from dataclasses import replace

    from geomdrap.criticism import curve_mechanical
    from geomdrap.forming.coupon import bias_extension

    def diverged(*arguments: object, **settings: object) -> object:
        made = bias_extension(*arguments, **settings)  # type: ignore[arg-type]
        run = replace(made.result.run, stopped="the run diverged at 3 s; what came before is kept")
        return replace(made, result=replace(made.result, run=run))

    monkeypatch.setattr(curve_mechanical, "bias_extension", diverged)
    _shear_table(tmp_path / "t.csv", "".join(f"a,{d},{9 * d},{0.9 * d}\n" for d in range(1, 13)))
    options = ("--cells", 2, "--steps", 800, "--fit", "resin-modulus", "--elastic")
    result = run("coupon", "fit", "bias-extension", "t.csv", *options, "--json")
    document = json.loads(result.stdout)
    assert result.exit_code == 0
    assert document["parameters"]["resin-modulus"]["value"] > 0.0
    assert document["resized"] == 0
    assert "lacks" not in document
    assert (tmp_path / "fit" / "fit.json").exists()
    assert "no verdict: the model cannot stand for the curve" in result.stderr
    assert result.stderr.rstrip().endswith("the run diverged at 3 s; what came before is kept; the fit is kept")


def test_a_fit_that_started_over_says_so(
    run: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    from dataclasses import replace

    from geomdrap.forming import fit_coupon

    fit = fit_coupon.fit_coupons
    monkeypatch.setattr(
        fit_coupon,
        "fit_coupons",
        lambda *arguments: replace(made := fit(*arguments), identified=replace(made.identified, resized=2)),
    )
    _frame_twin(tmp_path / "frame.csv")
    result = run("coupon", "fit", "picture-frame", "frame.csv", "--json", "--outputs", "none")
    assert (
        "the fit started over 2 times, with masses and steps for a cloth stiffer than it began with" in result.stderr
    )
    assert json.loads(result.stdout)["resized"] == 2


def test_fitting_tells_how_many_runs_it_has_made(
    run: Callable[..., Result], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    told: list[str] = []
    monkeypatch.setattr("geomdrap.cli.progress.Progress.tell", lambda _, words: told.append(words))
    _frame_twin(tmp_path / "frame.csv")
    result = run("coupon", "fit", "picture-frame", "frame.csv", "--json", "--outputs", "none")
    assert told == [f"{n} runs" for n in range(1, json.loads(result.stdout)["runs"] + 1)]


def _frame_twin(path: Path) -> None:
    from geomdrap.forming import Cloth, Resin
    from geomdrap.forming.simulated import predict

    d = np.linspace(2.0, 40.0, 12)
    force = predict("picture-frame", Cloth(resin=Resin(modulus=30.0)), {}, d, ("force",))["force"]
    noisy = force * (1.0 + 0.01 * np.random.default_rng(0).normal(size=12))
    path.write_text("displacement,force\n" + "".join(f"{a:.6f},{b:.6f}\n" for a, b in zip(d, noisy, strict=True)))


def test_fit_finds_the_resin_of_a_frame_with_its_interval(run: Callable[..., Result], tmp_path: Path) -> None:
    _frame_twin(tmp_path / "frame.csv")
    result = run("coupon", "fit", "picture-frame", "frame.csv", "--json")
    document = json.loads(result.stdout)
    found = document["parameters"]["resin-modulus"]
    assert document["schema"] == "geomdrap.coupon-fit/1"
    assert found["low"] < 30.0 < found["high"]
    assert found["sigma"] == pytest.approx(30.0 * 0.01 / np.sqrt(12), rel=0.5)
    assert document["correlation"] == [[1.0]]
    assert (tmp_path / "fit" / "fit.png").exists()
    assert "resin-modulus" in run("coupon", "fit", "picture-frame", "frame.csv", "--outputs", "none").stdout


@pytest.mark.slow
def test_fit_tells_the_story_of_a_real_curve_and_its_doubt(run: Callable[..., Result], tmp_path: Path) -> None:
    table = Path(__file__).parents[2] / "samples" / "measurements" / "bias-extension-plain-weave.csv"
    options = ("--length", 450, "--width", 150, "--split", 75, "--elastic", "--json")
    document = json.loads(run("coupon", "fit", "bias-extension", table, *options).stdout)
    lacks = document["lacks"]
    image = lacks["effects"]["image"]
    assert lacks["verdict"] == "ambiguous"
    assert image["undulation"]["held_rms"] < 0.3 * image["mechanical"]["held_rms"]
    assert image["slip"]["held_rms"] < 0.4 * image["mechanical"]["held_rms"]
    assert lacks["effects"]["hand"]["slip"]["held_rms"] > lacks["effects"]["hand"]["mechanical"]["held_rms"]
    assert any("the series differ by up to 3.2 deg" in reason for reason in lacks["reasons"])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("picture-frame", "none.csv"), "none.csv does not exist"),
        (("picture-frame", "frame.csv", "--angle", 30), "--angle is not a setting of a picture-frame test"),
        (
            ("picture-frame", "frame.csv", "--warp-modulus", 30),
            "--warp-modulus is not a start of a picture-frame fit",
        ),
        (("biaxial", "frame.csv"), "fitted by force_warp or force_weft"),
        (
            ("picture-frame", "frame.csv", "--fit", "undulation"),
            "does not show undulation; choose from resin-modulus",
        ),
    ],
)
def test_a_fit_that_cannot_be_is_refused(
    error_of: Callable[..., str], tmp_path: Path, arguments: tuple, said: str
) -> None:
    _frame_twin(tmp_path / "frame.csv")
    assert said in error_of("coupon", "fit", *arguments)


def _strip_twin(path: Path, angle: float, furthest: float) -> None:
    from geomdrap.forming import Cloth
    from geomdrap.forming.simulated import predict

    d = np.linspace(furthest / 12.0, furthest, 12)
    force = predict("uniaxial", Cloth(), {"angle": angle, "cells": 2, "steps": 4000}, d, ("force",))["force"]
    noisy = force * (1.0 + 0.01 * np.random.default_rng(0).normal(size=12))
    path.write_text("displacement,force\n" + "".join(f"{a:.6f},{b:.6f}\n" for a, b in zip(d, noisy, strict=True)))


@pytest.mark.usefixtures("one_start")
def test_a_further_test_is_fitted_at_once_and_shown(run: Callable[..., Result], tmp_path: Path) -> None:
    _strip_twin(tmp_path / "0.csv", 0.0, 3.0)
    _frame_twin(tmp_path / "frame.csv")
    options = ("--cells", 2, "--steps", 4000, "--angle", 0, "--fit", "fibre-modulus,resin-modulus")
    result = run("coupon", "fit", "uniaxial", "0.csv", "--also", "picture-frame:frame.csv:side=100", *options)
    assert "uniaxial, 0 deg, test: residual force " in result.stdout
    assert "picture-frame, test: residual force " in result.stdout
    document = json.loads((tmp_path / "fit" / "fit.json").read_text(encoding="utf-8"))
    assert [one["test"] for one in document["tests"]] == ["uniaxial", "picture-frame"]
    assert document["tests"][1]["settings"] == {"side": 100.0}
    assert document["readings"] == 24
    assert document["fits_as_well"] == []
    assert document["parameters"]["resin-modulus"]["value"] == pytest.approx(30.0, rel=0.02)
    assert document["parameters"]["fibre-modulus"]["value"] == pytest.approx(130_000.0, rel=0.05)
    assert (tmp_path / "fit" / "fit.png").stat().st_size > 10_000


@pytest.mark.usefixtures("no_fit")
@pytest.mark.parametrize(
    ("also", "said"),
    [
        ("frame.csv", "must begin with a test, uniaxial, bias-extension, picture-frame, biaxial"),
        ("uniaxial", "names no file, as in uniaxial:FILE.csv"),
        ("uniaxial:none.csv:angle=0", "none.csv does not exist"),
        ("uniaxial:frame.csv:side=3", "'side' is not a setting of a uniaxial test; choose from angle, speed"),
        ("uniaxial:frame.csv:angle=x", "'x' is not a number"),
        ("uniaxial:frame.csv:cells=2.5", "cells is a whole number of 1 or more; got 2.5"),
        ("bias-extension:many.csv", "many.csv holds the series a, b; with --also each file must hold one"),
    ],
)
def test_a_further_test_that_cannot_be_is_refused(
    error_of: Callable[..., str], tmp_path: Path, also: str, said: str
) -> None:
    _frame_twin(tmp_path / "frame.csv")
    _shear_table(tmp_path / "many.csv", "a,1,9,1\nb,1,9,1\n")
    assert said in error_of("coupon", "fit", "picture-frame", "frame.csv", "--also", also)


def test_a_warning_leads_to_the_test_that_would_help() -> None:
    from geomdrap.cli.coupon_fit_summary import warnings_of
    from geomdrap.forming import Cloth
    from geomdrap.forming.fit_coupon import CouponFit
    from geomdrap.forming.further import Advice
    from geomdrap.forming.identify import identify

    x, rng = np.arange(1.0, 30.0), np.random.default_rng(0)
    noisy = {"force": 6.0 * x * (1.0 + 0.01 * rng.normal(size=len(x)))}
    found = identify(
        lambda p: {"force": p["a"] * p["b"] * (x + 1e-3 * p["b"] * x**2)}, noisy, {"a": 1.0, "b": 2.0}
    )
    advice = Advice("uniaxial", {"angle": 0.0}, 0.01 * found.sigma)
    said = warnings_of("pull", CouponFit((), Cloth(), found, (advice,), ({"a": 3.0, "b": 4.0},)))
    assert "pull: other values fit about as well: a 3, b 4; only other readings can choose" in said
    assert any("a and b are not told apart" in words for words in said)
    assert said[-1].startswith("pull: a uniaxial at 0 degrees test on top would bring sigma of a from ")
    assert said[-1].endswith("; fit both with --also uniaxial:FILE.csv:angle=0")
