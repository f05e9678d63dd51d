"""``geomdrap check``: is the mesh fit for draping?"""

from __future__ import annotations

from pathlib import Path

import click

from geomdrap.cli.options import json_option, part_argument, reading_options


@click.command()
@part_argument
@reading_options
@json_option
def check(part: Path, unit: str, tolerance: float | None, flip: bool, as_json: bool) -> int:
    """Say whether PART is fit for draping: what is wrong with it, what was repaired.

    Exit code 0 if it can be draped, 2 if not.

    \b
    Examples:
      geomdrap check hood.stl
      geomdrap check hood.stl --unit m --json
    """
    from geomdrap.cli.failures import BAD_INPUT
    from geomdrap.cli.messages import print_json
    from geomdrap.surface import read_surface
    from geomdrap.surface.check import report, text

    surface = read_surface(part, unit=unit, tolerance=tolerance, flip=flip)
    found = report(surface)
    if as_json:
        print_json(found)
    else:
        click.echo(text(surface))
    return 0 if found["drapable"] else BAD_INPUT
