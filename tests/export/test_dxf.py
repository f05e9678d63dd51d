"""flat.dxf read back with ezdxf: what a cutter would cut."""

import os
import subprocess
import sys
from pathlib import Path

import ezdxf
import numpy as np
import pytest
from made_up import made_up_drape, polygon_area

from geomdrap.errors import GeomdrapError
from geomdrap.export import dxf

LAYERS = {
    "OUTER_CONTOUR", "INNER_CONTOURS", "ROSETTE", "WARP_LINES", "WEFT_LINES", "LOCKED_ZONES", "NOTES",
}  # fmt: skip


@pytest.fixture
def drape():
    return made_up_drape()


@pytest.fixture
def document(drape, tmp_path):
    dxf.write(drape, tmp_path / "flat.dxf")
    return ezdxf.readfile(tmp_path / "flat.dxf")


def lines_on(document, layer):
    return [
        np.array(line.get_points("xy"))
        for line in document.modelspace().query(f'LWPOLYLINE[layer=="{layer}"]')
    ]


def test_the_file_is_sound_and_in_millimetres(document):
    assert document.dxfversion == "AC1024"
    assert document.header["$INSUNITS"] == 4
    assert document.header["$MEASUREMENT"] == 1
    assert not document.audit().has_errors


def test_each_kind_of_line_has_its_layer(document):
    assert {layer.dxf.name for layer in document.layers} >= LAYERS
    assert {entity.dxf.layer for entity in document.modelspace()} == LAYERS


def test_the_contours_enclose_the_area_of_the_pattern(document, drape):
    outer = sum(polygon_area(p) for p in lines_on(document, "OUTER_CONTOUR"))
    inner = sum(polygon_area(p) for p in lines_on(document, "INNER_CONTOURS"))
    assert outer + inner == pytest.approx(drape.flat.area, rel=1e-6)


def test_contours_are_closed_and_yarns_open(document):
    closed = {line.dxf.layer for line in document.modelspace().query("LWPOLYLINE") if line.closed}
    assert closed == {"OUTER_CONTOUR", "INNER_CONTOURS", "LOCKED_ZONES"}


def test_contours_and_yarns_have_the_coordinates_of_the_pattern(document, drape):
    for layer, expected in (
        ("OUTER_CONTOUR", drape.flat.outer), ("WARP_LINES", drape.flat.warp_lines),
        ("WEFT_LINES", drape.flat.weft_lines), ("LOCKED_ZONES", drape.flat.locked),
    ):  # fmt: skip
        found = lines_on(document, layer)
        assert len(found) == len(expected)
        for line, true in zip(found, expected, strict=True):
            np.testing.assert_allclose(line, true, atol=6e-7)


def test_the_pattern_is_not_mirrored(document):
    (outer,) = lines_on(document, "OUTER_CONTOUR")
    assert not np.any((outer[:, 0] > 60) & (outer[:, 1] > 40))  # the L lacks its corner at +u, +v
    assert np.any((outer[:, 0] < -60) & (outer[:, 1] > 40))
    assert polygon_area(outer) > 0


def test_the_warp_arrow_points_along_u_and_the_weft_arrow_along_v(document):
    warp, shaft, tip = lines_on(document, "ROSETTE")
    np.testing.assert_array_equal(warp[0], [0, 0])
    assert warp[1, 0] > 0
    assert warp[1, 1] == 0
    np.testing.assert_array_equal(shaft[0], [0, 0])
    assert shaft[1, 1] > 0
    assert shaft[1, 0] == 0
    np.testing.assert_array_equal(tip[1], shaft[1])


