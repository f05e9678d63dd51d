"""Many rows of numbers as text, quickly."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np


def rows(pattern: str, *columns: Any) -> Iterator[str]:
    """One line of text, by a %-pattern, for each entry of columns (k,); minus zero is written as zero."""
    plain = [np.asarray(c) + 0 if np.asarray(c).dtype.kind != "f" else cleaned(c) for c in columns]
    lists = [column.tolist() for column in plain]
    for row in zip(*lists, strict=True):
        yield pattern % row


def cleaned(values: Any) -> np.ndarray:
    """Numbers to nine decimals without negative zeros."""
    return np.asarray(np.round(np.asarray(values, float), 9) + 0.0)
