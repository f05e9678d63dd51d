"""The Nastran deck: the user's own with THETA filled in, read back field by field."""

from __future__ import annotations

import numpy as np
import pytest
from fe_decks import corners_normal_side, fixed_fields, grid, nastran, nastran_theta, turned
from fe_plies import HEADING, dome, out, written

from geomdrap.errors import GeomdrapError
from geomdrap.export import fe_nastran
from geomdrap.export.fe_nastran import real
from geomdrap.export.fe_read import number, read_fe_mesh
from geomdrap.export.map_onto import map_onto


def test_nastran_theta_turns_side_12_into_the_warp_about_the_normal(cap, tmp_path):
    points, quads = grid(8, 8, 90.0, turn=40.0, height=dome)
    ply = map_onto(cap, written(tmp_path, "m.bdf", nastran(points, quads, theta="12.5")))
    cards = nastran_theta(out(fe_nastran, ply, tmp_path))
    theta = np.array([float(cards[n][7]) for n in ply.mesh.element_ids.tolist()])
    _, normal, _ = corners_normal_side(points, quads)
    side = ply.mesh.sides
    np.testing.assert_allclose(turned(side, normal, theta), ply.warp, atol=2e-5)
    assert theta[::3].mean() != pytest.approx(theta[1::3].mean(), abs=20.0), "turned elements have other angles"


def test_on_a_plane_nastran_theta_is_what_a_protractor_says(flat, tmp_path):
    points, quads = grid(3, 3, 90.0, turn=40.0)
    cards = nastran_theta(out(fe_nastran, map_onto(flat, written(tmp_path, "m.bdf", nastran(points, quads))), tmp_path))
    # as made, side 1-2 lies at 40° and the normal up: the warp at 25° is 15° clockwise
    assert float(cards[502][7]) == pytest.approx(HEADING - 40.0, abs=1e-3)
    # turned over, side 1-2 lies at 40° (from the fourth corner to the third), and clockwise is counter-clockwise
    assert float(cards[501][7]) == pytest.approx(-(HEADING - 40.0), abs=1e-3)


def test_the_nastran_deck_is_the_same_but_for_theta(flat, tmp_path):
    points, quads = grid(3, 3, 90.0)
    before = nastran(points, quads, theta="5.")
    after = out(fe_nastran, map_onto(flat, written(tmp_path, "m.bdf", before)), tmp_path)
    old = [line for line in before.splitlines() if not line.startswith("CQUAD4")]
    new = [line for line in after.splitlines() if not line.startswith(("CQUAD4", "$ "))]
    assert new == [line for line in old if not line.startswith("$ ")]
    for element, card in nastran_theta(after).items():
        was = nastran_theta(before)[element]
        assert card[:7] == was[:7]
        assert float(card[8]) == float(was[8]), "the offset stays"


def test_comments_of_the_deck_stay_byte_for_byte_also_within_cards(flat, tmp_path):
    before = b"$ Fl\xe4che, Werkzeug N\xb0 3\n$ page\x0cCTRIA3 of another page\n" + large_field_triangle().encode()
    before = before.replace(b"\n*  ", b" $ behind\n$ between \xfc\n\n*  ")
    (tmp_path / "m.bdf").write_bytes(before)
    fe_nastran.write(map_onto(flat, read_fe_mesh(tmp_path / "m.bdf")), tmp_path / "out")
    after = (tmp_path / "out").read_bytes()
    shell = after.index(b"CTRIA3  ")
    assert after[after.index(b"$ Fl") : shell] == before[: before.index(b"CTRIA3*")] + b"$ behind\n$ between \xfc\n"
    assert b"$" not in after[shell:]
    assert not after.endswith(b"\n\n"), "no line is added at the end"


def test_free_fields_continuations_and_second_order_shells_keep_what_they_had(flat, tmp_path):
    deck = """BEGIN BULK
GRID,1,,0.,0.,0.
GRID,2,,30.,0.,0.
GRID,3,,30.,30.,0.
GRID,4,0,0.,3.+1,0.
GRID,5,,15.,0.,0.
GRID,6,,30.,15.,0.
GRID,7,,15.,30.,0.
GRID,8,,0.,15.,0.
GRID,9,,-3.0E1,0.,0.
CQUAD8,11,7,1,2,3,4,5,6
,7,8,1.1,1.2,1.3,1.4,90.,0.5
CTRIA3*               12               7               1               4
*                      9
ENDDATA
"""
    ply = map_onto(flat, written(tmp_path, "m.bdf", deck))
    text = out(fe_nastran, ply, tmp_path)
    lines = text.splitlines()
    quad = next(k for k, line in enumerate(lines) if line.startswith("CQUAD8"))
    fields = fixed_fields(lines[quad])[1:] + fixed_fields(lines[quad + 1])[1:]
    assert fields[:14] == ["11", "7", *"12345678", "1.1", "1.2", "1.3", "1.4"]
    assert float(fields[14]) == pytest.approx(HEADING, abs=1e-3)
    assert fields[15] == "0.5"
    triangle = fixed_fields(next(line for line in lines if line.startswith("CTRIA3")))
    assert triangle[:6] == ["CTRIA3", "12", "7", "1", "4", "9"]
    assert float(triangle[6]) == pytest.approx(HEADING - 90.0, abs=1e-3)  # side 1-2 is +y, the normal up
    assert read_fe_mesh_of(tmp_path, text).material_angle == pytest.approx([HEADING, HEADING - 90.0], abs=1e-3)


