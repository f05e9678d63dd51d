"""``geomdrap compare``: a drape against measured points."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from geomdrap.cli.measured import measured_argument, setup_options, table_options
from geomdrap.cli.options import (
    effect_options,
    folder_option,
    json_option,
    part_argument,
    quiet_option,
    reading_options,
)
from geomdrap.cli.values import Names

COMPARE_OUTPUTS = ("json", "csv", "vtu", "png")  # the keys of export.compare_outputs.COMPARE_OUTPUTS; a test compares


@click.command()
@part_argument
@measured_argument
@setup_options
@table_options
@reading_options
@effect_options
@click.option(
    "--facets",
    is_flag=True,
    help="Drape on the facets themselves, as other tools do, not on the smooth tool that they stand for.",
)
@folder_option("compare", "Folder for the result files; it is made if it is missing.")
@click.option(
    "--outputs",
    type=Names(COMPARE_OUTPUTS),
    metavar="name,name,...",
    default=",".join(COMPARE_OUTPUTS),
    show_default=True,
    help="Which result files to write; none writes none.",
)
@json_option
@quiet_option
def compare(
    part: Path,
    measured: Path,
    folder: Path,
    outputs: tuple[str, ...],
    effect_texts: tuple[str, ...],
    model: Path | None,
    plugins: tuple[Path, ...],
    facets: bool,
    as_json: bool,
    quiet: bool,
    **asked: Any,
) -> int:
    """Hold a drape of PART against the points in MEASURED: where it fails, and by how much.

    MEASURED is a table (CSV with commas, semicolons or tabs, a header, # comments): x, y, z in mm; u, v where
    marks were drawn on the flat fabric; shear in degrees; fibre directions warp_x, warp_y, warp_z and weft_x ...;
    sigma_xyz, sigma_shear, sigma_direction and replicate, where known. Without u, v a point is held
    against the nearest point of the drape, and its position only along the normal. The drape lies on the smooth tool
    that the facets stand for, as the ply does; --facets is for nodes that another program has put on the facets.
    What neither options nor --setup say of the ply is taken from the --model, where that says it.

    \b
    Examples:
      geomdrap compare part.stl measured.csv --setup setup.toml
      geomdrap compare part.stl measured.csv --setup setup.toml --model model.toml
      geomdrap compare part.stl measured.csv --origin 0,0,85 --angle 45 --sigma-xyz 0.2 -o against
      geomdrap compare part.stl grid.csv --columns i=index_x,j=index_y --mark-spacing 10 --angle 45
      geomdrap compare part.stl dic.txt --columns x=X,y=Y,z=Z,shear=Gamma --unit-measured m --json
    """
    import geomdrap as gd
    from geomdrap.cli.acting import blaming, effects_of
    from geomdrap.cli.compare_summary import summary
    from geomdrap.cli.measured import read_asked
    from geomdrap.cli.messages import of_an_earlier_run, print_json, say
    from geomdrap.cli.progress import Progress, announce_compilation
    from geomdrap.export.compare_json import as_dict
    from geomdrap.export.compare_outputs import COMPARE_OUTPUTS as COMPARE_FILES
    from geomdrap.export.compare_outputs import write_comparison
    from geomdrap.export.outputs import left_over
    from geomdrap.export.whole import check_writable

    if outputs:
        check_writable(folder)
    with Progress(quiet) as progress:
        progress.step("Reading")
        effects = effects_of(effect_texts, model, plugins)
        ready = read_asked(part, measured, model=model, **asked)
        announce_compilation(quiet)
        progress.step("Comparing")
        with blaming(model, ready.taken):
            result = gd.compare(ready.surface, ready.measurement, **ready.laid, effects=effects, smooth=not facets)
        progress.step("Writing")
        files = write_comparison(result, folder, outputs)
    known = [output.file for output in COMPARE_FILES.values()]
    left = of_an_earlier_run(left_over(folder, files.values(), known) if files else [], folder)
    say((*result.warnings, *left), (*ready.notes, *result.notes), quiet)
    if as_json:
        print_json(as_dict(result, files))
    elif not quiet:
        click.echo(summary(result, files))
    return 0
