"""The option --also of ``geomdrap coupon fit``: a further test of the same cloth, with its settings."""

from __future__ import annotations

from pathlib import Path
from typing import Any, NamedTuple

import click

from geomdrap.cli.values import Number

TESTS = ("uniaxial", "bias-extension", "picture-frame", "biaxial")  # as in geomdrap.forming; tests compare
SETTINGS = {
    "uniaxial": ("angle", "speed", "length", "width", "steps", "cells"),
    "bias-extension": ("speed", "length", "width", "steps", "cells"),
    "picture-frame": ("side", "speed"),
    "biaxial": ("ratio", "speed", "steps", "cells"),
}
WHOLE = ("cells", "steps")


class Further(NamedTuple):
    """A test, the file with its readings, and its settings."""

    test: str
    path: Path
    settings: dict[str, Any]


class FurtherTest(click.ParamType):
    """``uniaxial:0.csv:angle=0,speed=40``; settings that are not named are the usual ones of the test."""

    name = "TEST:FILE:SETTING=X,..."

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Further:
        """Give test, file and settings, or fail with a sentence."""
        if isinstance(value, Further):
            return value
        test, _, rest = str(value).partition(":")
        if test not in TESTS:
            listed = ", ".join(TESTS)
            self.fail(f"'{value}' must begin with a test, {listed}, as in uniaxial:0.csv:angle=0", param, ctx)
        path, colon, last = rest.rpartition(":")
        path, asked = (path, last.split(",")) if colon and "=" in last else (rest, [])
        if not path:
            self.fail(f"'{value}' names no file, as in {test}:FILE.csv", param, ctx)
        return Further(test, Path(path), dict(self._setting(one, test, param, ctx) for one in asked))

    def _setting(
        self, text: str, test: str, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, Any]:
        name, _, value = (part.strip() for part in text.partition("="))
        if name not in SETTINGS[test]:
            self.fail(
                f"'{name}' is not a setting of a {test} test; choose from {', '.join(SETTINGS[test])}", param, ctx
            )
        number = Number("X").convert(value, param, ctx)
        if name not in WHOLE:
            return name, number
        if number < 1 or number != int(number):
            self.fail(f"{name} is a whole number of 1 or more; got {value}", param, ctx)
        return name, int(number)
