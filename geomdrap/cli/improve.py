"""``geomdrap improve``: the missing effects added one by one, and the error falling."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from geomdrap.cli.measured import measured_argument, setup_options, table_options
from geomdrap.cli.options import json_option, part_argument, plugin_option, quiet_option, reading_options


@click.command()
@part_argument
@measured_argument
@setup_options
@table_options
@reading_options
@plugin_option
@click.option(
    "-o",
    "--output",
    "model",
    metavar="FILE.toml",
    type=click.Path(path_type=Path),
    default=Path("model.toml"),
    show_default=True,
    help="The improved model, for drape --model; improve.json and improve.png are written beside it.",
)
@json_option
@quiet_option
def improve(
    part: Path, measured: Path, model: Path, plugins: tuple[Path, ...], as_json: bool, quiet: bool, **asked: Any
) -> int:
    """Add missing effects to the drape of PART, one by one, until it agrees with MEASURED to the noise.

    Writes the improved model, and a picture of how the error falls, held out too. What stays unexplained is said.
    MEASURED and the options are those of compare.

    \b
    Examples:
      geomdrap improve part.stl measured.csv --setup setup.toml -o model.toml
      geomdrap improve part.stl measured.csv --origin 0,0,85 --angle 45 --json
    """
    import geomdrap as gd
    from geomdrap.cli.acting import effects_of
    from geomdrap.cli.diagnose_summary import improvement_summary
    from geomdrap.cli.measured import read_asked
    from geomdrap.cli.messages import print_json, say
    from geomdrap.cli.progress import Progress, announce_compilation
    from geomdrap.export.diagnose_outputs import write_improvement
    from geomdrap.export.whole import check_writable

    if model.suffix.lower() != ".toml":
        raise click.UsageError(
            f"-o names the model file, which ends in .toml, not '{model}'", click.get_current_context()
        )
    check_writable(model.parent)
    with Progress(quiet) as progress:
        progress.step("Reading")
        effects_of((), None, plugins)
        ready = read_asked(part, measured, **asked)
        announce_compilation(quiet)
        progress.step("Improving")
        result = gd.improve(ready.surface, ready.measurement, **ready.laid, progress=progress.share)
        progress.step("Writing")
        files = write_improvement(result, model)
    say(result.diagnosis.warnings, (*ready.notes, *result.diagnosis.notes), quiet)
    if as_json:
        print_json(result.as_dict(str(model)))
    elif not quiet:
        click.echo(improvement_summary(result, files))
    return 0
