"""The pattern for the cutting table: pieces, DXF layers, and pages in true scale."""

from __future__ import annotations

import io
import re
import zlib
from pathlib import Path
from types import SimpleNamespace

import ezdxf
import numpy as np
import pytest

import geomdrap as gd
from geomdrap.errors import GeomdrapError
from geomdrap.export import cut_dxf, cut_pdf
from geomdrap.export.cut_pieces import APART, DEPTH, cut_pieces, further, grain_line, notches, piece_name
from geomdrap.export.cut_tiles import MARGIN, OVERLAP, PAPERS, tiling
from geomdrap.fields.contour import signed_area
from geomdrap.surface import shapes

SQUARE = np.array([[-100.0, -50.0], [300.0, -50.0], [300.0, 150.0], [-100.0, 150.0]])
HOLE = np.array([[50.0, -20.0], [50.0, 20.0], [90.0, 20.0], [90.0, -20.0]])  # clockwise


@pytest.fixture(scope="module")
def result():
    """A plane 300 × 200 mm, warp at 30°: its pattern is the plane itself, turned."""
    return gd.evaluate(gd.drape(shapes.plane(300.0, 200.0, 10.0), (0, 0, 0), 30.0, 10.0, project=True))


def pattern(outer=(SQUARE,), inner=(HOLE,)):
    flat = SimpleNamespace(outer=tuple(outer), inner=tuple(inner), cuts=())
    return SimpleNamespace(flat=flat, roll=None, net=SimpleNamespace(surface=SimpleNamespace(source="bügel 2.stl")))


def test_the_piece_is_the_flat_pattern_with_its_cut_outs(result):
    (piece,) = cut_pieces(result)
    assert piece.name == "PLANE"
    assert signed_area(piece.outer) == pytest.approx(300.0 * 200.0, rel=1e-6)
    (made,) = cut_pieces(pattern())
    assert made.name == "B_GEL_2"
    np.testing.assert_array_equal(made.inner[0], HOLE)


def test_pieces_are_numbered_the_largest_first_each_with_its_own_cut_outs():
    small = np.array([[400.0, 0.0], [450.0, 0.0], [450.0, 40.0], [400.0, 40.0]])
    own = np.array([[410.0, 10.0], [410.0, 30.0], [440.0, 30.0], [440.0, 10.0]])
    first, second = cut_pieces(pattern((small, SQUARE), (own, HOLE)))
    assert (first.name, second.name) == ("B_GEL_2-1", "B_GEL_2-2")
    np.testing.assert_array_equal(first.outer, SQUARE)
    assert [len(first.inner), len(second.inner)] == [1, 1]
    np.testing.assert_array_equal(second.inner[0], own)


def test_the_grain_line_runs_along_the_warp_inside_the_piece_and_clear_of_cut_outs():
    start, end = grain_line((SQUARE, HOLE))
    assert start[1] == end[1]
    assert end[0] - start[0] == pytest.approx(0.6 * 400.0)
    assert not -20.0 < start[1] < 20.0
    assert -50.0 < start[1] < 150.0
    assert 0.5 * (start[0] + end[0]) == pytest.approx(100.0)


def test_notches_lie_where_the_axes_leave_the_piece_and_point_into_it():
    found = notches(SQUARE)
    at = {notch.mark: [] for notch in found}
    for notch in found:
        at[notch.mark].append((tuple(np.round(notch.at, 9)), tuple(notch.inward)))
    assert at["WARP -"] == [((-100.0, 0.0), (1.0, 0.0))]
    assert at["WEFT -"] == [((0.0, -50.0), (0.0, 1.0))]
    assert at["WEFT +"] == [((0.0, 150.0), (0.0, -1.0))]
    assert at["WARP +"] == [((300.0, 0.0), (-1.0, 0.0)), ((300.0, APART), (-1.0, 0.0))], "the double notch"


def test_a_piece_that_the_axes_miss_has_no_notch():
    assert notches(SQUARE + [200.0, 100.0]) == ()


def test_going_along_a_contour_turns_its_corners():
    side, share = further(SQUARE, 1, 0.9, 70.0)  # 20 mm to the corner, 50 mm on
    assert (side, share) == (2, pytest.approx(50.0 / 400.0))
    assert further(SQUARE, 3, 0.5, 1200.0) == (3, pytest.approx(0.5)), "once round"


