"""Headings as they are written: ``0:90:5``, ``0,45,90``, or several of both."""

from __future__ import annotations

import math

from geomdrap.errors import SweepError

MOST = 100_000
ROUNDING = 1e-9  # steps by which the end of a range may be missed


def parse_angles(text: str) -> tuple[float, ...]:
    """Headings, degrees: numbers and ranges ``START:STOP:STEP``, both ends included, with commas between.

    Each comes once, in the order in which it is written first.
    Raises SweepError for what is no number, and for ranges that are empty or endless.
    """
    angles = [angle for part in text.split(",") for angle in _part(part.strip(), text)]
    return tuple(dict.fromkeys(angles))


def _part(part: str, whole: str) -> list[float]:
    numbers = [_number(piece, whole) for piece in part.split(":")]
    if len(numbers) == 1:
        return numbers
    if len(numbers) != 3:
        raise SweepError(f"angles {whole!r}: {part!r} is not START:STOP:STEP, as in 0:90:5")
    start, stop, step = numbers
    if step == 0.0 or (stop - start) / step < -ROUNDING:
        raise SweepError(
            f"angles {whole!r}: the range {part} is empty; its step must lead from {start:g} to {stop:g}"
        )
    steps = (stop - start) / step
    if steps > MOST:
        raise SweepError(f"angles {whole!r}: the range {part} has {steps:.3g} angles; use a larger step")
    return [start + k * step for k in range(math.floor(steps + ROUNDING) + 1)]


def _number(text: str, whole: str) -> float:
    try:
        number = math.nan if "_" in text else float(text)
    except ValueError:
        number = math.nan
    if not math.isfinite(number):
        raise SweepError(f"angles {whole!r}: {text!r} is not a finite number of degrees; write them as in 0:90:5")
    return number + 0.0
