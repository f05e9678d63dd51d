"""The group of commands: imports a command only when it runs, and turns errors into one line."""

from __future__ import annotations

import shlex
from collections.abc import Mapping
from importlib import import_module
from typing import Any

import click

from geomdrap.cli.failures import exit_code_of, hang_up

COMMAND = "geomdrap.command"
"""Key under which a context's ``meta`` holds the command line, as a shell would take it."""


class LazyGroup(click.Group):
    """A click group whose command ``name`` is the object ``name`` in the module ``package.name``.

    ``summaries`` maps names to their line in ``--help``, so that listing them imports nothing.
    """

    def __init__(
        self, *args: Any, package: str = "", summaries: Mapping[str, str] | None = None, **more: Any
    ):
        super().__init__(*args, **more)
        self.package = package
        self.summaries = dict(summaries or {})

    def list_commands(self, ctx: click.Context) -> list[str]:
        """Give the names of the commands in the order of the table."""
        return list(self.summaries)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        """Import the command and give it, or None if there is none of that name."""
        if cmd_name not in self.summaries:
            return None
        command: click.Command = getattr(import_module(f"{self.package}.{cmd_name}"), cmd_name)
        return command

    def resolve_command(self, ctx: click.Context, args: list[str]) -> Any:
        """Find the command named first in ``args``; the error for an unknown one lists those there are."""
        if args and args[0] not in self.summaries and not args[0].startswith("-"):
            known = ", ".join(self.summaries)
            raise click.UsageError(f"there is no command '{args[0]}'; the commands are {known}", ctx)
        return super().resolve_command(ctx, args)

    def parse_args(self, ctx: click.Context, args: list[str]) -> list[str]:
        """Read the arguments, and keep them as they were typed for reports that show the command."""
        ctx.meta[COMMAND] = shlex.join(["geomdrap", *args])
        return super().parse_args(ctx, args)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the table of commands."""
        with formatter.section("Commands"):
            formatter.write_dl(list(self.summaries.items()))

    def invoke(self, ctx: click.Context) -> Any:
        """Run the command; a reader of its output that has seen enough is no error."""
        try:
            return super().invoke(ctx)
        except BrokenPipeError:
            hang_up()
            return 0

    def main(self, *args: Any, **more: Any) -> Any:
        """Run, and leave with the exit code: 0, 1, 2 (one line of error), 3 (a bug) or 130 (interrupted)."""
        more["standalone_mode"] = False
        try:
            code = super().main(*args, **more)
        except (Exception, KeyboardInterrupt) as error:
            code = exit_code_of(error)
        raise SystemExit(code if isinstance(code, int) else 0)
