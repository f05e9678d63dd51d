"""``geomdrap coupon fit``: parameters of the mechanical model from a measured test."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager, nullcontext
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from geomdrap.cli.coupon_also import SETTINGS, TESTS, Further, FurtherTest
from geomdrap.cli.coupon_fit_summary import summary_of, warnings_of
from geomdrap.cli.coupon_options import cloth_of, cloth_options, yarn_options
from geomdrap.cli.options import folder_option, json_option, quiet_option
from geomdrap.cli.values import Names, Number
from geomdrap.errors import FormingError

if TYPE_CHECKING:
    from geomdrap.criticism.curve import Curve
    from geomdrap.criticism.curve_verdict import CurveVerdict
    from geomdrap.forming import Cloth

FITTED = ("fibre-modulus", "warp-modulus", "weft-modulus", "undulation", "resin-modulus")
FIT_OUTPUTS = ("json", "png")
SIDES = ("warp_modulus", "weft_modulus")
LENGTH, WIDTH = 150.0, 30.0  # mm, of a strip unless told otherwise


@click.command()
@click.argument("test", type=click.Choice(TESTS))
@click.argument("measured", type=click.Path(path_type=Path))
@click.option(
    "--fit", "names", type=Names(FITTED, ""), help="What is fitted.  [default: what the test and its readings show]"
)
@click.option(
    "--also",
    type=FurtherTest(),
    multiple=True,
    help="Another test of the same cloth, fitted at once; settings not named are the usual ones. May be repeated.",
)
@click.option(
    "--split", type=Number("MM"), help="Fit the shear up to here and foretell the rest.  [default: 0.7 of all]"
)
@click.option("--angle", type=Number("DEG"), help="Warp from the length (uniaxial).  [default: 45]")
@click.option("--ratio", type=Number("X"), help="Opening on the weft over that on the warp (biaxial).  [default: 1]")
@click.option("--speed", type=Number("MM/MIN"), help="Of the test.  [default: 20; biaxial: 240]")
@click.option("--length", type=Number("MM"), help="Between the clamps of a strip.  [default: 150]")
@click.option("--width", type=Number("MM"), help="Of a strip.  [default: 30]")
@click.option("--side", type=Number("MM"), help="Length of a bar of the frame.  [default: 100]")
@click.option("--cells", type=click.IntRange(min=2), help="Cells across.  [default: 10; biaxial: 20]")
@click.option("--steps", type=click.IntRange(min=1), help="Time steps of a run.  [default: enough]")
@click.option("--warp-modulus", type=Number("MPA"), help="Modulus of straight warp yarns to start at (biaxial).")
@click.option("--weft-modulus", type=Number("MPA"), help="Modulus of straight weft yarns to start at (biaxial).")
@yarn_options
@cloth_options
@folder_option("fit", "Folder for the result files; it is made if it is missing.")
@click.option(
    "--outputs",
    type=Names(FIT_OUTPUTS),
    metavar="name,name,...",
    default=",".join(FIT_OUTPUTS),
    show_default=True,
    help="Which result files to write; none writes none.",
)
@json_option
@quiet_option
def fit(
    test: str,
    measured: Path,
    names: tuple[str, ...] | None,
    also: tuple[Further, ...],
    split: float | None,
    folder: Path,
    outputs: tuple[str, ...],
    as_json: bool,
    quiet: bool,
    **asked: Any,
) -> int:
    """Fit the cloth of TEST to its MEASURED curves, and say what they cannot show.

    MEASURED is CSV with a header: displacement (mm) and force or shear (bias-extension: both are welcome), or
    force_warp and force_weft (biaxial); a column series tells ways of reading apart. The options give the test and
    the cloth about which the fit looks for a start. Where a bias-extension test gives the shear, effects that the
    model lacks are fitted on top of it to the first part of the curve, and must foretell the rest. What one test does
    not tell apart, two may: --also adds tests of the same cloth, each a file with one series. Exit code 1
    if a fit did not end.

    \b
    Examples:
      geomdrap coupon fit biaxial measured.csv
      geomdrap coupon fit uniaxial pull.csv --angle 45 --speed 40 --fit resin-modulus,undulation
      geomdrap coupon fit uniaxial 45.csv --also uniaxial:0.csv:angle=0
      geomdrap coupon fit bias-extension shear.csv --length 450 --width 150 --json
    """
    from geomdrap.cli.messages import print_json, say
    from geomdrap.cli.progress import Progress, announce_compilation
    from geomdrap.export.coupon_fit_outputs import as_dict, write_fit
    from geomdrap.export.whole import check_writable
    from geomdrap.forming import fit_coupon
    from geomdrap.forming.coupon import usual_cloth
    from geomdrap.forming.readings import read_test

    if outputs:
        check_writable(folder)
    if names == ():
        raise click.UsageError(f"--fit needs a parameter; choose from {', '.join(FITTED)}")
    settings = _settings(test, asked)
    _check_starts({test, *(one.test for one in also)}, asked)
    readings = read_test(measured)
    more = [fit_coupon.Measured(one.test, _only_series(one.path), one.settings) for one in also]
    if more and len(readings) > 1:
        raise _many_series(measured, readings)
    cloth = cloth_of(usual_cloth(test), asked)
    curves, split, silent = _to_judge(test, readings, settings, split)
    announce_compilation(quiet, "forming")
    with Progress(quiet) as progress:
        progress.step("Fitting")
        with _naming(measured) if not more else nullcontext():
            fits = {
                name: fit_coupon.fit_coupons(
                    [fit_coupon.Measured(test, columns, settings), *more], cloth, names, progress.tell
                )
                for name, columns in readings.items()
            }
        progress.step("Asking what is missing")
        verdict, silent = _lacks(curves, cloth, settings, split, progress.share) if curves else (None, silent)
        progress.step("Writing")
        files = write_fit(fits, verdict, folder, outputs)
    say([*(w for name, found in fits.items() for w in warnings_of(name, found)), *silent], (), quiet)
    if as_json:
        print_json(as_dict(fits, verdict, files))
    elif not quiet:
        click.echo("\n".join(summary_of(fits, verdict) + [f"wrote {path}" for path in files.values()]))
    return 0 if all(found.identified.converged for found in fits.values()) else 1


@contextmanager
def _naming(table: Path) -> Iterator[None]:
    """Name the table in what is said against its readings."""
    try:
        yield
    except FormingError as error:
        if str(table) in str(error):
            raise
        raise FormingError(f"{table}: {error}") from error


def _settings(test: str, asked: dict[str, Any]) -> dict[str, Any]:
    """The settings of the test; those of other tests are refused. They are taken out of ``asked``."""
    given = {key: asked.pop(key) for key in ("angle", "ratio", "speed", "length", "width", "side", "cells", "steps")}
    given = {key: value for key, value in given.items() if value is not None}
    strange = [key for key in given if key not in SETTINGS[test]]
    if strange:
        raise click.UsageError(f"--{strange[0]} is not a setting of a {test} test; leave it out")
    return given


def _check_starts(tests: set[str], asked: dict[str, Any]) -> None:
    """Refuse moduli to start at that none of the ``tests`` is fitted by."""
    refused = (*(("fibre_modulus",) if tests == {"biaxial"} else ()), *(() if "biaxial" in tests else SIDES))
    strange = [key for key in refused if asked.get(key) is not None]
    if strange:
        listed = " and ".join(sorted(tests))
        raise click.UsageError(f"--{strange[0].replace('_', '-')} is not a start of a {listed} fit; leave it out")


def _only_series(path: Path) -> Mapping[str, Any]:
    from geomdrap.forming.readings import read_test

    found = read_test(path)
    if len(found) > 1:
        raise _many_series(path, found)
    return next(iter(found.values()))


def _many_series(path: Path, found: Mapping[str, Any]) -> click.UsageError:
    return click.UsageError(
        f"{path} holds the series {', '.join(found)}; with --also each file must hold one: leave the others out"
    )


def _to_judge(
    test: str, readings: Mapping[str, Mapping[str, Any]], settings: dict[str, Any], split: float | None
) -> tuple[dict[str, Curve], float, list[str]]:
    """Curves of shear by series, where they are split, mm, and why there is no verdict; no curves without one.

    What cannot be judged is refused here, before the fit, if a split was asked for.
    """
    import numpy as np

    from geomdrap.criticism.curve import EFFECTS, Curve
    from geomdrap.criticism.curve_fit import check_split
    from geomdrap.errors import MeasurementError

    seen = {n: np.isfinite(c["shear"]) if "shear" in c else np.zeros(0, dtype=bool) for n, c in readings.items()}
    blind = [name for name, finite in seen.items() if not finite.any()]
    if test != "bias-extension" or blind:
        if split is not None:
            raise click.UsageError("--split is for a bias-extension test whose every series has shear; leave it out")
        some = test == "bias-extension" and len(blind) < len(seen)
        return {}, 0.0, [f"no verdict: the series {blind[0]} has no shear"] if some else []
    free = settings.get("length", LENGTH) - settings.get("width", WIDTH)
    curves = {
        name: Curve(name, columns["displacement"][seen[name]], columns["shear"][seen[name]], free)
        for name, columns in readings.items()
    }
    where = 0.7 * max(float(c.displacement.max()) for c in curves.values()) if split is None else split
    try:
        for curve in curves.values():
            for effect in EFFECTS.values():
                check_split(effect, curve, where)
    except MeasurementError as error:
        if split is not None:
            raise
        return {}, where, [f"no verdict: {error}"]
    return curves, where, []


def _lacks(
    curves: Mapping[str, Curve], cloth: Cloth, settings: dict[str, Any], split: float, progress: Any
) -> tuple[CurveVerdict | None, list[str]]:
    """What the model at the given cloth lacks, by the shear of a bias-extension test, or why it is not known.

    The fit that was made before does not depend on it, and is kept.
    """
    from geomdrap.criticism.curve_mechanical import DivergedError, mechanical_effects
    from geomdrap.criticism.curve_verdict import judge_curves

    asked = {"length": LENGTH, "width": WIDTH, **settings}
    furthest = max(float(c.displacement.max()) for c in curves.values())
    try:
        effects = mechanical_effects(cloth, furthest=furthest, progress=progress, **asked)
    except DivergedError as error:
        return None, [f"no verdict: {error}; the fit is kept"]
    return judge_curves(curves, split, effects), []
