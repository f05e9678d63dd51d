"""``geomdrap coupon fit``: parameters of the mechanical model from a measured test."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from geomdrap.cli.coupon_options import cloth_of, cloth_options, yarn_options
from geomdrap.cli.options import folder_option, json_option, quiet_option
from geomdrap.cli.values import Names, Number

if TYPE_CHECKING:
    from geomdrap.criticism.curve import Curve
    from geomdrap.criticism.curve_verdict import CurveVerdict
    from geomdrap.forming import Cloth
    from geomdrap.forming.fit_coupon import CouponFit

TESTS = ("uniaxial", "bias-extension", "picture-frame", "biaxial")  # as in geomdrap.forming; tests compare
FITTED = ("fibre-modulus", "warp-modulus", "weft-modulus", "undulation", "resin-modulus")
FIT_OUTPUTS = ("json", "png")
LENGTH, WIDTH = 150.0, 30.0  # mm, of a strip unless told otherwise
SETTINGS = {
    "uniaxial": ("angle", "speed", "length", "width", "steps", "cells"),
    "bias-extension": ("speed", "length", "width", "steps", "cells"),
    "picture-frame": ("side", "speed"),
    "biaxial": ("ratio", "speed", "steps", "cells"),
}


@click.command()
@click.argument("test", type=click.Choice(TESTS))
@click.argument("measured", type=click.Path(path_type=Path))
@click.option(
    "--fit", "names", type=Names(FITTED), help="What is fitted.  [default: what the test and its readings show]"
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
    the cloth at which the fit starts. Where a bias-extension test gives the shear, effects that the model lacks are
    fitted on top of it to the first part of the curve, and must foretell the rest. Exit code 1 if a fit did not end.

    \b
    Examples:
      geomdrap coupon fit biaxial measured.csv
      geomdrap coupon fit uniaxial pull.csv --angle 45 --speed 40 --fit resin-modulus,undulation
      geomdrap coupon fit bias-extension shear.csv --length 450 --width 150 --json
    """
    from geomdrap.cli.messages import print_json, say
    from geomdrap.cli.progress import Progress, announce_compilation
    from geomdrap.export.coupon_fit_outputs import as_dict, write_fit
    from geomdrap.export.whole import check_writable
    from geomdrap.forming.coupon import usual_cloth
    from geomdrap.forming.fit_coupon import fit_coupon
    from geomdrap.forming.readings import read_test

    if outputs:
        check_writable(folder)
    readings, settings = read_test(measured), _settings(test, asked)
    cloth = cloth_of(usual_cloth(test), asked)
    curves, split, silent = _to_judge(test, readings, settings, split)
    announce_compilation(quiet, "forming")
    with Progress(quiet) as progress:
        progress.step("Fitting")
        fits = {
            name: fit_coupon(test, columns, cloth, settings, names, lambda runs: progress.tell(f"{runs} runs"))
            for name, columns in readings.items()
        }
        progress.step("Asking what is missing")
        verdict, silent = _lacks(curves, cloth, settings, split, progress.share) if curves else (None, silent)
        progress.step("Writing")
        files = write_fit(fits, verdict, folder, outputs)
    say([*(w for name, found in fits.items() for w in _warnings(name, found)), *silent], (), quiet)
    if as_json:
        print_json(as_dict(fits, verdict, files))
    elif not quiet:
        click.echo("\n".join(_summary(fits, verdict) + [f"wrote {path}" for path in files.values()]))
    return 0 if all(found.identified.converged for found in fits.values()) else 1


def _settings(test: str, asked: dict[str, Any]) -> dict[str, Any]:
    """The settings of the test; those of other tests are refused. They are taken out of ``asked``."""
    given = {key: asked.pop(key) for key in ("angle", "ratio", "speed", "length", "width", "side", "cells", "steps")}
    given = {key: value for key, value in given.items() if value is not None}
    strange = [key for key in given if key not in SETTINGS[test]]
    if strange:
        raise click.UsageError(f"--{strange[0]} is not a setting of a {test} test; leave it out")
    pair, one = ("warp_modulus", "weft_modulus"), ("fibre_modulus",)
    strange = [key for key in (one if test == "biaxial" else pair) if asked.get(key) is not None]
    if strange:
        raise click.UsageError(f"--{strange[0].replace('_', '-')} is not a start of a {test} fit; leave it out")
    return given


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


def _warnings(series: str, found: CouponFit) -> list[str]:
    """What the user should look at."""
    known = found.identified
    said = [] if known.converged else [f"{series}: the fit did not come to an end; what it had is kept"]
    if known.resized:
        again = "with masses and steps for a cloth stiffer than it began with"
        said.append(f"{series}: the fit started over {_times(known.resized)}, {again}")
    said += [f"{series}: {a} and {b} are not told apart (correlation {c:.2f})" for a, b, c in known.confounded]
    said += [f"{series}: {name} is not shown by these readings" for name in known.loose]
    for name in dict.fromkeys([*known.loose, *(n for a, b, _ in known.confounded for n in (a, b))]):
        k = known.names.index(name)
        best = min(found.advice, key=lambda a: float(a.sigma[k]), default=None)
        if best is not None and best.sigma[k] < 0.8 * known.sigma[k]:
            share = 100.0 * best.sigma[k] / known.sigma[k]
            said.append(f"{series}: a {best.test} on top would bring sigma of {name} to {share:.0f} % of what it is")
    return said


def _times(count: int) -> str:
    return "once" if count == 1 else f"{count} times"


def _summary(fits: Mapping[str, CouponFit], verdict: CurveVerdict | None) -> list[str]:
    from geomdrap.forming.fit_coupon import UNITS

    lines = []
    for series, found in fits.items():
        known = found.identified
        rms = ", ".join(
            f"{c.replace('_', ' ')} {v:.3g} {'deg' if c == 'shear' else 'N'}" for c, v in known.rms.items()
        )
        lines.append(f"{found.test}, {series}: residual {rms} (rms, {len(found.displacement)} readings)")
        for name, value, sigma, (low, high) in zip(
            known.names, known.values, known.sigma, known.interval, strict=True
        ):
            lines.append(f"  {name:15} {value:.5g} ± {sigma:.2g} {UNITS[name]} (95 %: {low:.4g} to {high:.4g})")
    return lines if verdict is None else [*lines, *_story(verdict)]


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
