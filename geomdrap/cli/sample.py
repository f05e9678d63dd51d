"""``geomdrap sample``: parts to try things on."""

from __future__ import annotations

from pathlib import Path

import click

from geomdrap.cli.options import folder_option, json_option


@click.command()
@click.argument("name", required=False)
@click.option("--list", "listing", is_flag=True, help="List the samples instead of writing one.")
@click.option(
    "--facets",
    type=click.IntRange(min=200),
    help="How many facets, met within 5 %.  [default: as in samples/parts]",
)
@folder_option(".", "Folder for the files; it is made if it is missing.")
@json_option
def sample(name: str | None, listing: bool, facets: int | None, folder: Path, as_json: bool) -> None:
    """Write the sample part NAME.

    \b
    Examples:
      geomdrap sample --list
      geomdrap sample double-dome -o parts
      geomdrap sample hood --facets 55000
    """
    if listing == (name is not None):
        raise click.UsageError("give either the NAME of a sample or --list")
    if listing:
        _print_list(as_json)
    else:
        _write(str(name), folder, facets, as_json)


def _print_list(as_json: bool) -> None:
    from geomdrap.cli.messages import print_json
    from geomdrap.surface import samples

    table = {name: samples.describe(name) for name in samples.names()}
    if as_json:
        rows = [{"name": name, "description": text} for name, text in table.items()]
        print_json({"schema": "geomdrap.samples/1", "samples": rows})
        return
    width = max(map(len, table))
    for name, text in table.items():
        click.echo(f"{name:<{width}}  {text}")


def _write(name: str, folder: Path, facets: int | None, as_json: bool) -> None:
    from geomdrap.cli.messages import print_json
    from geomdrap.export.whole import check_writable
    from geomdrap.surface import samples

    samples.find(name)  # an unknown name leaves no folder behind
    check_writable(folder)
    folder.mkdir(parents=True, exist_ok=True)
    files = samples.write(name, folder, facets)
    if as_json:
        print_json({"schema": "geomdrap.sample/1", "name": name, "files": [str(file) for file in files]})
        return
    for file in files:
        click.echo(f"wrote {file}")
