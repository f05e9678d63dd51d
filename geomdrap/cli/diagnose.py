"""``geomdrap diagnose``: which physical effect the model lacks."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from geomdrap.cli.measured import measured_argument, setup_options, table_options
from geomdrap.cli.options import (
    folder_option,
    json_option,
    part_argument,
    plugin_option,
    quiet_option,
    reading_options,
)
from geomdrap.cli.values import Names

DIAGNOSE_OUTPUTS = ("json", "png")  # the keys of export.diagnose_outputs.DIAGNOSE_OUTPUTS; a test compares


@click.command()
@part_argument
@measured_argument
@setup_options
@table_options
@reading_options
@plugin_option
@folder_option("diagnose", "Folder for the result files; it is made if it is missing.")
@click.option(
    "--outputs",
    type=Names(DIAGNOSE_OUTPUTS),
    metavar="name,name,...",
    default=",".join(DIAGNOSE_OUTPUTS),
    show_default=True,
    help="Which result files to write; none writes none.",
)
@json_option
@quiet_option
def diagnose(
    part: Path,
    measured: Path,
    folder: Path,
    outputs: tuple[str, ...],
    plugins: tuple[Path, ...],
    as_json: bool,
    quiet: bool,
    **asked: Any,
) -> int:
    """Say which physical effect the drape of PART lacks, by the points in MEASURED.

    The placement of the ply is fitted first. Then every effect of the library is tried on top of it, under lay-up
    scatter, and kept only if it foretells held-out parts of the ply. The verdict is none, placement, an effect, two,
    ambiguous (with the candidates and what to measure to tell them apart) or unknown. MEASURED and the options are
    those of compare.

    \b
    Examples:
      geomdrap diagnose part.stl measured.csv --setup setup.toml
      geomdrap diagnose part.stl measured.csv --setup setup.toml --plugin my_effect.py
      geomdrap diagnose part.stl measured.csv --origin 0,0,85 --angle 45 --sigma-xyz 0.2 --json
    """
    import geomdrap as gd
    from geomdrap.cli.acting import effects_of
    from geomdrap.cli.diagnose_summary import summary
    from geomdrap.cli.measured import read_asked
    from geomdrap.cli.messages import of_an_earlier_run, print_json, say
    from geomdrap.cli.progress import Progress, announce_compilation
    from geomdrap.export.diagnose_outputs import DIAGNOSE_OUTPUTS as DIAGNOSE_FILES
    from geomdrap.export.diagnose_outputs import as_dict, write_diagnosis
    from geomdrap.export.outputs import left_over
    from geomdrap.export.whole import check_writable

    if outputs:
        check_writable(folder)
    with Progress(quiet) as progress:
        progress.step("Reading")
        effects_of((), None, plugins)
        ready = read_asked(part, measured, **asked)
        announce_compilation(quiet)
        progress.step("Diagnosing")
        result = gd.diagnose(ready.surface, ready.measurement, **ready.laid, progress=progress.share)
        progress.step("Writing")
        files = write_diagnosis(result, folder, outputs)
    left = of_an_earlier_run(left_over(folder, files.values(), DIAGNOSE_FILES.values()) if files else [], folder)
    say((*result.warnings, *left), (*ready.notes, *result.notes), quiet)
    if as_json:
        print_json(as_dict(result, files))
    elif not quiet:
        click.echo(summary(result, files))
    return 0
