"""What the user sees when something goes wrong: one line on stderr and an exit code."""

from __future__ import annotations

import os
import sys
import traceback

import click

from geomdrap.errors import GeomdrapError, interrupt_within

BAD_INPUT = 2
BUG = 3
INTERRUPTED = 130


def exit_code_of(error: BaseException) -> int:
    """Say what ``error`` means in one line on stderr, and give the exit code for it.

    With ``GEOMDRAP_TRACEBACK=1`` in the environment the traceback comes first.
    """
    if isinstance(error, click.exceptions.NoArgsIsHelpError):
        click.echo(error.ctx.get_help() if error.ctx else str(error), err=True)
        return BAD_INPUT
    if os.environ.get("GEOMDRAP_TRACEBACK"):
        traceback.print_exception(error)
    code, message = _meaning(interrupt_within(error) or error)
    click.echo(f"Error: {' '.join(message.split())}", err=True)
    return code


def _meaning(error: BaseException) -> tuple[int, str]:
    if isinstance(error, (click.Abort, KeyboardInterrupt)):
        return INTERRUPTED, str(error.__cause__ or error) or "interrupted; nothing was written"
    if isinstance(error, click.ClickException):
        return BAD_INPUT, error.format_message().rstrip(".") + _where_to_look(error)
    if isinstance(error, GeomdrapError):
        return BAD_INPUT, str(error)
    if isinstance(error, OSError):
        return BAD_INPUT, f"{error.filename}: {error.strerror}" if error.filename else str(error)
    if isinstance(error, MemoryError):
        return BAD_INPUT, "not enough memory; a larger --pitch or a coarser mesh needs less"
    kind = type(error).__name__
    return BUG, (
        f"this is a bug in geomdrap ({kind}: {error}); please report it with the traceback, "
        "which GEOMDRAP_TRACEBACK=1 in the environment shows"
    )


def _where_to_look(error: click.ClickException) -> str:
    if not isinstance(error, click.UsageError):
        return ""
    return f" (see '{error.ctx.command_path if error.ctx else 'geomdrap'} --help')"


def hang_up() -> None:
    """Send what is left for stdout to nowhere: its reader is gone (``geomdrap ... | head``)."""
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
