"""Changes between two drawings (DXF, SVG): contour by contour in each layer, and the texts."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from itertools import zip_longest
from typing import Any
from xml.etree import ElementTree

import numpy as np

from geomdrap.export.diff import Change, Tolerance

Contour = np.ndarray  # (k, 2) mm, the first point repeated at the end if it is closed
_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_BLOCK = 512  # points whose distances are taken at once: bounds the memory


class Drawing:
    """The contours and texts of a drawing by layer."""

    def __init__(self) -> None:
        self.contours: dict[str, list[Contour]] = {}
        self.texts: dict[str, list[str]] = {}

    def add(self, layer: str, points: Iterable[Iterable[float]], closed: bool = False) -> None:
        """Add a contour of points (k, 2)."""
        contour = np.array([tuple(point)[:2] for point in points], dtype=float).reshape(-1, 2)
        if closed and len(contour):
            contour = np.vstack([contour, contour[:1]])
        self.contours.setdefault(layer, []).append(contour)

    def write(self, layer: str, text: str) -> None:
        """Add a text."""
        self.texts.setdefault(layer, []).append(" ".join(text.split()))


def dxf_changes(old: bytes, new: bytes, tolerance: Tolerance) -> Iterator[Change]:
    """Yield what changed between two DXF files."""
    yield from drawing_changes(_read_dxf(old), _read_dxf(new), tolerance)


def svg_changes(old: bytes, new: bytes, tolerance: Tolerance) -> Iterator[Change]:
    """Yield what changed between two SVG files whose layers are groups and whose paths are straight."""
    yield from drawing_changes(_read_svg(old), _read_svg(new), tolerance)


def drawing_changes(old: Drawing, new: Drawing, tolerance: Tolerance) -> Iterator[Change]:
    """Yield what changed between two drawings, layer by layer: contours come, gone and moved, and texts."""
    for layer in dict.fromkeys((*old.contours, *new.contours)):
        yield from _layer_changes(layer, old.contours.get(layer, []), new.contours.get(layer, []), tolerance)
    for layer in dict.fromkeys((*old.texts, *new.texts)):
        yield from _text_changes(layer, old.texts.get(layer, []), new.texts.get(layer, []), tolerance)


def _layer_changes(
    layer: str, old: list[Contour], new: list[Contour], tolerance: Tolerance
) -> Iterator[Change]:
    if len(old) != len(new):
        yield Change("", f"layer {layer}", f"{len(old)} contours -> {len(new)}")
    moved, worst, worst_at = 0, 0.0, np.zeros(2)
    for before, after in _pairs(old, new):
        distance, at = _distance(before, after)
        if tolerance.exceeded(distance, "mm"):
            moved += 1
            if distance > worst:
                worst, worst_at = distance, at
    if moved:
        what = f"{moved} of {len(old)} contours moved, most at this place"
        yield Change("", f"layer {layer}, x {worst_at[0]:.6g}, y {worst_at[1]:.6g}", what, worst, "mm")


def _text_changes(layer: str, old: list[str], new: list[str], tolerance: Tolerance) -> Iterator[Change]:
    for before, after in zip_longest(old, new):
        if before is None:
            yield Change("", f"layer {layer}", f"text new: {after}")
        elif after is None:
            yield Change("", f"layer {layer}", f"text gone: {before}")
        elif not _same_words(before, after, tolerance):
            yield Change("", f"layer {layer}", f"text: {before} -> {after}")


def _same_words(old: str, new: str, tolerance: Tolerance) -> bool:
    """Tell whether two texts differ at most in numbers, by the tolerance or a rounded last decimal."""
    if re.sub(_NUMBER, "#", old) != re.sub(_NUMBER, "#", new):
        return False
    for before, after in zip(re.findall(_NUMBER, old), re.findall(_NUMBER, new), strict=True):
        decimals = max(len(text.partition(".")[2]) for text in (before, after))
        rounding = 1.01 * 10.0**-decimals if decimals else 0.0
        if abs(float(before) - float(after)) > max(tolerance.mm, tolerance.deg) + rounding:
            return False
    return True


def _pairs(old: list[Contour], new: list[Contour]) -> Iterator[tuple[Contour, Contour]]:
    """Pair contours: in their order if there are as many, else each with the nearest that is left."""
    if len(old) == len(new):
        yield from zip(old, new, strict=True)
        return
    few, left = (old, list(new)) if len(old) < len(new) else (new, list(old))
    for contour in few:
        gaps = [abs(len(c) - len(contour)) + np.linalg.norm(_middle(c) - _middle(contour)) for c in left]
        nearest = left.pop(int(np.argmin(gaps)))
        yield (contour, nearest) if few is old else (nearest, contour)


def _middle(contour: Contour) -> np.ndarray:
    return contour.mean(axis=0) if len(contour) else np.zeros(2)


def _distance(old: Contour, new: Contour) -> tuple[float, np.ndarray]:
    """Give the largest distance between two contours and where it is: point by point, or Hausdorff's."""
    if old.shape == new.shape and len(old):
        gaps = np.linalg.norm(old - new, axis=1)
        if gaps.max() <= 1e-3:  # the same points; a contour that merely starts elsewhere goes on below
            return float(gaps.max()), old[np.argmax(gaps)]
    if not len(old) or not len(new):
        return (0.0 if len(old) == len(new) else np.inf), np.zeros(2)
    old, new, lines = _with_middles(old), _with_middles(new), (old, new)
    there, back = _to_polyline(old, lines[1]), _to_polyline(new, lines[0])
    if there.max() >= back.max():
        return float(there.max()), old[np.argmax(there)]
    return float(back.max()), new[np.argmax(back)]


