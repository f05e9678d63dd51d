"""Sentences folded to the width of a terminal."""

from __future__ import annotations

import textwrap

WIDTH = 100


def wrapped(sentence: str) -> list[str]:
    """Lines of at most ``WIDTH`` characters."""
    return textwrap.wrap(sentence, WIDTH, break_long_words=False, break_on_hyphens=False)
