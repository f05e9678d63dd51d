import json

import numpy as np
import pytest
from raw_meshes import box, bumpy, fin, grid

from geomdrap.surface import Surface, check, findings


def test_a_clean_mesh_has_nothing_to_report():
    assert Surface(*bumpy()).findings.lines() == ()


@pytest.mark.parametrize(
    ("size", "words"), [(0.5, "use --unit m or --unit in"), (8.0, "use --unit m or --unit in"), (2e5, "was --unit right"), (300.0, "")]
)
def test_a_doubtful_unit_is_pointed_out(size, words):
    hint = Surface(*bumpy(4, size)).findings.unit_hint
    assert (words in hint) if words else hint == ""


def test_rounding_is_not_written_as_a_place():
    assert findings.place((-1.50809e-16, -0.0, 75.0)) == "(0, 0, 75)"
    assert findings.place((1.5e-7, 2e-7, 0.0)) == "(1.5e-07, 2e-07, 0)"


def test_components_are_listed_by_area_with_their_centres():
    points, triangles = grid(2)
    far = box((30.0, 30.0, 30.0))
    surface = Surface(np.vstack([far[0] + 500.0, points]), np.vstack([far[1], triangles + 8]))
    sheet, cube = surface.findings.components
    assert (sheet.area, sheet.closed) == (pytest.approx(10000.0), False)
    assert sheet.center == pytest.approx((50.0, 50.0, 0.0))
    assert (cube.area, cube.closed) == (pytest.approx(5400.0), True)
    assert cube.center == pytest.approx((515.0, 515.0, 515.0))
    assert "2 separate components: 10000 mm² at (50, 50, 0)" in surface.findings.lines()[0]


def test_slivers_are_counted():
    points = np.array([[0, 0, 0], [100, 0, 0], [50, 0.05, 0], [50, 80, 0], [50, -80, 0]], dtype=float)
    found = Surface(points, [[0, 1, 2], [0, 2, 3], [2, 1, 3], [1, 0, 4]]).findings
    assert found.n_slivers == 1
    assert found.worst_sliver == pytest.approx(5e-4)


def test_a_vertex_on_the_middle_of_an_edge_is_found_as_a_crack():
    points = np.array([[0, 0, 0], [100, 0, 0], [100, 100, 0], [0, 100, 0]], dtype=float)
    points = np.vstack([points, [[0, -100, 0], [100, -100, 0], [40.0, 0.0, 0.0]]])
    upper = [[0, 6, 3], [6, 1, 2], [6, 2, 3]]
    found = Surface(points, [*upper, [0, 4, 1], [4, 5, 1]]).findings
    assert found.cracks == ((40.0, 0.0, 0.0),)
    assert any("T-junction" in line for line in found.lines())
    assert Surface(*grid(7)).findings.n_cracks == 0


def test_the_report_is_plain_json_and_says_whether_the_part_can_be_draped():
    good, bad = check.report(Surface(*bumpy())), check.report(Surface(*fin(), source="fin.stl"))
    assert json.loads(json.dumps(good))["area"] == good["area"]
    assert (good["drapable"], good["problem"]) == (True, None)
    assert not bad["drapable"]
    assert "(50, 25, 0)" in bad["problem"]
    assert bad["findings"]["n_non_manifold"] == 1


def test_the_report_in_words_ends_with_the_verdict():
    lines = check.text(Surface(*box(), source="box.stl")).splitlines()
    assert lines[0] == "box.stl: 12 faces, closed, 10 × 20 × 30 mm, area 2200 mm², mean edge 23.34 mm"
    assert lines[-1] == "fit to be draped"
    assert check.text(Surface(*fin())).splitlines()[-1].startswith("not fit to be draped: ")