def _with_middles(contour: Contour) -> np.ndarray:
    """Add the middle of each side: a side that is missing in the other contour may join two points of it."""
    return np.vstack([contour, (contour[:-1] + contour[1:]) / 2])


def _to_polyline(points: np.ndarray, line: Contour) -> np.ndarray:
    """Give the distance of each point (k, 2) to a polyline (m, 2)."""
    start, along = (line[:-1], np.diff(line, axis=0)) if len(line) > 1 else (line, np.zeros_like(line))
    square = np.maximum((along**2).sum(axis=1), 1e-300)
    result = np.empty(len(points))
    for first in range(0, len(points), _BLOCK):
        offset = points[first : first + _BLOCK, None] - start
        share = np.clip((offset * along).sum(axis=2) / square, 0.0, 1.0)
        gaps = np.linalg.norm(offset - share[..., None] * along, axis=2)
        result[first : first + _BLOCK] = gaps.min(axis=1)
    return result


def _read_dxf(data: bytes) -> Drawing:
    import io

    import ezdxf

    try:
        document = ezdxf.read(io.StringIO(data.decode("utf-8").replace("\r\n", "\n")))
    except (ezdxf.DXFError, UnicodeDecodeError) as error:
        raise ValueError(f"not a DXF file ({error})") from error
    drawing = Drawing()
    entity: Any
    for entity in document.modelspace():
        layer, kind = entity.dxf.layer, entity.dxftype()
        if kind == "LWPOLYLINE":
            drawing.add(layer, entity.get_points("xy"), entity.closed)
        elif kind == "POLYLINE":
            drawing.add(layer, (v.dxf.location for v in entity.vertices), entity.is_closed)
        elif kind == "LINE":
            drawing.add(layer, (entity.dxf.start, entity.dxf.end))
        elif kind == "CIRCLE":
            center, radius = entity.dxf.center, entity.dxf.radius
            drawing.add(layer, [(center.x - radius, center.y), (center.x + radius, center.y)])
        elif kind in ("TEXT", "MTEXT"):
            drawing.write(layer, entity.dxf.text if kind == "TEXT" else entity.text)
            drawing.add(f"{layer} (texts)", [entity.dxf.insert])
        elif kind == "HATCH":
            for path in entity.paths:
                if hasattr(path, "vertices"):
                    drawing.add(f"{layer} (hatches)", path.vertices, True)
        else:
            drawing.write(layer, str(sorted(entity.dxfattribs().items(), key=lambda item: item[0])))
    return drawing


def _read_svg(data: bytes) -> Drawing:
    try:
        root = ElementTree.fromstring(data)
    except ElementTree.ParseError as error:
        raise ValueError(f"not an SVG file ({error})") from error
    drawing = Drawing()
    sheet = [number for key in ("viewBox", "width", "height") for number in _numbers(root.get(key, ""))]
    drawing.add("page", zip(sheet[::2], sheet[1::2], strict=False))
    drawing.write("page", f"{root.get('width')} by {root.get('height')}")
    _walk_svg(root, "drawing", drawing)
    return drawing


def _walk_svg(element: ElementTree.Element, layer: str, drawing: Drawing) -> None:
    tag = element.tag.rpartition("}")[2]
    if tag == "g":
        layer = element.get("id") or element.get("class") or layer
    if tag == "path":
        _add_path(drawing, layer, element.get("d", ""))
    elif tag in ("polyline", "polygon"):
        numbers = np.array(_numbers(element.get("points", ""))).reshape(-1, 2)
        drawing.add(layer, numbers, tag == "polygon")
    elif tag == "line":
        x1, y1, x2, y2 = (float(element.get(key, "0")) for key in ("x1", "y1", "x2", "y2"))
        drawing.add(layer, [(x1, y1), (x2, y2)])
    elif tag in ("text", "title", "desc"):
        drawing.write(layer, "".join(element.itertext()))
        if tag == "text":
            drawing.add(f"{layer} (texts)", [[float(element.get(key, "0")) for key in ("x", "y")]])
        return
    for child in element:
        _walk_svg(child, layer, drawing)


def _add_path(drawing: Drawing, layer: str, d: str) -> None:
    """Add the contours of a path of straight lines; one with curves is kept as text."""
    if re.search("[^MLHVZmz0-9eE+., \t\r\n-]", d):
        drawing.write(layer, d)
        return
    points: list[list[float]] = []
    for command, values in re.findall("([MLHVZmz])([^MLHVZmz]*)", d):
        numbers = _numbers(values)
        if command in "Mm":
            if points:
                drawing.add(layer, points)
            points = []
        if command in "Zz":
            drawing.add(layer, points, True)
            points = []
        elif command in "HV":
            for number in numbers:
                points.append([number, points[-1][1]] if command == "H" else [points[-1][0], number])
        else:
            points.extend([x, y] for x, y in zip(numbers[::2], numbers[1::2], strict=True))
    if points:
        drawing.add(layer, points)


def _numbers(text: str) -> list[float]:
    return [float(number) for number in re.findall(_NUMBER, text)]
