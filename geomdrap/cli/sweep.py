"""``geomdrap sweep``: many origins and headings, ranked."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from geomdrap.cli.lazy import COMMAND
from geomdrap.cli.options import (
    cloth_options,
    cut_option,
    effect_options,
    folder_option,
    json_option,
    part_argument,
    quiet_option,
    reading_options,
)
from geomdrap.cli.sweeping import SWEEP_OUTPUTS, lay_options, objective_option, place_options, resume_option
from geomdrap.cli.values import Names


@click.command()
@part_argument
@click.option(
    "--angles",
    default="0:90:5",
    show_default=True,
    metavar="START:STOP:STEP,...",
    help="Headings, degrees: ranges with both ends included, and single ones.",
)
@click.option(
    "--origins",
    multiple=True,
    metavar="centroid|x,y,z|vertex:N|grid:NxM|FILE.csv",
    help="Where the ply touches first; may be given more than once. A grid lies over the part seen along its mean "
    "normal; a file has columns x, y, z in mm.  [default: centroid]",
)
@lay_options
@cloth_options()
@effect_options
@objective_option
@click.option(
    "--pareto",
    metavar="NAME,NAME,...",
    default="p95-shear,coverage,blank-area",
    show_default=True,
    help="Criteria between which the best compromises are marked.",
)
@place_options
@resume_option
@cut_option
@reading_options
@folder_option("sweep", "Folder for the result files; it is made if it is missing.")
@click.option(
    "--outputs",
    type=Names(SWEEP_OUTPUTS),
    metavar="name,name,...",
    default=",".join(SWEEP_OUTPUTS),
    show_default=True,
    help="Which results to write; best is the best case, draped, with all its files; none writes none.",
)
@json_option
@quiet_option
def sweep(
    angles: str,
    origins: tuple[str, ...],
    pareto: str,
    resume: bool,
    folder: Path,
    outputs: tuple[str, ...],
    as_json: bool,
    quiet: bool,
    **asked: Any,
) -> int:
    """Drape PART from many origins and headings, and rank them.

    Each case becomes a row: shear, coverage, fabric and the rectangular blank. Rows are kept as they come, so that a
    run that was interrupted goes on with --resume. Cases that cannot be draped are rows with the reason. What a drape
    leaves bare counts in every objective: each per cent beyond 0.5 as 10 degrees, 10 points, or 10 % of the part.

    \b
    Examples:
      geomdrap sweep hood.stl --angles 0:90:5
      geomdrap sweep hood.stl --angles 0:90:5 --origins grid:5x5 -j 4 --objective p95-shear=1,waste=0.2
      geomdrap sweep hood.stl --origins seeds.csv --effect slip:coefficient=0.6 --resume
      geomdrap sweep hood.stl --origins grid:20x20 --scheduler tcp://10.0.0.5:8786 --json
    """
    from geomdrap.cli.folders import check_folder
    from geomdrap.cli.messages import print_json, say
    from geomdrap.cli.progress import Progress
    from geomdrap.cli.sweep_summary import summary
    from geomdrap.cli.sweeping import prepare, recorded
    from geomdrap.export.sweep_json import as_dict
    from geomdrap.export.sweep_outputs import write_sweep
    from geomdrap.sweep import cases_of, locate_origins, parse_angles, run
    from geomdrap.sweep.objective import parse_criteria

    check_folder(folder, outputs, resume)
    headings, criteria = parse_angles(angles), parse_criteria(pareto)
    with Progress(quiet) as progress:
        ready = prepare(progress, quiet, **asked)
        places, notes = locate_origins(ready.job.surface, origins or ("centroid",), ready.job.pitch, ready.project)
        cases = cases_of(places, headings)
        progress.step("Sweeping")
        with recorded(progress, ready, cases, folder if outputs else None, resume) as running:
            result = run(
                ready.job, cases, ready.objective, criteria=criteria,
                pool=running.pool, done=running.earlier, on_row=running.take,
            )  # fmt: skip
            running.take.finish()
            progress.step("Draping the best")
            best = result.draped_best()
            progress.step("Writing")
            command = click.get_current_context().meta.get(COMMAND, "")
            files = write_sweep(result, best, folder, outputs, progress.share, notes, command)
    say(best.warnings, (*notes, *best.net.notes), quiet)
    if as_json:
        print_json(as_dict(result, best, files, notes))
    elif not quiet:
        click.echo(summary(result, files))
    return 0
