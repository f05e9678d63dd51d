"""A number that an effect takes: what it is called, in which unit, and within which bounds."""

from __future__ import annotations

import math
from dataclasses import dataclass

from geomdrap.errors import EffectError


@dataclass(frozen=True)
class Parameter:
    """A parameter of an effect.

    ``low`` and ``high`` are the bounds, themselves allowed, ``typical`` is a usual size and ``neutral`` the value
    at which the effect is not there, all in ``unit``; ``text`` says what it is.
    """

    name: str
    unit: str
    low: float
    high: float
    typical: float
    neutral: float
    text: str

    def checked(self, value: object, effect: str) -> float:
        """The value as a float. Raises EffectError where it is no finite number within the bounds."""
        try:
            number = float(value)  # type: ignore[arg-type]
        except (TypeError, ValueError):
            number = math.nan
        if not self.low <= number <= self.high:
            raise EffectError(
                f"effect {effect}: {self.name} must be a number from {self.low:g} to {self.high:g}"
                f"{f' {self.unit}' if self.unit else ''}, not {value!r}"
            )
        return number
