"""Options of test specimens: the cloth, the run, the results."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING, Any, TypeVar

import click

from geomdrap.cli.options import folder_option, json_option, quiet_option
from geomdrap.cli.values import Names, Number, Pairs

if TYPE_CHECKING:
    from geomdrap.forming import Cloth

F = TypeVar("F", bound=Callable[..., Any])

COUPON_OUTPUTS = ("json", "csv", "png")  # the keys of export.coupon_outputs.COUPON_OUTPUTS; a test compares
RELAXATIONS = ("table", "creep", "single", "elastic")  # those of geomdrap.forming; tests compare these with it
THICKNESS_RULES = ("incompressible", "constant")
STRAIN_FORMS = ("hencky", "green-naghdi", "green")


def yarn_options(function: F) -> F:
    """Add the moduli of the yarns, the same along warp and weft."""
    for option in (
        click.option("--undulation", type=Number("STRAIN"), help="Strain that straightens the crimp of the yarns."),
        click.option("--fibre-modulus", type=Number("MPA"), help="Modulus of straight yarns.  [default: 130000]"),
    ):
        function = option(function)
    return function


def cloth_options(function: F) -> F:
    """Add what the cloth is made of; each default is that of the test's own cloth."""
    for option in (
        click.option("--strain", type=click.Choice(STRAIN_FORMS), help="Law of large strains.  [default: hencky]"),
        click.option(
            "--thickness-rule",
            type=click.Choice(THICKNESS_RULES),
            help="Whether the cloth thickens as its area falls.  [default: incompressible]",
        ),
        click.option("--thickness", type=Number("MM"), help="Thickness of all plies."),
        click.option(
            "--prony",
            type=Pairs(),
            metavar="TIME=SHARE,...",
            help="A relaxation of your own: times in s, ascending, and shares of the modulus that fade with them.",
        ),
        click.option(
            "--relaxation",
            type=click.Choice(RELAXATIONS),
            help="How the resin relaxes: a reading of the paper's table.",
        ),
        click.option("--elastic", is_flag=True, help="The same as --relaxation elastic: instantaneous moduli stay."),
        click.option("--poisson", type=Number("RATIO"), help="Poisson's ratio of the resin.  [default: 0.45]"),
        click.option("--resin-modulus", type=Number("MPA"), help="Instantaneous modulus of the resin."),
        click.option("--compression", type=Number("SHARE"), help="Stiffness of yarns in compression, as a share."),
        click.option(
            "--fibre-share", type=Number("SHARE"), help="Share of the thickness that each family of yarns takes up."
        ),
    ):
        function = option(function)
    return function


def run_options(function: F) -> F:
    """Add the numbers of the run."""
    for option in (
        click.option("--keep-mass", is_flag=True, help="Scale no masses; steps over the stable limit are refused."),
        click.option(
            "--frames", type=click.IntRange(min=1), default=50, show_default=True, help="How many readings."
        ),
        click.option(
            "--steps", type=click.IntRange(min=1), help="Time steps.  [default: as many as a slow test needs]"
        ),
        click.option("--cells", type=click.IntRange(min=2), default=20, show_default=True, help="Cells across."),
    ):
        function = option(function)
    return function


def result_options(function: F) -> F:
    """Add -o, --outputs, --json, --quiet."""
    for option in (
        quiet_option,
        json_option,
        click.option(
            "--outputs",
            type=Names(COUPON_OUTPUTS),
            metavar="name,name,...",
            default=",".join(COUPON_OUTPUTS),
            show_default=True,
            help="Which result files to write; none writes none.",
        ),
        folder_option("coupon", "Folder for the result files; it is made if it is missing."),
    ):
        function = option(function)
    return function


def cloth_of(base: Cloth, asked: dict[str, Any]) -> Cloth:
    """The cloth ``base`` with what was ``asked`` for; the options are taken out of ``asked``."""
    from geomdrap.forming import RELAXATIONS, Relaxation
    from geomdrap.forming.cloth import changed

    relaxation, prony = asked.pop("relaxation"), asked.pop("prony")
    if asked.pop("elastic"):
        if relaxation not in (None, "elastic"):
            raise click.UsageError(
                f"--elastic and --relaxation {relaxation} contradict each other: leave one of them out"
            )
        relaxation = "elastic"
    resin = changed(
        base.resin,
        modulus=asked.pop("resin_modulus"),
        poisson=asked.pop("poisson"),
        strain=asked.pop("strain"),
        thickness=asked.pop("thickness_rule"),
        relaxation=RELAXATIONS[relaxation] if relaxation else None,
    )
    if prony:
        if relaxation:
            raise click.UsageError("--prony is a relaxation of its own: leave out --relaxation and --elastic")
        resin = replace(resin, relaxation=Relaxation(tuple(s for _, s in prony), tuple(t for t, _ in prony)))
    common = {"share": asked.pop("fibre_share"), "compression": asked.pop("compression")}
    moduli = {side: asked.pop(f"{side}_modulus", None) for side in ("warp", "weft")}
    both, undulation = asked.pop("fibre_modulus", None), asked.pop("undulation", None)
    yarns = {
        side: changed(
            getattr(base, side), modulus=moduli[side] if both is None else both, undulation=undulation, **common
        )
        for side in ("warp", "weft")
    }
    return changed(base, resin=resin, thickness=asked.pop("thickness"), **yarns)
