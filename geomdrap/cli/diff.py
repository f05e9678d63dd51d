"""``geomdrap diff``: what changed between two results."""

from __future__ import annotations

from pathlib import Path

import click

from geomdrap.cli.options import json_option
from geomdrap.cli.values import NamedPath, Number


@click.command()
@click.argument("old", type=NamedPath())
@click.argument("new", type=NamedPath())
@click.option(
    "--tol-mm",
    type=Number("MM", least=0.0),
    default=1e-6,
    show_default=True,
    help="Largest move that is no change, mm; areas and shares are judged by it too.",
)
@click.option(
    "--tol-deg",
    type=Number("DEG", least=0.0),
    default=1e-6,
    show_default=True,
    help="Largest turn or difference of shear that is no change, degrees.",
)
@json_option
def diff(old: Path, new: Path, tol_mm: float, tol_deg: float, as_json: bool) -> int:
    """Say what changed from OLD to NEW, where, and by how much.

    OLD and NEW are result folders, of which drape.json, nodes.csv, flat.dxf and flat.svg are compared, or
    two files of one of these kinds. Exit code 0 if nothing changed, 1 if anything did.

    \b
    Examples:
      geomdrap diff golden/hood result/hood
      geomdrap diff golden/nodes.csv result/nodes.csv --tol-mm 0.01
    """
    from geomdrap.cli.messages import print_json, say
    from geomdrap.export.diff import Tolerance, compare

    result = compare(old, new, Tolerance(mm=tol_mm, deg=tol_deg))
    if as_json:
        print_json(result.as_dict())
        return int(result.changed)
    say((), result.notes, quiet=False)
    for change in result.changes:
        click.echo(str(change))
    if not result.changed:
        click.echo(f"no change in {', '.join(result.compared)}")
    return int(result.changed)
