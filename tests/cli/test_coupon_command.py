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
