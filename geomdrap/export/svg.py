"""flat.svg: the flat pattern in true scale, a group for each layer.

Width and height are in mm and the view box counts mm, so that one unit is one millimetre. SVG's y runs
down: v is written with its sign turned, and the pattern is not mirrored.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING
from xml.sax.saxutils import escape

from geomdrap.export.drawing import DECIMALS, Drawing, Layer, Polyline, Text, flat_drawing
from geomdrap.export.whole import write_whole

if TYPE_CHECKING:
    from geomdrap.fields import Drape

MARGIN = 0.02
"""White around the drawing, as a share of its longer side: no line is cut by the edge of the sheet."""

FILLED = {"LOCKED_ZONES": 0.25}
"""Layers whose polygons are filled, with the opacity."""


def write(result: Drape, path: Path) -> None:
    """Write the flat pattern as SVG 1.1; the same bytes for the same drape. Raises GeomdrapError."""
    write_whole(path, svg_text(flat_drawing(result)))


def svg_text(drawing: Drawing) -> str:
    """The drawing as the text of an SVG file."""
    margin = round(MARGIN * float(max(drawing.upper - drawing.lower)), DECIMALS)
    width, height = drawing.upper - drawing.lower + 2 * margin
    size = f'width="{number(width)}mm" height="{number(height)}mm"'
    box = " ".join(number(x) for x in (drawing.lower[0] - margin, -drawing.upper[1] - margin, width, height))
    stroke = max(width, height) / 2000.0
    head = (
        f'<svg xmlns="http://www.w3.org/2000/svg" version="1.1" {size} viewBox="{box}" fill="none" '
        f'stroke-width="{number(stroke)}" stroke-linejoin="round" font-family="sans-serif">'
    )
    body = [line for layer in drawing.layers for line in group(layer, stroke)]
    return "\n".join(['<?xml version="1.0" encoding="UTF-8"?>', head, *body, "</svg>", ""])


def group(layer: Layer, stroke: float) -> list[str]:
    """Lines of text of a layer's group; contours and rosette are twice as thick as the rest."""
    name = layer.name.lower().replace("_", "-")
    colour = f"#{layer.colour:06x}"
    style = f' fill="{colour}" fill-opacity="{FILLED[layer.name]}"' if layer.name in FILLED else ""
    if "CONTOUR" in layer.name or layer.name == "ROSETTE":
        style += f' stroke-width="{number(2 * stroke)}"'
    lines = [f'<g id="{name}" stroke="{colour}"{style}>']
    lines += [path_element(line) for line in layer.polylines]
    lines += [text_element(text, colour) for text in layer.texts]
    return [*lines, "</g>"]


def path_element(line: Polyline) -> str:
    """A polyline as one path."""
    points = " ".join(f"{number(x)},{number(-y)}" for x, y in line.points)
    return f'<path d="M {points}{" Z" if line.closed else ""}"/>'


def text_element(text: Text, colour: str) -> str:
    """A line of text; its capitals are 0.72 of the size of the font."""
    x, y = number(text.at[0]), number(-text.at[1])
    size = number(text.height / 0.72)
    return (
        f'<text x="{x}" y="{y}" font-size="{size}" fill="{colour}" stroke="none">{escape(text.words)}</text>'
    )


def number(value: float) -> str:
    """At most six decimals, no trailing zeros, no negative zero, no exponent."""
    short = f"{value:.{DECIMALS}f}".rstrip("0").rstrip(".")
    return "0" if short == "-0" else short
