"""Where words go: results to stdout, messages to stderr."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import Any

import click


def say(warnings: Iterable[str], notes: Iterable[str], quiet: bool) -> None:
    """Put warnings, and notes unless ``quiet``, on stderr, a line each."""
    for text in warnings:
        click.echo(f"Warning: {text}", err=True)
    if not quiet:
        for text in notes:
            click.echo(f"Note: {text}", err=True)


def of_an_earlier_run(names: Sequence[str], folder: Path) -> Iterator[str]:
    """Warn of a folder that holds results of two runs, ``names`` those of the earlier one, if there are any."""
    if names:
        verb, them = ("is", "it") if len(names) == 1 else ("are", "them")
        yield f"{', '.join(names)} in {folder} {verb} of an earlier run: remove {them}, or use another folder (-o)"


def print_json(document: dict[str, Any]) -> None:
    """Print a JSON document on stdout, and nothing else."""
    from geomdrap.export.report_json import as_text

    click.echo(as_text(document), nl=False)
