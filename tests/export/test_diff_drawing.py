"""Changes between drawings, contour by contour."""

from __future__ import annotations

import numpy as np
import pytest

from geomdrap.export.diff import Change, Tolerance
from geomdrap.export.diff_drawing import Drawing, drawing_changes, dxf_changes, svg_changes

SQUARE = [[0.0, 0.0], [10.0, 0.0], [10.0, 10.0], [0.0, 10.0]]


def _drawing(*contours: list[list[float]], layer: str = "OUTER", closed: bool = True) -> Drawing:
    drawing = Drawing()
    for contour in contours:
        drawing.add(layer, contour, closed)
    return drawing


def _changes(old: Drawing, new: Drawing, mm: float = 1e-6) -> list[Change]:
    return list(drawing_changes(old, new, Tolerance(mm=mm)))


def test_a_moved_corner_is_found_with_layer_place_and_distance() -> None:
    moved = [*SQUARE[:2], [10.3, 10.4], SQUARE[3]]
    (change,) = _changes(_drawing(SQUARE), _drawing(moved))
    assert change.where == "layer OUTER, x 10.3, y 10.4"
    assert (change.amount, change.unit) == (pytest.approx(0.5), "mm")
    assert not _changes(_drawing(SQUARE), _drawing(moved), mm=0.6)


def test_a_contour_that_starts_at_another_point_is_the_same() -> None:
    assert not _changes(_drawing(SQUARE), _drawing(SQUARE[2:] + SQUARE[:2]))


def test_points_added_on_the_line_change_nothing() -> None:
    assert not _changes(_drawing(SQUARE), _drawing([SQUARE[0], [5.0, 0.0], *SQUARE[1:]]))


def test_a_contour_that_is_open_now_is_a_change() -> None:
    (change,) = _changes(_drawing(SQUARE), _drawing(SQUARE, closed=False))
    assert change.amount == pytest.approx(5.0)  # half of the missing side


def test_a_missing_contour_is_counted_and_the_others_are_matched_by_place() -> None:
    other = (np.array(SQUARE) + 100).tolist()
    (change,) = _changes(_drawing(SQUARE, other), _drawing(other))
    assert change.what == "2 contours -> 1"


def test_a_layer_that_appears_is_a_change() -> None:
    new = _drawing(SQUARE)
    new.add("INNER", SQUARE, True)
    (change,) = _changes(_drawing(SQUARE), new)
    assert (change.where, change.what) == ("layer INNER", "0 contours -> 1")


def test_changed_texts_are_shown_old_and_new() -> None:
    old, new = Drawing(), Drawing()
    old.write("NOTES", "pitch 5 mm")
    new.write("NOTES", "pitch 4 mm")
    assert [c.what for c in _changes(old, new)] == ["text: pitch 5 mm -> pitch 4 mm"]


@pytest.mark.parametrize(
    ("old", "new", "same"),
    [
        ("part 1600.0 mm2", "part 1600.1 mm2", True),  # a rounded decimal may tip over
        ("part 1600.0 mm2", "part 1600.2 mm2", False),
        ("warp at 45 deg", "warp at 46 deg", False),
        ("warp at 45 deg", "weft at 45 deg", False),
        ("coverage 99.49 %: INCOMPLETE", "coverage 99.50 %", False),
    ],
)
def test_texts_may_differ_by_the_rounding_of_their_decimals(old: str, new: str, same: bool) -> None:
    drawings = Drawing(), Drawing()
    for drawing, text in zip(drawings, (old, new), strict=True):
        drawing.write("NOTES", text)
    assert (not _changes(*drawings)) is same


SVG = """<svg xmlns="http://www.w3.org/2000/svg" width="20mm" height="20mm" viewBox="0 0 20 20">
<g id="outer"><path d="M 0,0 L 10,0 10,{y} 0,10 Z M1 1H2V2Z"/></g>
<g id="warp"><line x1="0" y1="{y}" x2="5" y2="5"/><polyline points="0,0 1,1"/></g>
<g id="curve"><path d="M0 0 C 1 1 2 2 {y} 3"/></g><g id="notes"><text>y {y}</text></g></svg>"""


def test_svg_files_are_compared_by_groups() -> None:
    assert not list(svg_changes(SVG.format(y=10).encode(), SVG.format(y=10).encode(), Tolerance()))
    found = list(svg_changes(SVG.format(y=10).encode(), SVG.format(y=10.5).encode(), Tolerance()))
    assert [c.where.split(",")[0] for c in found] == [
        "layer outer",
        "layer warp",
        "layer curve",
        "layer notes",
    ]
    assert [c.amount for c in found[:2]] == [pytest.approx(0.5)] * 2


def _dxf(y: float) -> bytes:
    import io

    import ezdxf

    document = ezdxf.new()
    space = document.modelspace()
    space.add_lwpolyline([*SQUARE[:2], [10.0, y], SQUARE[3]], close=True, dxfattribs={"layer": "OUTER"})
    space.add_polyline2d([*SQUARE[:2], [10.0, y]], dxfattribs={"layer": "INNER"})
    space.add_line((0, 0), (0, y), dxfattribs={"layer": "WARP"})
    space.add_circle((0, y), 1, dxfattribs={"layer": "ROSETTE"})
    space.add_text(f"y {y}", dxfattribs={"layer": "NOTES"})
    stream = io.StringIO()
    document.write(stream)
    return stream.getvalue().encode()


def test_dxf_files_are_compared_by_layers() -> None:
    assert not list(dxf_changes(_dxf(10.0), _dxf(10.0), Tolerance()))
    found = {c.where.split(",")[0]: c.amount for c in dxf_changes(_dxf(10.0), _dxf(10.25), Tolerance())}
    assert {k: found[f"layer {k}"] for k in ("OUTER", "INNER", "WARP", "ROSETTE")} == {
        "OUTER": pytest.approx(0.25),
        "INNER": pytest.approx(0.25),
        "WARP": pytest.approx(0.25),
        "ROSETTE": pytest.approx(0.25),
    }
    assert found["layer NOTES"] is None
