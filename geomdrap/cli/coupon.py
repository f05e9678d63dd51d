"""``geomdrap coupon``: the test specimens of the mechanical model, and the fit of the model to a measured test."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from geomdrap.cli.coupon_fit import fit
from geomdrap.cli.coupon_options import cloth_of, cloth_options, result_options, run_options, yarn_options
from geomdrap.cli.values import Number, Numbers

if TYPE_CHECKING:
    from geomdrap.forming.coupon import Coupon

SPEED = Number("MM/MIN")


@click.group()
def coupon() -> None:
    """Pull a test specimen of the mechanical model, or fit the model to a measured test.

    The cloth is yarns in a viscoelastic membrane, stepped explicitly (Cherouat and Borouchaki, Materials 2, 2009).
    Units: mm, N, MPa, mm/min, degrees. Exit code 1 if a test stopped before its end; what it had is kept.

    \b
    Examples:
      geomdrap coupon uniaxial --angle 0,15,30,45
      geomdrap coupon picture-frame --shear 10,30,45 --elastic
      geomdrap coupon fit biaxial measured.csv
    """


coupon.add_command(fit)


@coupon.command()
@click.option(
    "--angle", type=Numbers(), default="45", show_default=True, help="Warp from the length, deg; may be a list."
)
@click.option("--speed", type=Numbers(), default="20", show_default=True, help="Pull, mm/min; may be a list.")
@click.option("--undulation", type=Numbers(), default="0.005", show_default=True, help="Crimp strain; may be a list.")
@click.option("--displacement", type=Number("MM"), help="How far.  [default: 3 mm beyond the lock of the yarns]")
@click.option("--length", type=Number("MM"), default=150.0, show_default=True, help="Between the clamps.")
@click.option("--width", type=Number("MM"), default=30.0, show_default=True, help="Of the strip.")
@click.option("--fibre-modulus", type=Number("MPA"), help="Modulus of straight yarns.  [default: 130000]")
@cloth_options
@run_options
@result_options
def uniaxial(angle: Sequence[float], speed: Sequence[float], undulation: Sequence[float], **asked: Any) -> int:
    """Pull a strip along its length, the warp at an angle to it.

    Lists of angles, speeds and undulations give a case for each of their combinations, in one picture.

    \b
    Examples:
      geomdrap coupon uniaxial --angle 45 --speed 20
      geomdrap coupon uniaxial --angle 0,15,30,45 -o orientations
      geomdrap coupon uniaxial --speed 20,40,80 --json
      geomdrap coupon uniaxial --undulation 0,0.005
    """
    from geomdrap.forming import coupon as coupons
    from geomdrap.forming.parameters import with_values

    show = _shown(asked)
    _check_lists(angle, speed)
    cloth = cloth_of(coupons.usual_cloth("uniaxial"), asked)
    cases = [
        (coupons.uniaxial, (with_values(cloth, {"undulation": u}),), {**asked, "angle": a, "speed": s})
        for a, s, u in product(angle, speed, undulation)
    ]
    return _test(cases, **show)


@coupon.command("bias-extension")
@click.option("--displacement", type=Number("MM"), default=30.0, show_default=True, help="How far.")
@click.option("--speed", type=SPEED, default=20.0, show_default=True, help="Pull, mm/min.")
@click.option("--length", type=Number("MM"), default=150.0, show_default=True, help="Between the clamps.")
@click.option("--width", type=Number("MM"), default=30.0, show_default=True, help="Of the strip.")
@yarn_options
@cloth_options
@run_options
@result_options
def bias_extension(**asked: Any) -> int:
    """Pull a strip cut at 45 degrees, with straight yarns unless --undulation is given.

    \b
    Examples:
      geomdrap coupon bias-extension --length 150 --width 30 --displacement 30 --elastic
      geomdrap coupon bias-extension --fibre-modulus 40000 --resin-modulus 10 --json
    """
    from geomdrap.forming import coupon as coupons

    show = _shown(asked)
    cloth = cloth_of(coupons.usual_cloth("bias-extension"), asked)
    return _test([(coupons.bias_extension, (cloth,), asked)], **show)


@coupon.command("picture-frame")
@click.option("--side", type=Number("MM"), default=100.0, show_default=True, help="Length of a bar of the frame.")
@click.option(
    "--shear", type=Numbers(), default="5,10,15,20,25,30,35,40,45", show_default=True, help="Readings, deg."
)
@click.option("--speed", type=SPEED, default=20.0, show_default=True, help="Of the corner, mm/min.")
@click.option("--steps", type=click.IntRange(min=1), default=4000, show_default=True, help="Time steps.")
@yarn_options
@cloth_options
@result_options
def picture_frame(**asked: Any) -> int:
    """Shear a square in a frame of four hinged bars.

    \b
    Examples:
      geomdrap coupon picture-frame --side 100 --thickness 2 --shear 10,30,45 --elastic
      geomdrap coupon picture-frame --speed 80 --json
    """
    from geomdrap.forming import coupon as coupons

    show = _shown(asked)
    cloth = cloth_of(coupons.usual_cloth("picture-frame"), asked)
    return _test([(coupons.picture_frame, (cloth,), asked)], **show)


@coupon.command()
@click.option(
    "--displacement", type=Number("MM"), default=140.0, show_default=True, help="Opening of the warp grips."
)
@click.option("--speed", type=SPEED, default=240.0, show_default=True, help="Of the opening, mm/min.")
@click.option(
    "--ratio", type=Number("X"), default=1.0, show_default=True, help="Opening on the weft over that on the warp."
)
@click.option("--warp-modulus", type=Number("MPA"), help="Modulus of straight warp yarns.  [default: 32.1]")
@click.option("--weft-modulus", type=Number("MPA"), help="Modulus of straight weft yarns.  [default: 92.6]")
@click.option("--undulation", type=Number("STRAIN"), help="Strain that straightens the yarns.  [default: 0.2]")
@cloth_options
@run_options
@result_options
def biaxial(**asked: Any) -> int:
    """Pull a square along warp and weft at once: a knit, unless told otherwise.

    \b
    Examples:
      geomdrap coupon biaxial --displacement 140
      geomdrap coupon biaxial --ratio 0.5 --warp-modulus 40 --json
    """
    from geomdrap.forming import coupon as coupons

    show = _shown(asked)
    cloth = cloth_of(coupons.usual_cloth("biaxial"), asked)
    return _test([(coupons.biaxial, (cloth,), asked)], **show)


def _check_lists(angle: Sequence[float], speed: Sequence[float]) -> None:
    """Refuse what the last case of a list would be refused for, before the first one is pulled."""
    if min(speed) <= 0.0:
        raise click.UsageError(f"a speed must be above 0 mm/min; got {min(speed):g}")
    for one in angle:
        if not 0.0 <= one <= 90.0:
            raise click.UsageError(f"an angle lies between 0 and 90 degrees; got {one:g}")


def _shown(asked: dict[str, Any]) -> dict[str, Any]:
    """Take out of ``asked`` how results are shown, and refuse a folder that cannot be written."""
    from geomdrap.export.whole import check_writable

    show = {name: asked.pop(name) for name in ("folder", "outputs", "as_json", "quiet")}
    if show["outputs"]:
        check_writable(show["folder"])
    return show


def _test(
    cases: Sequence[tuple[Callable[..., Coupon], tuple[Any, ...], dict[str, Any]]],
    folder: Path,
    outputs: Sequence[str],
    as_json: bool,
    quiet: bool,
) -> int:
    """Make the tests one by one, write and print what they give; 1 if one of them stopped early."""
    from geomdrap.cli.messages import print_json, say
    from geomdrap.cli.progress import Progress, announce_compilation
    from geomdrap.export import coupon_json
    from geomdrap.export.coupon_outputs import write_coupons

    announce_compilation(quiet, "forming")
    done: list[Coupon] = []
    with Progress(quiet) as progress:
        for number, (make, cloth, settings) in enumerate(cases, 1):
            progress.step(f"Pulling {number} of {len(cases)}" if len(cases) > 1 else "Pulling")
            done.append(make(*cloth, progress=progress.share, **settings))
        progress.step("Writing")
        files = write_coupons(done, folder, outputs)
    for case in done:
        say(case.result.warnings, (), quiet)
    if as_json:
        print_json(coupon_json.as_dict(done, files))
    elif not quiet:
        click.echo(
            "\n".join([line for case in done for line in _summary(case)] + [f"wrote {p}" for p in files.values()])
        )
    return 1 if any(case.result.stopped for case in done) else 0


def _summary(case: Coupon) -> list[str]:
    """What a test gave, in two lines."""
    pulled = case.result
    named = {k: v for k, v in case.settings.items() if k in ("angle", "speed", "ratio", "side")}
    if case.test == "uniaxial":
        named["undulation"] = pulled.specimen.cloth.warp.undulation
    forces = ", ".join(f"{name.replace('_', ' ')} {values[-1]:.5g} N" for name, values in pulled.forces.items())
    return [
        f"{case.test}: " + ", ".join(f"{name} {value:g}" for name, value in named.items()),
        f"  at {pulled.displacement[-1]:.4g} mm: {forces}, shear {round(pulled.shear[-1], 2) + 0.0:.2f} deg; "
        f"{100 * pulled.balance_error:.2g} % of the energy unaccounted for",
    ]
