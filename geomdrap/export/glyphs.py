"""Names as matplotlib can write them: its font lacks most of the world's scripts."""

from __future__ import annotations

from functools import cache
from typing import Any

MISSING = "□"


def drawable(text: str) -> str:
    """The text with a box for each character that the font has no glyph for, and $ as itself, not as mathematics."""
    known = _characters()
    return "".join(c if ord(c) in known else MISSING for c in text).replace("$", r"\$")


@cache
def _characters() -> frozenset[int]:
    """Code points that the font of the pictures has."""
    from matplotlib import rcParams
    from matplotlib.font_manager import FontProperties, findfont, get_font

    font: Any = get_font(findfont(FontProperties(family=rcParams["font.family"], weight="bold")))
    return frozenset(font.get_charmap())
