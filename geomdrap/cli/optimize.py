"""``geomdrap optimize``: the origin and the heading with the best drape."""

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
    metavar="START:STOP:STEP,...",
    help="Headings from which the search begins.  [default: 0:75:15; 0:165:15 with effects or an oblong --blank]",
)
@click.option(
    "--origins",
    multiple=True,
    metavar="centroid|x,y,z|vertex:N|grid:NxM|FILE.csv",
    help="Origins from which it begins; may be given more than once.  [default: centroid and grid:5x5]",
)
@click.option(
    "--budget",
    type=click.IntRange(min=0),
    default=800,
    show_default=True,
    metavar="N",
    help="Most drapes of the search, after those from which it begins.",
)
@lay_options
@cloth_options()
@effect_options
@objective_option
@place_options
@resume_option
@cut_option
@reading_options
@folder_option("optimize", "Folder for the result files; it is made if it is missing.")
@click.option(
    "--outputs",
    type=Names(SWEEP_OUTPUTS),
    metavar="name,name,...",
    default=",".join(SWEEP_OUTPUTS),
    show_default=True,
    help="Which results to write; best is the best drape with all its files; none writes none.",
)
@json_option
@quiet_option
def optimize(
    angles: str | None,
    origins: tuple[str, ...],
    budget: int,
    resume: bool,
    folder: Path,
    outputs: tuple[str, ...],
    as_json: bool,
    quiet: bool,
    **asked: Any,
) -> int:
    """Find the origin and the heading of PART with the best drape.

    A sweep, and seeds scattered between its origins, find where good drapes lie. From the three best a pattern search
    goes on, the origin sliding over the part and the heading turning, until no step of a quarter of the pitch or of
    the degree is better. Every value is that of a real drape; the result is never worse than the best of the sweep.

    \b
    Examples:
      geomdrap optimize hemisphere.stl
      geomdrap optimize hood.stl --objective p95-shear=1,waste=0.2 --origins grid:7x7 -j 4
      geomdrap optimize hood.stl --origins centroid --angles 0:170:10 --budget 100 --json
    """
    import geomdrap as gd
    from geomdrap.cli.folders import check_folder
    from geomdrap.cli.messages import print_json, say
    from geomdrap.cli.optimize_summary import summary
    from geomdrap.cli.progress import Progress
    from geomdrap.cli.sweeping import prepare, recorded
    from geomdrap.export.optimize_json import as_dict
    from geomdrap.export.sweep_outputs import write_optimum
    from geomdrap.sweep.optimize import first_headings

    check_folder(folder, outputs, resume)
    headings = gd.sweep.parse_angles(angles) if angles is not None else None
    with Progress(quiet) as progress:
        ready = prepare(progress, quiet, **asked)
        job = ready.job
        headings = headings or first_headings(job)
        places, notes = gd.sweep.locate_origins(
            job.surface, origins or ("centroid", "grid:5x5"), job.pitch, ready.project
        )
        cases = gd.sweep.cases_of(places, headings)
        progress.step("Searching")
        with recorded(progress, ready, cases, folder if outputs else None, resume, budget) as running:
            result = gd.sweep.optimize(
                job, cases, ready.objective, budget=budget,
                pool=running.pool, done=running.earlier, on_row=running.take,
            )  # fmt: skip
            running.take.finish()
            progress.step("Draping the best")
            best = result.sweep.draped_best()
            progress.step("Writing")
            command = click.get_current_context().meta.get(COMMAND, "")
            files = write_optimum(result, best, folder, outputs, progress.share, notes, command)
    say(best.warnings, (*notes, *best.net.notes), quiet)
    if as_json:
        print_json(as_dict(result, best, files, notes))
    elif not quiet:
        click.echo(summary(result, files))
    return 0
