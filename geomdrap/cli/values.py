"""Types of option values: each says in one sentence what is wrong with a value it refuses."""

from __future__ import annotations

import math
import re
from typing import Any

import click

Vector = tuple[float, float, float]


class Number(click.ParamType):
    """A finite number, optionally within bounds: ``above`` and ``below`` excluded, ``least`` itself allowed."""

    def __init__(
        self,
        name: str,
        above: float = -math.inf,
        below: float = math.inf,
        least: float = -math.inf,
    ):
        self.name = name
        self.above, self.below = above, below
        self.least = least

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> float:
        """Give the number, or fail with a sentence."""
        number = _number(value)
        if number is None:
            self.fail(f"'{value}' is not a number", param, ctx)
        if not (self.above < number < self.below and self.least <= number):
            self.fail(f"{value} is not {self._range()}", param, ctx)
        return number

    def _range(self) -> str:
        if math.isfinite(self.above) and math.isfinite(self.below):
            return f"between {self.above:g} and {self.below:g}, both excluded"
        if math.isfinite(self.least):
            return f"a finite number of at least {self.least:g}"
        return "a finite number" if math.isinf(self.above) else f"a finite number above {self.above:g}"


class NamedPath(click.Path):
    """A file or folder by its name, which must not be empty: that would be the folder one stands in."""

    def __init__(self) -> None:
        from pathlib import Path

        super().__init__(path_type=Path)

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Any:
        """Give the path, or fail with a sentence."""
        if value == "":
            self.fail("the name is empty", param, ctx)
        return super().convert(value, param, ctx)


class Triple(click.ParamType):
    """A vector or point: three finite numbers with commas between."""

    name = "x,y,z"

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Vector:
        """Give three floats, or fail with a sentence."""
        if isinstance(value, tuple):
            return value
        numbers = [_number(part) for part in str(value).split(",")]
        if len(numbers) != 3 or any(number is None or not math.isfinite(number) for number in numbers):
            self.fail(f"'{value}' is not three finite numbers with commas, as in 10,-5,84.4", param, ctx)
        x, y, z = (float(number) for number in numbers if number is not None)
        return x, y, z


class Direction(Triple):
    """A direction: a vector that is not zero."""

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> Vector:
        """Give three floats that are not all zero, or fail with a sentence."""
        vector = super().convert(value, param, ctx)
        if not any(vector):
            self.fail("0,0,0 has no direction", param, ctx)
        return vector


class Origin(click.ParamType):
    """The seed: ``centroid``, a point ``x,y,z`` or ``vertex:N``."""

    name = "centroid|x,y,z|vertex:N"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> str | int | Vector:
        """Give ``"centroid"``, a vertex number or three floats, or fail with a sentence."""
        if not isinstance(value, str) or value == "centroid":
            return value
        vertex = re.fullmatch(r"vertex:(\d{1,18})", value)
        if vertex:
            return int(vertex[1])
        if value.startswith("vertex:"):
            self.fail(f"'{value}' is not a vertex; write vertex:N with N a whole number from 0", param, ctx)
        if "," not in value:
            self.fail(f"'{value}' is not centroid, a point x,y,z or vertex:N", param, ctx)
        return Triple().convert(value, param, ctx)


class Pair(click.ParamType):
    """One number, or two with a comma between: along warp and weft."""

    def __init__(self, name: str, above: float = -math.inf):
        self.name = name
        self.number = Number(name, above=above)

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[float, float]:
        """Give two floats, or fail with a sentence."""
        if isinstance(value, tuple):
            return value
        parts = str(value).split(",")
        if len(parts) not in (1, 2):
            self.fail(f"'{value}' is not one number, or two with a comma, as in 16,16", param, ctx)
        numbers = [self.number.convert(part.strip(), param, ctx) for part in parts]
        return numbers[0], numbers[-1]


class Mapping(click.ParamType):
    """Names of columns: ``x=X,shear=Gamma``."""

    name = "quantity=heading,..."

    def convert(self, value: Any, param: click.Parameter | None, ctx: click.Context | None) -> dict[str, str]:
        """Give the headings by quantity, or fail with a sentence."""
        if isinstance(value, dict):
            return value
        out: dict[str, str] = {}
        for part in str(value).split(","):
            quantity, sign, heading = (text.strip() for text in part.partition("="))
            if not (quantity and sign and heading):
                self.fail(f"'{part}' is not quantity=heading, as in x=X,shear=Gamma", param, ctx)
            if quantity in out:
                self.fail(f"'{quantity}' is named twice", param, ctx)
            out[quantity] = heading
        return out


class Numbers(click.ParamType):
    """One finite number or more, with commas between."""

    name = "x,x,..."

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[float, ...]:
        """Give the numbers, or fail with a sentence."""
        if isinstance(value, tuple):
            return value
        numbers = [_number(part) for part in str(value).split(",")]
        found = tuple(n for n in numbers if n is not None and math.isfinite(n))
        if len(found) < len(numbers):
            self.fail(f"'{value}' is not a finite number, or several with commas, as in 10,30,45", param, ctx)
        return found


class Pairs(click.ParamType):
    """Pairs of numbers: ``0.1=0.2,10=0.3``."""

    name = "x=y,..."

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[tuple[float, float], ...]:
        """Give the pairs, or fail with a sentence."""
        if isinstance(value, tuple):
            return value
        pairs = [[_number(side) for side in part.split("=")] for part in str(value).split(",")]
        found = tuple((p[0], p[1]) for p in pairs if len(p) == 2 and p[0] is not None and p[1] is not None)
        if len(found) < len(pairs):
            self.fail(f"'{value}' is not pairs of numbers, as in 0.1=0.2,10=0.3", param, ctx)
        return found


class Size(click.ParamType):
    """The blank: width times height, as in ``400x300``."""

    name = "WxH"

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[float, float]:
        """Give width and height, or fail with a sentence."""
        if isinstance(value, tuple):
            return value
        numbers = [_number(part) for part in re.split("[xX×]", str(value))]
        if len(numbers) != 2 or any(n is None or not 0 < n < math.inf for n in numbers):
            self.fail(f"'{value}' is not a width and a height above 0, as in 400x300", param, ctx)
        width, height = (float(number) for number in numbers if number is not None)
        return width, height


class Names(click.ParamType):
    """A list of names with commas between, each of them known.

    ``none`` stands for the empty list, for no ``what``; where that is empty it is not offered.
    """

    def __init__(self, known: tuple[str, ...], what: str = "files"):
        self.known, self.what = known, what
        self.name = "name,name,..."

    def convert(
        self, value: Any, param: click.Parameter | None, ctx: click.Context | None
    ) -> tuple[str, ...]:
        """Give the names in the order of the known ones, or fail and list those."""
        if isinstance(value, tuple):
            return value
        asked = {part.strip().lower() for part in str(value).split(",")}
        if asked == {"none"}:
            return ()
        if "none" in asked:
            self.fail(f"'{value}' asks for none and for others; leave out one or the other", param, ctx)
        for name in sorted(asked.difference(self.known)):
            or_none = f" (or none, for no {self.what})" if self.what else ""
            self.fail(f"'{name}' is not one of {', '.join(self.known)}{or_none}", param, ctx)
        return tuple(name for name in self.known if name in asked)


def _number(text: Any) -> float | None:
    """Read a float as people write it; Python's own reader also takes ``1_000``, which is a typing error."""
    if isinstance(text, str) and "_" in text:
        return None
    try:
        return float(text)
    except (TypeError, ValueError):
        return None
