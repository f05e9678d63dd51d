"""What the commands that take a measurement share: their options, and reading what these name."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

import click

from geomdrap.cli.values import Direction, Mapping, Number, Origin, Pair

if TYPE_CHECKING:
    from geomdrap.measurement import Measurement, Setup
    from geomdrap.surface import Surface

F = TypeVar("F", bound=Callable[..., Any])


class Asked(NamedTuple):
    """A part, a measurement, and how the ply was laid: keywords of `geomdrap.compare`; notes on what was assumed.

    ``taken`` are the keywords that a model said.
    """

    surface: Surface
    measurement: Measurement
    laid: dict[str, Any]
    notes: tuple[str, ...]
    taken: tuple[str, ...] = ()


def measured_argument(function: F) -> F:
    """Add the argument MEASURED, the table."""
    return click.argument("measured", type=click.Path(path_type=Path))(function)


def table_options(function: F) -> F:
    """Add how the measured table is read: --columns, --unit-measured, --mark-spacing, --mark-origin."""
    for option in (
        click.option(
            "--mark-origin",
            type=Pair("I,J"),
            metavar="I,J",
            help="Numbers i, j of the mark that lies on the origin.  [default: 0,0]",
        ),
        click.option(
            "--mark-spacing",
            type=Pair("MM", above=0.0),
            metavar="MM[,MM]",
            help="Spacing of the marks along warp and weft, for tables with mark numbers i, j instead of u, v.",
        ),
        click.option(
            "--unit-measured",
            type=click.Choice(["mm", "cm", "m", "in"]),
            default="mm",
            show_default=True,
            help="Unit of the lengths in the measured table (--unit is that of the part).",
        ),
        click.option(
            "--columns",
            type=Mapping(),
            metavar="x=NAME,...",
            help="Headings of the table for x, y, z, u, v, i, j, shear, warp_x ..., weft_x ..., sigma_xyz, "
            "sigma_shear, sigma_direction, replicate, where they are others.",
        ),
    ):
        function = option(function)
    return function


def setup_options(function: F) -> F:
    """Add how the ply was laid and measured: --setup, or --origin, --angle, --pitch, --sigma-xyz ..."""
    for option in (
        click.option(
            "--sigma-direction",
            type=Number("DEG", above=0.0),
            help="Standard deviation of measured fibre directions, degrees.  [default: from the data, "
            "at last from that of the shear]",
        ),
        click.option(
            "--sigma-shear",
            type=Number("DEG", above=0.0),
            help="Standard deviation of measured shear angles, degrees.  [default: from the data]",
        ),
        click.option(
            "--sigma-xyz",
            type=Number("MM", above=0.0),
            help="Standard deviation of each measured coordinate, mm.  [default: from the data]",
        ),
        click.option(
            "--pitch",
            type=Number("MM", above=0.0),
            help="Side of a cell of the net, mm.  [default: from the part and the marks, and said]",
        ),
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
            "--angle", type=Number("DEG"), help="Heading of the warp at the origin.  [default: 0, and said]"
        ),
        click.option(
            "--origin",
            type=Origin(),
            metavar="centroid|x,y,z|vertex:N",
            help="Where the ply touched first.  [default: centroid, and said]",
        ),
        click.option(
            "--setup",
            type=click.Path(path_type=Path),
            metavar="FILE",
            help="TOML file with origin, angle, pitch, sigma_xyz, sigma_shear, sigma_direction, reference, "
            "mark_spacing, mark_origin; options go before it.",
        ),
    ):
        function = option(function)
    return function


def read_asked(
    part: Path,
    measured: Path,
    *,
    unit: str,
    tolerance: float | None,
    flip: bool,
    setup: Path | None,
    columns: dict[str, str] | None,
    unit_measured: str,
    mark_spacing: tuple[float, float] | None,
    mark_origin: tuple[float, float] | None,
    project: bool,
    model: Path | None = None,
    **given: Any,
) -> Asked:
    """Read set-up, measurement and part, in that order: what is quick to refuse comes first.

    What neither options nor the set-up give is that of the ply to which a ``model`` was fitted, where it says.
    """
    import geomdrap as gd
    from geomdrap.cli.acting import said_of_model
    from geomdrap.effects import read_layup
    from geomdrap.measurement import Setup

    known = gd.read_setup(setup) if setup is not None else Setup()
    measurement = gd.read_measurement(
        measured,
        columns=columns,
        unit=unit_measured,
        mark_spacing=mark_spacing or known.mark_spacing,
        mark_origin=mark_origin or known.mark_origin or (0.0, 0.0),
    )
    surface = gd.read_surface(part, unit=unit, tolerance=tolerance, flip=flip)
    meant = read_layup(model) if model is not None else {}
    laid, taken, notes = _laid(known, given, meant)
    if taken and model is not None:
        notes = (said_of_model(taken, model), *notes)
    return Asked(surface, measurement, {**laid, "project": project}, notes, tuple(taken))


def _laid(
    known: Setup, given: dict[str, Any], meant: dict[str, Any]
) -> tuple[dict[str, Any], list[str], tuple[str, ...]]:
    """Keywords of `compare` from options, else the set-up, else what was ``meant``, else defaults, which are said.

    With them the names of those that were meant.
    """
    laid = {name: getattr(known, name) if value is None else value for name, value in given.items()}
    taken = [name for name in meant if name in laid and laid[name] is None]
    laid.update({name: meant[name] for name in taken})
    notes = []
    for name, default, words in (("origin", "centroid", "the area centroid"), ("angle", 0.0, "0 degrees")):
        if laid[name] is None:
            laid[name] = default
            notes.append(f"{name} not given (--{name}, or --setup): {words} is taken")
    return laid, taken, tuple(notes)