SECOND_ORDER = """*NODE
1, 0., 0., 0.
2, 30., 0., 0.
3, 30., 30., 0.
4, 0., 30., 0.
5, 15., 0., 0.
6, 30., 15., 0.
7, 15., 30., 0.
8, 0., 15., 0.
*ELEMENT, TYPE=S8R
11, 1, 2, 3, 4, 5, 6, 7, 8
"""


def test_second_order_shells_of_another_solver_are_written_by_their_corners_and_that_is_said(flat, tmp_path):
    ply = map_onto(flat, written(tmp_path, "m.inp", SECOND_ORDER))
    lines = out(fe_nastran, ply, tmp_path).splitlines()
    (note,) = fe_nastran.losses(ply)
    assert "shells of m.inp by their corners alone: its other nodes, 4 of them" in note
    assert f"$ {note}" in lines
    assert fixed_fields(next(line for line in lines if line.startswith("CQUAD4")))[:7] == ["CQUAD4", "11", "1", *"1234"]
    kept = [line for line in SECOND_ORDER.splitlines() if line[0] not in "5678"]
    first_order = "\n".join(kept).replace("S8R", "S4R").replace(", 5, 6, 7, 8", "")
    assert fe_nastran.losses(map_onto(flat, written(tmp_path, "n.inp", first_order))) == []


def read_fe_mesh_of(tmp_path, text):
    (tmp_path / "again.bdf").write_text(text)
    return read_fe_mesh(tmp_path / "again.bdf")


def large_field_triangle(part="7", zoffset="0.5"):
    """A deck with one triangle in large fields, which hold sixteen characters."""
    nodes = "GRID,1,,0.,0.,0.\nGRID,2,,30.,0.,0.\nGRID,3,,30.,30.,0.\n"
    return f"{nodes}{'CTRIA3*':<8}{11:>16}{part:>16}{1:>16}{2:>16}\n{'*':<8}{3:>16}{'':>16}{zoffset:>16}\n"


def test_a_long_real_without_an_e_is_shortened_as_the_number_that_it_is(flat, tmp_path):
    ply = map_onto(flat, written(tmp_path, "m.bdf", large_field_triangle(zoffset="1.2345678-3")))
    (fields,) = nastran_theta(out(fe_nastran, ply, tmp_path)).values()
    assert number(fields[7], "", 0) == pytest.approx(1.2345678e-3, abs=5e-8)  # five digits


def test_a_property_too_long_for_a_field_is_refused(flat, tmp_path):
    ply = map_onto(flat, written(tmp_path, "m.bdf", large_field_triangle(part="123456789")))
    with pytest.raises(GeomdrapError, match=r"m\.bdf: number 123456789 does not fit into the 8 columns"):
        fe_nastran.write(ply, tmp_path / "out")


def test_a_long_word_that_is_no_number_is_refused_with_its_line(flat, tmp_path):
    ply = map_onto(flat, written(tmp_path, "m.bdf", large_field_triangle(zoffset="1.2345678x")))
    with pytest.raises(GeomdrapError, match=r"m\.bdf, line 4: '1\.2345678x' is not a number"):
        fe_nastran.write(ply, tmp_path / "out")


SIZES = 10.0 ** np.arange(-12, 13)


@pytest.mark.parametrize("value", [0.0, 1.0, -474.892456, 9999999.6, *(1.23456789 * SIZES), *(-9.87654321 * SIZES)])
def test_reals_fit_into_eight_columns_and_come_back_as_exactly_as_those_hold_them(value):
    text = real(value)
    assert len(text) <= 8
    assert "." in text
    # the point, a minus, and an exponent's sign and digits leave these many: half of the last is the error
    power = int(np.floor(np.log10(abs(value)))) if value else 0
    with_exponent = 7 - (value < 0) - len(f"{power:+d}")
    whole = 7 - (value < 0)
    plain = whole if 0 <= power < whole else whole + 1 + power if power < 0 else 0
    assert abs(number(text, "", 0) - value) <= 0.5001 * 10.0 ** (power + 1 - max(plain, with_exponent))


def test_of_two_notations_the_nearer_is_written():
    assert real(-0.0123456) == "-.012346"  # with an exponent -1.235-2
    assert real(0.00098765) == "9.8765-4"  # without one .0009877
    assert real(0.0012345678) == ".0012346"
