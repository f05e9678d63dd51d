"""Strips of a roll and their seams in the result files."""

from __future__ import annotations

import json
from dataclasses import replace
from itertools import pairwise

import ezdxf
import numpy as np
import pytest

import geomdrap as gd
from geomdrap.export import cut_dxf, cut_pdf, dxf, picture, report_html, report_json, svg
from geomdrap.export.cut_pieces import APART_STRIPS, cut_pieces
from geomdrap.export.drawing import flat_drawing, overlap_edges
from geomdrap.fields.contour import is_simple, signed_area
from geomdrap.fields.roll import lay_on_roll
from geomdrap.fields.strips import RollStrip
from geomdrap.surface import shapes

OVERLAP = 20.0


@pytest.fixture(scope="module")
def bare_result():
    """A plane 300 × 250 mm, warp along its length: the pattern is the plane itself."""
    return gd.evaluate(gd.drape(shapes.plane(300.0, 250.0, 25.0), (0, 0, 0), 0.0, 10.0, project=True))


@pytest.fixture(scope="module")
def result(bare_result):
    """The same from three strips of a roll 120 mm wide, which overlap."""
    return replace(bare_result, roll=lay_on_roll(bare_result, 120.0, OVERLAP))


def seam_levels(result):
    return [seam.v for seam in result.roll.seams]


def test_drape_json_has_strips_and_seams_where_a_roll_was_given_and_nothing_else_changes(bare_result, result):
    document = report_json.as_dict(result)
    roll = document.pop("roll")
    assert document == report_json.as_dict(bare_result)
    assert list(document) == list(report_json.as_dict(bare_result))
    json.dumps(roll, allow_nan=False)
    assert (roll["width"], roll["overlap"], len(roll["strips"]), len(roll["seams"])) == (120.0, OVERLAP, 3, 2)
    assert roll["length"] == pytest.approx(900.0)
    assert roll["waste"] == pytest.approx(1.0 - (75000.0 + 2 * 300.0 * OVERLAP) / (900.0 * 120.0), abs=1e-6)
    for seam in roll["seams"]:
        assert seam["length"] == pytest.approx(300.0)
        assert seam["pieces"] == [pytest.approx([-150.0, 150.0])]
        (line,) = seam["on_part"]
        np.testing.assert_allclose(np.array(line)[:, 1:], [[seam["v"], 0.0]] * len(line), atol=1e-6)


def test_flat_files_have_a_layer_of_seams_and_one_of_the_edges_of_overlapping_strips(bare_result, result, tmp_path):
    dxf.write(result, tmp_path / "flat.dxf")
    space = ezdxf.readfile(tmp_path / "flat.dxf").modelspace()
    for layer, levels in (
        ("SEAMS", seam_levels(result)),
        ("STRIP_EDGES", [v + d for v in seam_levels(result) for d in (-0.5 * OVERLAP, 0.5 * OVERLAP)]),
    ):
        lines = [np.array(line.get_points("xy")) for line in space.query(f'LWPOLYLINE[layer=="{layer}"]')]
        assert [line[0, 1] for line in lines] == pytest.approx(levels, abs=1e-5)
        assert all(np.ptp(line[:, 0]) == pytest.approx(300.0) for line in lines)
    assert '<g id="seams"' in svg.svg_text(flat_drawing(result))
    assert "seam" not in svg.svg_text(flat_drawing(bare_result))
    assert {layer.name for layer in flat_drawing(bare_result).layers}.isdisjoint({"SEAMS", "STRIP_EDGES"})


def test_edges_of_overlaps_are_drawn_only_as_far_as_the_strips_reach():
    lower = RollStrip((0.0, 55.0), (0.0, 100.0), (np.array([[0, 0], [100, 0], [100, 48], [50, 48], [50, 55], [0, 55.0]]),))
    upper = RollStrip((45.0, 90.0), (0.0, 50.0), (np.array([[0, 45], [50, 45], [50, 90], [0, 90.0]]),))
    np.testing.assert_allclose(list(overlap_edges(lower, upper)), [[[0, 45], [50, 45]], [[0, 55], [50, 55]]], atol=2e-6)


