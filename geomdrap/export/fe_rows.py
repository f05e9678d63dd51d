"""Many rows of numbers as text, quickly."""

from __future__ import annotations

import re
from collections.abc import Iterator
from typing import Any

import numpy as np

FIELD = re.compile(r"%\d*(?:\.(\d+)f|d)")
"""Of a pattern: a whole number, or a number with its decimals."""


def rows(pattern: str, *columns: Any) -> Iterator[str]:
    """One line of text, by a pattern of %d and %.nf, for each entry of columns (k,); no zero has a minus."""
    fields = FIELD.findall(pattern)
    lists = [rounded(column, places).tolist() for column, places in zip(columns, fields, strict=True)]
    for row in zip(*lists, strict=True):
        yield pattern % row


def rounded(values: Any, places: str) -> np.ndarray:
    """Numbers to a field's decimals (none: as they are), without the negative zeros that rounding makes."""
    return np.asarray(values) if not places else np.asarray(np.round(np.asarray(values, float), int(places)) + 0.0)
