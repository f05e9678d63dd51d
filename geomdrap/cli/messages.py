"""Where words go: results to stdout, messages to stderr."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import click


def say(warnings: Iterable[str], notes: Iterable[str], quiet: bool) -> None:
    """Put warnings, and notes unless ``quiet``, on stderr, a line each."""
    for text in warnings:
        click.echo(f"Warning: {text}", err=True)
    if not quiet:
        for text in notes:
            click.echo(f"Note: {text}", err=True)


def print_json(document: dict[str, Any]) -> None:
    """Print a JSON document on stdout, and nothing else."""
    from geomdrap.export.report_json import as_text

    click.echo(as_text(document), nl=False)
