"""The folder that results go to: what is wrong with it is said before anything is computed."""

from __future__ import annotations

from pathlib import Path

import click
from click.core import ParameterSource


def check_folder(folder: Path, outputs: tuple[str, ...], resume: bool = False) -> None:
    """Refuse a folder that cannot be written, or that nothing would go to or, with ``resume``, come from."""
    from geomdrap.export.whole import check_writable

    context = click.get_current_context()
    if outputs:
        check_writable(folder)
    elif context.get_parameter_source("folder") == ParameterSource.COMMANDLINE:
        raise click.UsageError("-o names a folder, but --outputs none writes no files: leave out one", context)
    elif resume:
        raise click.UsageError(
            "--resume needs the rows of a folder, but --outputs none uses none: leave out one", context
        )
