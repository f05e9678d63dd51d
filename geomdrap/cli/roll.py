"""The roll of fabric that a command line names, and plies laid from it."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import click

if TYPE_CHECKING:
    from geomdrap.fields import Drape


def check_roll(width: float | None, overlap: float | None) -> None:
    """Refuse an overlap of strips without the roll that they are of."""
    if overlap is not None and width is None:
        raise click.UsageError(
            "--seam-overlap is of strips of a roll: give --roll-width, too", click.get_current_context()
        )


def on_roll(result: Drape, width: float | None, overlap: float | None) -> Drape:
    """The drape with its pattern laid from strips of the roll; as it is where none is named."""
    if width is None:
        return result
    from geomdrap.fields.roll import lay_on_roll

    return replace(result, roll=lay_on_roll(result, width, overlap or 0.0))