def test_each_strip_is_a_piece_of_its_own_that_lies_apart_from_the_next(result):
    pieces = cut_pieces(result)
    assert [piece.name for piece in pieces] == ["PLANE-STRIP1", "PLANE-STRIP2", "PLANE-STRIP3"]
    for piece, strip in zip(pieces, result.roll.strips, strict=True):
        assert signed_area(piece.outer) == pytest.approx(strip.area, rel=1e-12)
        assert piece.grain[0, 1] == piece.grain[1, 1]
        assert piece.outer[:, 1].min() < piece.grain[0, 1] < piece.outer[:, 1].max()
    assert is_simple([piece.outer for piece in pieces])
    for lower, upper in pairwise(pieces):
        assert upper.outer[:, 1].min() - lower.outer[:, 1].max() == pytest.approx(APART_STRIPS)
    assert [len(piece.seams) for piece in pieces] == [1, 2, 1]
    assert [bool(np.isfinite(piece.seed).all()) for piece in pieces] == [False, True, False]


def test_strips_that_only_touch_sum_to_the_pattern_and_the_weft_is_notched_at_their_seams(bare_result):
    touching = replace(bare_result, roll=lay_on_roll(bare_result, 100.0))
    pieces = cut_pieces(touching)
    assert sum(signed_area(piece.outer) for piece in pieces) == pytest.approx(75000.0, rel=1e-9)
    for piece in pieces:
        wefts = [notch for notch in piece.notches if notch.mark.startswith("WEFT")]
        assert [notch.at[0] for notch in wefts] == pytest.approx([0.0, 0.0], abs=1e-9)
        assert [notch.at[1] for notch in wefts] == pytest.approx([piece.outer[:, 1].min(), piece.outer[:, 1].max()])


def test_a_roll_that_is_wide_enough_leaves_the_files_for_cutting_as_they_are(bare_result):
    whole = replace(bare_result, roll=lay_on_roll(bare_result, 300.0))
    (piece,) = cut_pieces(whole)
    assert piece.name == "PLANE"
    np.testing.assert_array_equal(piece.outer, cut_pieces(bare_result)[0].outer)


def test_cut_dxf_has_a_block_for_each_strip_with_its_words_within(result, tmp_path):
    cut_dxf.write(result, tmp_path / "cut.dxf")
    document = ezdxf.readfile(tmp_path / "cut.dxf")
    for piece in cut_pieces(result):
        block = document.blocks.get(piece.name)
        words = list(block.query("TEXT"))
        assert f"Piece Name: {piece.name}" in [text.dxf.text for text in words]
        assert "roll 120 mm wide: 3 strips, overlap 20 mm" in [text.dxf.text for text in words]
        for text in words:
            assert piece.outer[:, 1].min() < text.dxf.insert.y < piece.outer[:, 1].max() - text.dxf.height
    styles = [text.dxf.text for text in document.modelspace().query("TEXT")]
    assert "Style Name: PLANE" in styles


def test_pages_pictures_and_the_report_are_written_with_seams(bare_result, result, tmp_path):
    cut_pdf.write(result, tmp_path / "cut.pdf")
    assert (tmp_path / "cut.pdf").read_bytes().startswith(b"%PDF")
    plain, seamed = (picture.draw(drape) for drape in (bare_result, result))
    words = [text.get_text() for text in seamed.findobj(lambda a: hasattr(a, "get_text"))]
    assert any(text.endswith("; green: seams") for text in words)
    assert any(text.startswith("Flat pattern") and text.endswith(", 3 strips") for text in words)
    assert green(seamed) > 1000
    assert green(plain) == 0
    report_html.write(result, tmp_path / "report.html", "")
    page = (tmp_path / "report.html").read_text(encoding="utf-8")
    assert "<h2>Roll</h2>" in page
    assert f'"seams": [{seam_levels(result)[0]:.6f}'.rstrip("0") in page
    report_html.write(bare_result, tmp_path / "bare.html", "")
    assert "<h2>Roll</h2>" not in (tmp_path / "bare.html").read_text(encoding="utf-8")


def green(figure):
    """Number of pixels in the colour of seams."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg

    canvas = FigureCanvasAgg(figure)
    canvas.draw()
    pixels = np.asarray(canvas.buffer_rgba())[..., :3].astype(int)
    return int((np.abs(pixels - [0x13, 0x8A, 0x36]).max(axis=2) < 12).sum())
