"""Places three panels of given proportions on a page so that they come out as large as possible."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

SPLITS = [k / 16 for k in range(3, 14)]
"""Where a box may be cut in two, as a share of its side."""


@dataclass(frozen=True)
class Box:
    """A rectangle on the page: left, bottom, width, height."""

    left: float
    bottom: float
    width: float
    height: float

    def inset(self, left: float, bottom: float, right: float, top: float) -> Box:
        """The rectangle that is left when margins are taken off, never under a tenth of its size."""
        width = max(self.width - left - right, 0.1 * self.width)
        height = max(self.height - bottom - top, 0.1 * self.height)
        return Box(self.left + left, self.bottom + bottom, width, height)

    def raised(self, by: float) -> Box:
        """The same rectangle higher on the page."""
        return Box(self.left, self.bottom + by, self.width, self.height)

    def beside(self, share: float) -> tuple[Box, Box]:
        """Cut upright: the left part with that share of the width, and the rest."""
        width = share * self.width
        return (
            Box(self.left, self.bottom, width, self.height),
            Box(self.left + width, self.bottom, self.width - width, self.height),
        )

    def stacked(self, share: float) -> tuple[Box, Box]:
        """Cut across: the upper part with that share of the height, and the rest."""
        height = share * self.height
        return (
            Box(self.left, self.bottom + self.height - height, self.width, height),
            Box(self.left, self.bottom, self.width, self.height - height),
        )


@dataclass(frozen=True)
class Panel:
    """Width : height of a picture, its margins (left, bottom, right, top), the least width of its words."""

    aspect: float
    margins: tuple[float, float, float, float]
    least_width: float = 0.0

    def inside(self, box: Box) -> Box:
        """Room for the picture itself."""
        return box.inset(*self.margins)

    def size(self, box: Box) -> float:
        """Root of the area of the picture in the box; next to nothing where its words do not fit."""
        room = self.inside(box)
        width = min(room.width, room.height * self.aspect)
        return float(width / math.sqrt(self.aspect)) * (1.0 if box.width >= self.least_width else 1e-3)


def arrangements(box: Box) -> Iterator[tuple[Box, Box, Box]]:
    """All ways to place three panels: row, column, two above one, two beside one."""
    for outer in SPLITS:
        for inner in SPLITS:
            left, right = box.beside(outer)
            yield left, *right.beside(inner)
            yield *left.stacked(inner), right
            upper, lower = box.stacked(outer)
            yield upper, *lower.stacked(inner)
            yield *upper.beside(inner), lower


def merit(boxes: Sequence[Box], panels: Sequence[Panel]) -> float:
    """Geometric mean of the sizes of the pictures in their boxes: no picture pays for another."""
    return math.prod(panel.size(box) for panel, box in zip(panels, boxes, strict=True)) ** (1 / len(boxes))


def best_page(width: float, heights: Sequence[float], panels: Sequence[Panel]) -> tuple[float, list[Box]]:
    """The height among `heights`, and three places on it, that show the largest pictures for the paper."""
    pages = []
    for height in heights:
        boxes = max(arrangements(Box(0.0, 0.0, width, height)), key=lambda boxes: merit(boxes, panels))
        pages.append((merit(boxes, panels) / height**0.35, height, list(boxes)))
    _, height, places = max(pages, key=lambda page: page[0])
    return height, places