@pytest.mark.parametrize(("source", "name"), [("a/b/hood.stl", "HOOD"), ("Käfer (2).step", "K_FER__2_"), (".stl", "_STL")])
def test_names_keep_to_what_cutters_read(source, name):
    assert piece_name(source) == name


def block_of(result):
    document = ezdxf.read(io.StringIO(cut_dxf.dxf_text(result)))
    (reference,) = document.modelspace().query("INSERT")
    return document, document.blocks[reference.dxf.name]


def test_the_dxf_has_a_block_per_piece_with_the_layers_of_the_standard(result):
    document, block = block_of(result)
    assert document.dxfversion == "AC1009"
    assert not document.audit().errors
    boundary = block.query('POLYLINE[layer=="1"]')
    assert len(boundary) == 1
    assert boundary[0].is_closed
    corners = np.array([tuple(v.dxf.location)[:2] for v in boundary[0].vertices])
    assert signed_area(corners) == pytest.approx(60000.0, rel=1e-6)
    turns = np.array([tuple(p.dxf.location)[:2] for p in block.query('POINT[layer=="2"]')])
    assert len(turns) == 4, "the corners of the plane"
    turn = np.radians(30.0)
    back = turns @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    np.testing.assert_allclose(np.sort(np.abs(back), axis=0), np.tile([150.0, 100.0], (4, 1)), atol=1e-3)
    (grain,) = block.query('LINE[layer=="7"]')
    assert grain.dxf.start.y == grain.dxf.end.y
    texts = [t.dxf.text for t in block.query('TEXT[layer=="1"]')]
    assert "Piece Name: PLANE" in texts
    assert any("Units: METRIC" in t.dxf.text for t in document.modelspace().query("TEXT"))


def test_notches_in_the_dxf_are_points_with_depth_and_direction(result):
    _, block = block_of(result)
    points = block.query('POINT[layer=="4"]')
    assert len(points) == 5
    expected = {tuple(np.round(n.at, 6) + 0.0): n.inward for n in cut_pieces(result)[0].notches}
    for point in points:
        x, y, depth = point.dxf.location
        assert depth == DEPTH
        inward = expected[(x, y)]
        angle = np.radians(point.dxf.angle)
        np.testing.assert_allclose([np.cos(angle), np.sin(angle)], inward, atol=1e-6)


def test_cut_outs_are_in_their_own_layer():
    part = gd.read_surface(Path(__file__).parents[2] / "samples" / "parts" / "bracket.stl")
    result = gd.evaluate(gd.drape(part, angle=45.0))
    _, block = block_of(result)
    assert len(result.flat.inner) == 2
    assert len(block.query('POLYLINE[layer=="11"]')) == 2
    assert len(block.query('POLYLINE[layer=="1"]')) == 1


def test_the_same_drape_gives_the_same_bytes(result, tmp_path):
    for name in ("a", "b"):
        cut_dxf.write(result, tmp_path / f"{name}.dxf")
        cut_pdf.write(result, tmp_path / f"{name}.pdf")
    for kind in ("dxf", "pdf"):
        assert (tmp_path / f"a.{kind}").read_bytes() == (tmp_path / f"b.{kind}").read_bytes()


@pytest.mark.parametrize("paper", ["A4", "A3"])
def test_pages_cover_the_piece_and_overlap(result, paper):
    pieces = cut_pieces(result)
    pages = tiling(pieces, paper)
    assert sorted(pages.page) == sorted(PAPERS[paper])
    np.testing.assert_allclose(pages.shown, pages.page - 2 * MARGIN)
    rng = np.random.default_rng(3)
    turn = np.radians(-30.0)
    inside = rng.uniform(-1, 1, (500, 2)) * [150.0, 100.0]
    inside = inside @ np.array([[np.cos(turn), np.sin(turn)], [-np.sin(turn), np.cos(turn)]])
    seen = np.zeros(500, int)
    for tile in pages.tiles:
        seen += ((inside >= tile.lower) & (inside <= tile.lower + pages.shown)).all(axis=1)
    assert (seen > 0).all()
    by_place = {(tile.row, tile.column): tile.lower for tile in pages.tiles}
    for (row, column), lower in by_place.items():
        if (row, column + 1) in by_place:
            assert by_place[row, column + 1][0] - lower[0] == pytest.approx(pages.shown[0] - OVERLAP)
        if (row + 1, column) in by_place:
            assert lower[1] - by_place[row + 1, column][1] == pytest.approx(pages.shown[1] - OVERLAP)


