"""``geomdrap drape``: a part in, net, maps, flat pattern and statistics out."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from geomdrap.cli.elements import fe_mesh_of, notes_on, ply_on
from geomdrap.cli.folders import check_folder
from geomdrap.cli.lazy import COMMAND
from geomdrap.cli.options import (
    cloth_options,
    cut_option,
    effect_options,
    element_options,
    folder_option,
    json_option,
    outputs_option,
    part_argument,
    quiet_option,
    reading_options,
    roll_options,
    seed_options,
)
from geomdrap.cli.roll import check_roll, on_roll
from geomdrap.cli.values import NamedPath, Numbers

if TYPE_CHECKING:
    from geomdrap.cli.progress import Progress
    from geomdrap.fields import Drape

GUIDES = ("warp_guide", "weft_guide")
THICKNESS = 0.25  # mm, of a usual ply of woven prepreg


@click.command()
@part_argument
@seed_options
@cloth_options("from the part's size, without --plies halved while the checks call it coarse, and said")
@effect_options
@cut_option
@reading_options
@folder_option("drape", "Folder for the result files; it is made if it is missing.")
@outputs_option
@click.option(
    "--warp-guide",
    type=NamedPath(),
    metavar="FILE.csv",
    help="Curve on the part (columns x, y, z) that the warp through the origin follows, in place of --angle.",
)
@click.option(
    "--weft-guide",
    type=NamedPath(),
    metavar="FILE.csv",
    help="The same for the weft; with both the ply is laid from where they cross.",
)
@click.option(
    "--plies",
    type=Numbers(),
    metavar="DEG,DEG,...",
    help="A stack instead of one ply: angles from --angle, the tool's side first, each ply draped on those below it.",
)
@roll_options
@element_options
@click.option(
    "--paper",
    type=click.Choice(["A4", "A3"], case_sensitive=False),
    default="A4",
    show_default=True,
    help="Paper of the pages of cut.pdf, which --outputs pdf writes in true scale.",
)
@click.option("--strict", is_flag=True, help="Exit with code 1 if less than 99.5 % of the part is covered.")
@json_option
@quiet_option
def drape(
    folder: Path,
    outputs: tuple[str, ...],
    plies: tuple[float, ...] | None,
    onto: Path | None,
    fe_axis: tuple[float, float, float] | None,
    ply_thickness: float | None,
    paper: str,
    strict: bool,
    as_json: bool,
    quiet: bool,
    **asked: Any,
) -> int:
    """Drape PART: net, shear map, flat pattern, statistics.

    PART is a mesh (STL, OBJ, PLY, OFF, GLB, VTU, Gmsh, Abaqus, Nastran) or, with the cad extra, STEP or
    IGES. All result files, with --plies those of each ply, are written at the end, together: a run that fails before
    that leaves earlier ones untouched.

    \b
    Examples:
      geomdrap drape hood.stl
      geomdrap drape hemisphere.stl --origin -5,5,84.4 --angle 45 --pitch 4 -o hemisphere-45
      geomdrap drape hood.stl --origin vertex:120 --blank 800x600 --outputs json,dxf --json
      geomdrap drape hood.stl --warp-guide spine.csv
      geomdrap drape box.stl --cut corner-1.csv --cut corner-2.csv
      geomdrap drape hood.stl --plies 0,45,-45,90 --ply-thickness 0.3 -o laminate
      geomdrap drape hood.stl --effect slip:coefficient=0.6 --effect thickness:offset=1.5
      geomdrap drape hood.stl --angle 45 --outputs cut,pdf --paper A3
      geomdrap drape hood.stl --angle 45 --roll-width 600 --seam-overlap 20
      geomdrap drape hood.stl --angle 45 --onto hood_fe.inp --ply-thickness 0.3
    """
    from geomdrap.cli.acting import blaming, said_of_model
    from geomdrap.cli.messages import of_an_earlier_run, print_json, say
    from geomdrap.cli.progress import Progress, announce_compilation
    from geomdrap.cli.summary import summary
    from geomdrap.export.outputs import Extras, left_over, write_all
    from geomdrap.export.report_json import as_dict, is_incomplete

    check_folder(folder, outputs)
    context = click.get_current_context()
    if context.get_parameter_source("angle") == ParameterSource.COMMANDLINE:
        _refuse_guides(asked, "--angle")
    check_roll(asked["roll_width"], asked["seam_overlap"])
    if plies is not None:
        from geomdrap.cli.plies import drape_plies

        _refuse_guides(asked, "--plies")
        if onto is not None or fe_axis is not None:
            raise click.UsageError("--onto and --fe-axis take one ply: leave --plies out", context)
        extras = Extras(context.meta.get(COMMAND, ""), None, ply_thickness or THICKNESS, paper)
        laid = {name: value for name, value in asked.items() if name not in GUIDES}
        return drape_plies(plies, extras, folder, outputs, strict, as_json, quiet, **laid)
    meant = _layup_of_model(asked["model"], context)
    asked.update(meant)
    mesh, outputs = fe_mesh_of(onto, outputs)
    with Progress(quiet) as progress, blaming(asked["model"], list(meant)):
        result = compute(progress, lambda: announce_compilation(quiet), **asked)
        progress.step("Writing")
        command = click.get_current_context().meta.get(COMMAND, "")
        elements = ply_on(result, mesh, fe_axis, outputs)
        files = write_all(result, folder, outputs, progress.share, Extras(command, elements, ply_thickness, paper))
    left = of_an_earlier_run(left_over(folder, files.values()) if files else [], folder)
    more = (*notes_on(elements, outputs), *left)
    taken = [said_of_model(list(meant), asked["model"])] if meant else []
    say((*result.warnings, *more), (*taken, *result.net.notes), quiet)
    if as_json:
        document = as_dict(result, files)
        print_json({**document, "warnings": [*document["warnings"], *more]})
    elif not quiet:
        click.echo(summary(result, files))
    return int(strict and is_incomplete(result))


def _layup_of_model(model: Path | None, context: click.Context) -> dict[str, Any]:
    """Origin, heading and reference of a model's ply, where the command line does not give them.

    A placement was fitted to these: with others the ply would be displaced from another place.
    """
    if model is None:
        return {}
    from geomdrap.effects import read_layup

    given = ParameterSource.COMMANDLINE
    return {k: v for k, v in read_layup(model).items() if context.get_parameter_source(k) != given}


def _refuse_guides(asked: Mapping[str, Any], other: str) -> None:
    """Refuse guide curves beside an option that says something else."""
    for name in GUIDES:
        if asked[name] is not None:
            option = "--" + name.replace("_", "-")
            raise click.UsageError(f"{option} and {other} contradict each other", click.get_current_context())


def read_guides(**files: Path | None) -> dict[str, Any]:
    """The points of guide curves by name."""
    from geomdrap.sweep.origins import read_points

    return {name: read_points(file) for name, file in files.items() if file is not None}


def compute(
    progress: Progress,
    before_drape: Callable[[], None] = lambda: None,
    *,
    part: Path,
    unit: str,
    tolerance: float | None,
    flip: bool,
    cuts: tuple[Path, ...] = (),
    blank: tuple[float, float] | None,
    limit_angle: float | None,
    effect_texts: tuple[str, ...] = (),
    model: Path | None = None,
    warp_guide: Path | None = None,
    weft_guide: Path | None = None,
    plugins: tuple[Path, ...] = (),
    roll_width: float | None = None,
    seam_overlap: float | None = None,
    **drape_options: Any,
) -> Drape:
    """Read, drape, evaluate and lay on the roll; ``drape_options`` go to `geomdrap.drape` as they are."""
    import geomdrap as gd
    from geomdrap.cli.acting import effects_of
    from geomdrap.cli.part import read_part
    from geomdrap.cli.pitch import finer_where_coarse, require_room

    effects = effects_of(effect_texts, model, plugins)
    progress.step("Reading")
    surface = read_part(part, unit, tolerance, flip, cuts)
    asked = drape_options.pop("pitch", None)
    if asked is not None:
        require_room(surface, asked)
    before_drape()
    reach = (blank[0] / 2, blank[1] / 2) if blank else None
    guides = read_guides(warp_guide=warp_guide, weft_guide=weft_guide)

    def at(pitch: float | None) -> Drape:
        progress.step("Draping")
        net = gd.drape(surface, pitch=pitch, reach=reach, effects=effects, **guides, **drape_options)
        progress.step("Evaluating")
        result: Drape = gd.evaluate(net, limit_angle, progress.share)
        return result

    draped = at(asked) if asked is not None else finer_where_coarse(at(None), at)
    return on_roll(draped, roll_width, seam_overlap)
