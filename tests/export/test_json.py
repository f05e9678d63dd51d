"""drape.json and the object that --json prints."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from square_ply import square_ply

from geomdrap.export import report_json
from geomdrap.fishnet import Status


def test_has_the_agreed_keys_with_the_values_of_the_result() -> None:
    report = report_json.as_dict(square_ply(), {"json": "drape.json"})
    assert report["schema"] == "geomdrap.drape/1"
    assert report["part"] == "square.stl"
    assert (report["origin"], report["angle"], report["pitch"]) == ([0.0, 0.0, 0.0], 30.0, 10.0)
    assert (report["nodes"], report["cells"]) == (24, 15)
    assert report["shear"] == {"max": 2.0, "p95": 1.9, "mean": 1.0}
    assert report["area"] == {"part": 1600.0, "draped": 1550.0, "fabric": 1550.0, "coverage": 0.96875}
    assert report["bare"] == [{"area": 50.0, "center": [18.0, 18.0, 0.0], "reason": "off the part"}]
    assert report["checks"] == {"edge_error": 0.0, "off_surface": 0.0, "curvature_residual": None}
    assert report["files"] == {"json": "drape.json"}
    assert (report["warnings"], report["notes"]) == (["a warning"], ["pitch 10 mm was chosen"])


def test_counts_absent_nodes_by_reason() -> None:
    result = square_ply()
    result.net.status[-1, -1] = Status.FOLDED
    assert report_json.absent_counts(result) == {Status.FOLDED.reason: 1}


def test_is_json_without_nan_or_signed_zero() -> None:
    result = square_ply()
    result.statistics.mean = float("inf")
    result.net.origin[:] = -1e-12
    text = report_json.as_text(report_json.as_dict(result))
    assert json.loads(text)["shear"]["mean"] is None
    assert "-0.0" not in text and "NaN" not in text and "Infinity" not in text


def test_a_bare_number_that_is_not_finite_is_refused_rather_than_written() -> None:
    with pytest.raises(ValueError, match="JSON"):
        report_json.as_text({"x": float("nan")})


def test_the_file_names_its_neighbours_but_not_their_folder(tmp_path: Path) -> None:
    path = tmp_path / "drape.json"
    result = square_ply()
    object.__setattr__(result.net.surface, "source", str(tmp_path / "square.stl"))
    report_json.write(result, path, {"png": tmp_path / "shear.png"})
    assert json.loads(path.read_text())["files"] == {"png": "shear.png"}
    assert str(tmp_path) not in path.read_text()


def test_the_same_result_gives_the_same_bytes(tmp_path: Path) -> None:
    for name in ("a.json", "b.json"):
        report_json.write(square_ply(), tmp_path / name)
    assert (tmp_path / "a.json").read_bytes() == (tmp_path / "b.json").read_bytes()


@pytest.mark.parametrize(("coverage", "incomplete"), [(1.0, False), (0.995, False), (0.9949, True)])
def test_is_incomplete_below_ninety_nine_and_a_half_percent(coverage: float, incomplete: bool) -> None:
    result = square_ply()
    result.area.coverage = coverage
    assert report_json.is_incomplete(result) is incomplete


def test_a_coverage_that_is_not_a_number_counts_as_incomplete() -> None:
    result = square_ply()
    result.area.coverage = float("nan")
    assert report_json.is_incomplete(result)