def test_a_piece_that_fits_on_a_page_takes_one_and_pages_beside_an_l_are_left_out():
    small = np.array([[0.0, 0.0], [250.0, 0.0], [250.0, 170.0], [0.0, 170.0]])
    pages = tiling(cut_pieces(pattern((small,), ())), "A4")
    assert len(pages.tiles) == 1
    assert pages.page[0] > pages.page[1], "across"
    arm = 150.0
    ell = np.array([[0, 0], [1000, 0], [1000, arm], [arm, arm], [arm, 1000], [0, 1000]], float)
    pages = tiling(cut_pieces(pattern((ell,), ())), "A4")
    assert len(pages.tiles) < 0.6 * pages.rows * pages.columns


def pdf_pages(data):
    """Size in mm and drawn paths in mm of each page of a PDF, from its bytes."""
    objects = {int(n): body for n, body in re.findall(rb"(\d+) 0 obj\n(.*?)\nendobj", data, re.DOTALL)}
    found = []
    for body in objects.values():
        if b"/Type /Page\n" not in body + b"\n" and b"/Type /Page " not in body:
            continue
        box = np.array(re.search(rb"/MediaBox \[ ?([^\]]*)\]", body)[1].split(), float) / 72 * 25.4
        stream = objects[int(re.search(rb"/Contents (\d+)", body)[1])]
        content = zlib.decompress(stream.split(b"stream\n", 1)[1].rsplit(b"\nendstream", 1)[0])
        found.append((box[2:], paths(content.decode("latin-1"))))
    return found


def paths(content):
    """Polylines (k, 2) in mm that a page draws with moves and lines, where no other frame is set."""
    out, current = [], []
    for line in content.splitlines():
        words = line.split()
        if words and words[-1] in ("m", "l") and len(words) == 3:
            if words[-1] == "m":
                current = []
                out.append(current)
            current.append([float(words[0]) / 72 * 25.4, float(words[1]) / 72 * 25.4])
        assert not (words and words[-1] == "cm" and [float(w) for w in words[:4]] != [1, 0, 0, 1]), "scaled"
    return [np.array(path) for path in out]


@pytest.mark.parametrize("paper", ["A4", "A3"])
def test_the_pdf_is_in_true_scale(result, tmp_path, paper):
    cut_pdf.write(result, tmp_path / "cut.pdf", paper)
    sheets = pdf_pages((tmp_path / "cut.pdf").read_bytes())
    pieces = cut_pieces(result)
    pages = tiling(pieces, paper)
    assert len(sheets) == 1 + len(pages.tiles)
    outer = pieces[0].outer
    for (size, lines), tile in zip(sheets[1:], pages.tiles, strict=True):
        np.testing.assert_allclose(size, pages.page, atol=0.02)
        contour = max(lines, key=len)  # of a page, the contour has the most points
        bars = [line for line in lines if len(line) == 4]
        assert any(np.ptp(bar[:, 0]) == pytest.approx(100.0, abs=0.01) for bar in bars), "the check length"
        shift = MARGIN - tile.lower
        distance = distances_to_contour(contour - shift, outer)
        assert len(contour) > 3
        assert distance.max() < 0.02


def distances_to_contour(points, polygon):
    """Distance of points (k, 2) from a closed polygon."""
    start, end = polygon, np.roll(polygon, -1, axis=0)
    side = end - start
    share = ((points[:, None] - start) * side).sum(axis=2) / (side**2).sum(axis=1)
    nearest = start + np.clip(share, 0, 1)[..., None] * side
    return np.linalg.norm(points[:, None] - nearest, axis=2).min(axis=1)


def test_no_pattern_no_pdf(tmp_path):
    with pytest.raises(GeomdrapError, match="no flat pattern to print"):
        cut_pdf.write(pattern((), ()), tmp_path / "cut.pdf")
