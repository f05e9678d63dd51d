"""Options that commands share, as decorators."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

import click

from geomdrap.cli.values import Direction, NamedPath, Names, Number, Origin, Size

USUAL = ("json", "csv", "vtu", "png", "dxf", "svg", "html")  # export.outputs.USUAL; a test compares
FE_OUTPUTS = ("abaqus", "nastran", "optistruct", "radioss", "acp")
OUTPUTS = (*USUAL, "cut", "pdf", *FE_OUTPUTS)  # the keys of export.outputs.OUTPUTS; a test compares

F = TypeVar("F", bound=Callable[..., Any])


def _path() -> click.Path:
    return NamedPath()


def part_argument(function: F) -> F:
    """Add the argument PART, the mesh file."""
    return click.argument("part", type=_path())(function)


def reading_options(function: F) -> F:
    """Add how the part's file is read: --unit, --tolerance, --flip."""
    for option in (
        click.option("--flip", is_flag=True, help="Turn the part's normal: the ply lies on the other side."),
        click.option(
            "--tolerance",
            type=Number("MM", above=0.0),
            help="Chord error of the tessellation of STEP and IGES parts.  [default: from the part's size]",
        ),
        click.option(
            "--unit",
            type=click.Choice(["mm", "cm", "m", "in"]),
            default="mm",
            show_default=True,
            help="Unit of the numbers in the part's file; everything else stays in mm.",
        ),
    ):
        function = option(function)
    return function


def cut_option(function: F) -> F:
    """Add --cut FILE.csv, lines along which the part is cut."""
    return click.option(
        "--cut",
        "cuts",
        type=_path(),
        multiple=True,
        metavar="FILE.csv",
        help="Line on the part (columns x, y, z) that the ply does not pass: a cut, or a dart where its sides draw "
        "apart in the flat pattern. May be given more than once.",
    )(function)


def seed_options(function: F) -> F:
    """Add where and how the ply starts: --origin, --angle, --reference, --project."""
    for option in (
        click.option(
            "--project",
            is_flag=True,
            help="Let --origin x,y,z lie further from the part than one pitch: the nearest point is taken.",
        ),
        click.option(
            "--reference",
            type=Direction(),
            metavar="x,y,z",
            help="Direction from which --angle counts.  [default: +x, or +y where x is along the normal]",
        ),
        click.option(
            "--angle",
            type=Number("DEG"),
            default=0.0,
            help="Heading of the warp at the origin, counter-clockwise about the normal.  [default: 0]",
        ),
        click.option(
            "--origin",
            type=Origin(),
            metavar="centroid|x,y,z|vertex:N",
            default="centroid",
            show_default=True,
            help="Where the ply touches first: the area centroid, a point in mm, or a vertex of the file "
            "(counted from 0).",
        ),
    ):
        function = option(function)
    return function


def cloth_options(chosen: str = "from the part's size, once for all drapes, and said") -> Callable[[F], F]:
    """Add the fabric's numbers: --pitch, --blank, --limit-angle; ``chosen``: the pitch if none is given, in words."""

    def add(function: F) -> F:
        for option in (
            click.option(
                "--limit-angle",
                type=Number("DEG", above=0.0, below=90.0),
                help="Shear beyond which maps turn red and statistics count it.  [default: the fabric's]",
            ),
            click.option(
                "--blank",
                type=Size(),
                metavar="WxH",
                help="Size of the blank in mm, along warp times along weft, its middle on the origin.  "
                "[default: as large as the part needs]",
            ),
            click.option(
                "--pitch",
                type=Number("MM", above=0.0),
                help=f"Side of a cell of the net, mm.  [default: {chosen}]",
            ),
        ):
            function = option(function)
        return function

    return add


def plugin_option(function: F) -> F:
    """Add --plugin FILE.py, effects of the user's own."""
    return click.option(
        "--plugin",
        "plugins",
        type=_path(),
        multiple=True,
        metavar="FILE.py",
        help="Python file with effects of your own; may be given more than once.",
    )(function)


def effect_options(function: F) -> F:
    """Add the effects: --effect, --model, --plugin."""
    for option in (
        plugin_option,
        click.option(
            "--model",
            type=_path(),
            metavar="FILE.toml",
            help="Model file with effects and their values, as `improve` writes it.",
        ),
        click.option(
            "--effect",
            "effect_texts",
            multiple=True,
            metavar="NAME:PARAMETER=VALUE,...",
            help="An effect that acts, as in slip:coefficient=0.6; may be given more than once "
            "(see `geomdrap effects`).",
        ),
    ):
        function = option(function)
    return function


def folder_option(default: str | None, text: str) -> Callable[[F], F]:
    """Add -o/--output DIR."""
    return click.option(
        "-o",
        "--output",
        "folder",
        metavar="DIR",
        type=_path(),
        default=default and Path(default),
        show_default=default is not None,
        help=text,
    )


def outputs_option(function: F) -> F:
    """Add --outputs, the list of result files."""
    return click.option(
        "--outputs",
        type=Names(OUTPUTS),
        metavar="name,name,...",
        default=",".join(USUAL),
        show_default=True,
        help=f"Which result files to write; none writes none. For the cutting table: cut, pdf. "
        f"For finite elements: {', '.join(FE_OUTPUTS)}.",
    )(function)


def roll_options(function: F) -> F:
    """Add the roll that the pattern is laid from: --roll-width, --seam-overlap."""
    for option in (
        click.option(
            "--seam-overlap",
            type=Number("MM", least=0.0),
            help="By how much neighbouring strips of the roll lie on each other at a seam.  [default: 0]",
        ),
        click.option(
            "--roll-width",
            type=Number("MM", above=0.0),
            help="Width of the roll of fabric, along the weft: a higher pattern is laid from strips with seams.",
        ),
    ):
        function = option(function)
    return function


def element_options(function: F) -> F:
    """Add how the ply is handed over to finite elements: --onto, --fe-axis, --ply-thickness."""
    for option in (
        click.option(
            "--ply-thickness",
            type=Number("MM", above=0.0),
            help="Thickness of the flat fabric, for decks with thicknesses.  [default: factors only; "
            "with --plies 0.25]",
        ),
        click.option(
            "--fe-axis",
            type=Direction(),
            metavar="x,y,z",
            help="Direction that, laid into an element, is 0° of its ply angles.  [default: the element's own]",
        ),
        click.option(
            "--onto",
            type=_path(),
            metavar="FE_MESH",
            help="Finite element mesh (.inp, .bdf, .nas, .dat, .fem, .rad, in mm) that the ply is mapped onto; its "
            "format, and acp, are added to --outputs where no format is named.",
        ),
    ):
        function = option(function)
    return function


def json_option(function: F) -> F:
    """Add --json."""
    return click.option("--json", "as_json", is_flag=True, help="Print the result as JSON.")(function)


def quiet_option(function: F) -> F:
    """Add --quiet."""
    return click.option(
        "--quiet", "-q", is_flag=True, help="No summary, notes or progress; warnings and errors stay."
    )(function)
