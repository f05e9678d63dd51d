"""``geomdrap effects``: the library of physical effects."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from geomdrap.cli.options import folder_option, json_option, plugin_option

if TYPE_CHECKING:
    from geomdrap.fishnet import Effect, Parameter

WIDTH = 100


@click.command()
@click.argument("name", required=False)
@plugin_option
@folder_option(None, "Folder for a picture of what the effect does to a sample; it is made if it is missing.")
@json_option
def effects(name: str | None, plugins: tuple[Path, ...], folder: Path | None, as_json: bool) -> None:
    """List the effects, or explain the effect NAME: physics, equation, parameters, source.

    With -o a picture shows how it moves the crossings of a net on a bump and changes their shear, at usual values
    or at those of NAME:PARAMETER=VALUE,...

    \b
    Examples:
      geomdrap effects
      geomdrap effects slip
      geomdrap effects shear-stiffness:ratio=0.01 -o pictures
    """
    from geomdrap import effects as library
    from geomdrap.cli.messages import print_json

    for plugin in plugins:
        library.load_plugin(plugin)
    if name is None and folder is not None:
        raise click.UsageError("-o draws one effect; give its NAME as well", click.get_current_context())
    chosen = list(library.available().values()) if name is None else [library.find(name.partition(":")[0])]
    if name is not None and name.partition(":")[2].strip():
        library.parse(name)  # values that cannot be are refused, whether they are drawn or not
    files = {} if name is None or folder is None else _draw(name, folder)
    if as_json:
        rows = [_as_dict(effect) for effect in chosen]
        print_json({"schema": "geomdrap.effects/1", "effects": rows, "files": {k: str(v) for k, v in files.items()}})
        return
    click.echo("\n".join(_table(chosen) if name is None else _page(chosen[0])))
    for file in files.values():
        click.echo(f"wrote {file}")


def _draw(text: str, folder: Path) -> dict[str, Path]:
    """Draw the signature of an effect, at values that show on the sample where none are given."""
    from geomdrap import effects as library
    from geomdrap.cli.progress import Progress, announce_compilation
    from geomdrap.export.signature import shown_values, write_signature
    from geomdrap.export.whole import check_writable

    name, _, values = text.partition(":")
    effect = library.parse(text) if values.strip() else library.make(name.strip())
    if effect.is_neutral and values.strip():
        raise click.UsageError(f"{text} does nothing, so nothing can be drawn; leave out the values, or take others")
    if effect.is_neutral:
        effect = type(effect)(**shown_values(effect))
    check_writable(folder)
    folder.mkdir(parents=True, exist_ok=True)
    announce_compilation(quiet=False)
    with Progress() as progress:
        progress.step("Drawing")
        return {"signature": write_signature(effect, folder)}


def _as_dict(effect: type[Effect]) -> dict[str, Any]:
    words = ("name", "stage", "summary", "equation", "physics", "source", "seen_by")
    return {
        **{word: getattr(effect, word) for word in words},
        "confounded_with": list(effect.confounded_with),
        "parameters": [vars(parameter) for parameter in effect.parameters],
    }


def _table(chosen: list[type[Effect]]) -> Iterator[str]:
    """A line per effect: name, parameters with units, summary."""
    rows = [(e.title(), ", ".join(map(_short, e.parameters)), e.summary) for e in chosen]
    wide, middle = (max(len(row[k]) for row in rows) for k in (0, 1))
    for title, takes, summary in rows:
        yield f"{title:<{wide}}  {takes:<{middle}}  {summary}".rstrip()


def _short(parameter: Parameter) -> str:
    return f"{parameter.name} [{parameter.unit}]" if parameter.unit else parameter.name


def _page(effect: type[Effect]) -> Iterator[str]:
    """All that is known of one effect."""
    yield f"{effect.title()}: {effect.summary}"
    for label, text in (
        ("physics", effect.physics),
        ("equation", effect.equation),
        ("acts on", effect.stage),
        ("seen by", effect.seen_by),
        ("looks like", ", ".join(effect.confounded_with)),
        ("source", effect.source),
    ):
        if text:
            yield textwrap.fill(text, WIDTH, initial_indent=f"{label:<12}", subsequent_indent=" " * 12)
    for p in effect.parameters:
        unit = f" {p.unit}" if p.unit else ""
        bounds = f"{p.low:g} to {p.high:g}{unit}, typical {p.typical:g}, no effect at {p.neutral:g}"
        yield f"{_short(p)}: {p.text}; {bounds}"
