"""flat.svg read back as XML: true scale, layers as groups, v upwards."""

import re
from xml.etree import ElementTree

import numpy as np
import pytest
from made_up import made_up_drape, polygon_area

from geomdrap.export import svg
from geomdrap.export.drawing import flat_drawing

SVG = "{http://www.w3.org/2000/svg}"
GROUPS = ["locked-zones", "warp-lines", "weft-lines", "inner-contours", "outer-contour", "rosette", "notes"]


@pytest.fixture
def drape():
    return made_up_drape()


@pytest.fixture
def root(drape, tmp_path):
    svg.write(drape, tmp_path / "flat.svg")
    return ElementTree.parse(tmp_path / "flat.svg").getroot()


def paths(root, group):
    """Points (k, 2) of the paths of a group, as they stand in the file (y downwards)."""
    found = root.find(f"{SVG}g[@id='{group}']").findall(f"{SVG}path")
    return [
        np.array([[float(x) for x in pair.split(",")] for pair in re.findall(r"[-\d.]+,[-\d.]+", p.get("d"))])
        for p in found
    ]


def test_layers_are_groups_under_their_names(root):
    assert [group.get("id") for group in root] == GROUPS


def test_one_unit_is_one_millimetre(root):
    left, top, width, height = (float(x) for x in root.get("viewBox").split())
    assert root.get("width") == f"{width:.6f}".rstrip("0").rstrip(".") + "mm"
    assert root.get("height") == f"{height:.6f}".rstrip("0").rstrip(".") + "mm"
    assert width > 200
    assert height > 140
    assert left < -100
    assert top < -70


def test_the_sheet_is_the_extents_of_the_drawing_and_an_even_margin(root, drape):
    left, top, width, height = (float(x) for x in root.get("viewBox").split())
    drawing = flat_drawing(drape)
    size = drawing.upper - drawing.lower
    margin = svg.MARGIN * size.max()
    np.testing.assert_allclose([width, height], size + 2 * margin, atol=3e-6)
    np.testing.assert_allclose(
        [left, top], [drawing.lower[0] - margin, -drawing.upper[1] - margin], atol=3e-6
    )


def test_the_contours_enclose_the_area_of_the_pattern(root, drape):
    area = -sum(polygon_area(p) for group in ("outer-contour", "inner-contours") for p in paths(root, group))
    assert area == pytest.approx(drape.flat.area, rel=1e-6)


def test_the_pattern_is_not_mirrored(root):
    (outer,) = paths(root, "outer-contour")
    assert not np.any((outer[:, 0] > 60) & (outer[:, 1] < -40))  # the L lacks its upper right corner
    assert np.any((outer[:, 0] < -60) & (outer[:, 1] < -40))
    assert np.any((outer[:, 0] > 60) & (outer[:, 1] > 40))


def test_the_weft_arrow_points_up_on_the_sheet(root):
    _, shaft, _ = paths(root, "rosette")
    assert shaft[1, 1] < shaft[0, 1]


def test_contours_are_closed_and_yarns_open(root):
    for group, closed in (
        ("outer-contour", True),
        ("inner-contours", True),
        ("locked-zones", True),
        ("warp-lines", False),
    ):
        elements = root.find(f"{SVG}g[@id='{group}']").findall(f"{SVG}path")
        assert elements
        assert all(element.get("d").endswith("Z") == closed for element in elements)


def test_signs_of_xml_in_the_name_of_a_part_are_escaped(tmp_path):
    svg.write(made_up_drape(source="a<b>&c.stl"), tmp_path / "flat.svg")
    texts = [text.text for text in ElementTree.parse(tmp_path / "flat.svg").getroot().iter(f"{SVG}text")]
    assert "a<b>&c.stl: flat pattern, mm, true scale 1:1" in texts


def test_two_writes_give_the_same_bytes(drape, tmp_path):
    svg.write(drape, tmp_path / "a.svg")
    svg.write(drape, tmp_path / "b.svg")
    assert (tmp_path / "a.svg").read_bytes() == (tmp_path / "b.svg").read_bytes()


@pytest.mark.parametrize(
    ("value", "text"),
    [
        (0.0, "0"),
        (-1e-9, "0"),
        (-0.0, "0"),
        (12.5, "12.5"),
        (1e-6, "0.000001"),
        (1e7, "10000000"),
        (-3.1234567, "-3.123457"),
    ],
)
def test_numbers_have_six_decimals_at_most_and_no_exponent(value, text):
    assert svg.number(value) == text