@pytest.mark.parametrize(("width", "length"), [(4.0, 2.0), (200.0, 100.0), (9000.0, 1000.0)])
def test_the_check_length_is_as_long_as_its_note_says(tmp_path, width, length):
    dxf.write(made_up_drape(width=width, height=0.9 * width), tmp_path / "flat.dxf")
    document = ezdxf.readfile(tmp_path / "flat.dxf")
    (bar,) = lines_on(document, "NOTES")
    notes = [text.dxf.text for text in document.modelspace().query("TEXT")]
    assert np.ptp(bar[:, 0]) == pytest.approx(length, abs=2e-6)
    assert f"CHECK LENGTH {length:g} mm" in notes


def test_the_notes_say_what_is_drawn_and_that_it_is_incomplete(tmp_path):
    dxf.write(made_up_drape(coverage=0.9, source="/somewhere/else/wing rib.stl"), tmp_path / "flat.dxf")
    notes = [text.dxf.text for text in ezdxf.readfile(tmp_path / "flat.dxf").modelspace().query("TEXT")]
    assert "wing rib.stl: flat pattern, mm, true scale 1:1" in notes
    assert "coverage 90.00 %: INCOMPLETE" in notes
    assert not any("somewhere" in note for note in notes)


@pytest.mark.parametrize("shape", [(200.0, 140.0), (100.0, 1000.0), (1000.0, 100.0)])
def test_notes_stand_clear_of_the_pattern(tmp_path, shape):
    drape = made_up_drape(width=shape[0], height=shape[1])
    dxf.write(drape, tmp_path / "flat.dxf")
    document = ezdxf.readfile(tmp_path / "flat.dxf")
    right, bottom = shape[0] / 2, -shape[1] / 2
    for text in document.modelspace().query('TEXT[layer=="NOTES"]'):
        x, y, _ = text.dxf.insert
        assert x > right or y + text.dxf.height < bottom


def test_the_extents_in_the_header_hold_all_lines(document):
    points = np.vstack(
        [lines_on(document, layer)[k] for layer in LAYERS for k in range(len(lines_on(document, layer)))]
    )
    assert np.all(points.min(axis=0) >= np.array(document.header["$EXTMIN"][:2]) - 1e-9)
    assert np.all(points.max(axis=0) <= np.array(document.header["$EXTMAX"][:2]) + 1e-9)


def test_two_writes_give_the_same_bytes(drape, tmp_path):
    dxf.write(drape, tmp_path / "a.dxf")
    dxf.write(drape, tmp_path / "b.dxf")
    assert (tmp_path / "a.dxf").read_bytes() == (tmp_path / "b.dxf").read_bytes()


def test_another_process_with_another_hash_seed_gives_the_same_bytes(tmp_path):
    script = (
        "import sys; from pathlib import Path\n"
        "from made_up import made_up_drape; from geomdrap.export import dxf, svg\n"
        "for name, kind in (('dxf', dxf), ('svg', svg)):\n"
        "    kind.write(made_up_drape(), Path(sys.argv[1] + '.' + name))\n"
    )
    here = Path(__file__).parent
    for seed in ("1", "2"):
        environment = {
            **os.environ,
            "PYTHONHASHSEED": seed,
            "PYTHONPATH": f"{here}{os.pathsep}{here.parents[1]}",
        }
        subprocess.run([sys.executable, "-c", script, str(tmp_path / seed)], env=environment, check=True)
    for ending in ("dxf", "svg"):
        assert (tmp_path / f"1.{ending}").read_bytes() == (tmp_path / f"2.{ending}").read_bytes()


def test_a_pattern_without_contours_is_still_a_sound_file(tmp_path, drape):
    for name in ("outer", "inner", "warp_lines", "weft_lines", "locked"):
        setattr(drape.flat, name, ())
    dxf.write(drape, tmp_path / "flat.dxf")
    assert not ezdxf.readfile(tmp_path / "flat.dxf").audit().has_errors


def test_a_missing_folder_is_an_error_that_names_the_file(drape, tmp_path):
    with pytest.raises(GeomdrapError, match=r"flat\.dxf"):
        dxf.write(drape, tmp_path / "missing" / "flat.dxf")
