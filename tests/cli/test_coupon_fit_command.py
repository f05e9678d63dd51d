"""``geomdrap coupon fit``: what it prints, writes and warns of, and what it refuses."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result


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
    said = warnings_of("test", SimpleNamespace(identified=known, rivals=(), advice=(), curves=()))
    assert len(said) == 1
    assert "leaves 99 % of the force" in said[0]


@pytest.mark.parametrize(("rms", "words"), [(1.22, []), (14.0, ["leaves 47 % of the shear"])])
def test_what_a_fit_leaves_of_the_shear_is_a_share_of_the_shear(rms: float, words: list[str]) -> None:
    from types import SimpleNamespace

    from geomdrap.cli.coupon_fit_summary import warnings_of

    # of what a camera errs by, a twentieth of the largest shear, it is ten times that
    known = SimpleNamespace(converged=True, resized=0, confounded=[], loose=[], scatter={"shear": 0.59})
    curve = SimpleNamespace(measured={"shear": np.array([30.0, -30.0, np.nan])}, rms={"shear": rms})
    said = warnings_of("test", SimpleNamespace(identified=known, rivals=(), advice=(), curves=(curve,)))
    assert len(said) == len(words)
    assert all(word in text for word, text in zip(words, said, strict=True))


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
        (("picture-frame", "frame.csv", "--fit", "foo"), "'foo' is not one of fibre-modulus"),
        (("uniaxial", "one.csv"), "one.csv: there are too few readings"),
    ],
)
def test_a_fit_that_cannot_be_is_refused(
    error_of: Callable[..., str], tmp_path: Path, arguments: tuple, said: str
) -> None:
    _frame_twin(tmp_path / "frame.csv")
    (tmp_path / "one.csv").write_text("displacement,force\n1,20\n")
    message = error_of("coupon", "fit", *arguments)
    assert said in message
    assert "no files" not in message


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
