"""What changed between two results: every kind of change is found, placed and measured; nothing else is."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from square_ply import square_ply

from geomdrap.errors import GeomdrapError
from geomdrap.export import report_json, table
from geomdrap.export.diff import Change, Comparison, Tolerance, compare


def _folder(path: Path, result: object) -> Path:
    path.mkdir()
    report_json.write(result, path / "drape.json", {"json": "drape.json"})
    table.write(result, path / "nodes.csv")
    return path


def _changes(tmp_path: Path, old: object, new: object, tolerance: Tolerance | None = None) -> list[Change]:
    return compare(_folder(tmp_path / "old", old), _folder(tmp_path / "new", new), tolerance).changes


def _files(tmp_path: Path, name: str, old: str, new: str, tolerance: Tolerance | None = None) -> Comparison:
    for side, text in (("old", old), ("new", new)):
        (tmp_path / side).mkdir()
        (tmp_path / side / name).write_text(text)
    return compare(tmp_path / "old" / name, tmp_path / "new" / name, tolerance)


def test_the_same_results_have_no_changes(tmp_path: Path) -> None:
    result = compare(_folder(tmp_path / "a", square_ply()), _folder(tmp_path / "b", square_ply()))
    assert not result.changed
    assert result.compared == ["drape.json", "nodes.csv"]


def test_a_moved_node_is_found_with_its_place_and_its_distance(tmp_path: Path) -> None:
    new = square_ply()
    new.net.points[1, 3] += [0.003, 0.0, -0.004]
    new.net.points[0, 0] += [0.0, 0.0, 0.001]
    (change,) = _changes(tmp_path, square_ply(), new)
    assert change.file == "nodes.csv"
    assert change.where.startswith("node u -10, v 10 ")
    assert change.what.startswith("2 nodes moved")
    assert (change.amount, change.unit) == (pytest.approx(0.005), "mm")


def test_a_changed_shear_is_found_in_degrees(tmp_path: Path) -> None:
    new = square_ply()
    new.net.shear[0, 4] += 0.25
    (change,) = _changes(tmp_path, square_ply(), new)
    assert change.where.startswith("node u -20, v 20 ")
    assert (change.amount, change.unit) == (pytest.approx(0.25), "deg")


@pytest.mark.parametrize(("tolerance", "found"), [(Tolerance(mm=0.004), 1), (Tolerance(mm=0.006), 0)])
def test_moves_within_the_tolerance_are_no_change(tmp_path: Path, tolerance: Tolerance, found: int) -> None:
    new = square_ply()
    new.net.points[1, 3, 2] += 0.005
    assert len(_changes(tmp_path, square_ply(), new, tolerance)) == found


def test_tolerances_of_lengths_and_angles_are_apart(tmp_path: Path) -> None:
    new = square_ply()
    new.net.points[1, 3, 2] += 0.005
    new.net.shear[0, 4] += 0.005
    (change,) = _changes(tmp_path, square_ply(), new, Tolerance(mm=0.01))
    assert change.unit == "deg"


def test_one_unit_in_the_last_decimal_is_within_the_default(tmp_path: Path) -> None:
    old, new = square_ply(), square_ply()
    old.net.points[:, :, 2] += 123.456788
    new.net.points[:, :, 2] += 123.456789
    assert not _changes(tmp_path, old, new)


def test_nodes_that_go_and_come_are_counted(tmp_path: Path) -> None:
    new = square_ply()
    new.net.points[0, 0], new.net.shear[0, 0], new.net.status[0, 0] = np.nan, np.nan, 2
    new.net.points[4, 4], new.net.shear[4, 4], new.net.status[4, 4] = [20, 20, 0], 2.0, 1
    found = {c.what.split(",")[0]: c.where for c in _changes(tmp_path, square_ply(), new)}
    assert found == {"1 node gone": "node u -20, v -20", "1 node new": "node u 20, v 20"}


def test_another_reason_for_an_absent_node_is_a_change(tmp_path: Path) -> None:
    new = square_ply()
    new.net.status[-1, -1] = 3
    by_file = {c.file: c for c in _changes(tmp_path, square_ply(), new)}
    assert "off the part -> in a hole of the part" in by_file["nodes.csv"].what
    assert by_file["drape.json"].where.startswith("absent.")


def test_nodes_are_matched_by_fabric_coordinates_not_by_row(tmp_path: Path) -> None:
    lines = table.as_text(square_ply().net).splitlines()
    turned = "\n".join([lines[0], *reversed(lines[1:])]) + "\n"
    assert not _files(tmp_path, "nodes.csv", "\n".join(lines) + "\n", turned).changed


def test_a_larger_net_of_the_same_pitch_has_only_new_nodes(tmp_path: Path) -> None:
    small, large = square_ply(cells=4), square_ply(cells=6)
    small.net.points[-1, -1], small.net.shear[-1, -1], small.net.status[-1, -1] = [20, 20, 0], 2.0, 1
    texts = [table.as_text(result.net) for result in (small, large)]
    (change,) = _files(tmp_path, "nodes.csv", *texts).changes
    assert change.what.startswith("23 nodes new")


def test_another_pitch_is_said_and_not_mistaken_for_moves(tmp_path: Path) -> None:
    changes = _changes(tmp_path, square_ply(pitch=10.0), square_ply(pitch=9.0))
    assert ("pitch", pytest.approx(1.0), "mm") in [(c.where, c.amount, c.unit) for c in changes]
    assert not [c for c in changes if "moved" in c.what]


@pytest.mark.parametrize(
    ("path", "unit"),
    [
        (("pitch",), "mm"),
        (("angle",), "deg"),
        (("shear", "max"), "deg"),
        (("limit_angle",), "deg"),
        (("checks", "curvature_residual"), "deg"),
        (("checks", "edge_error"), "mm"),
        (("area", "part"), "mm²"),
        (("area", "coverage"), ""),
        (("share", "over_limit"), ""),
    ],
)
def test_every_number_of_the_report_is_judged_in_its_unit(
    tmp_path: Path, path: tuple[str, ...], unit: str
) -> None:
    old = square_ply()
    old.checks.curvature_residual = 0.0
    old_report = report_json.as_dict(old)
    new_report = report_json.as_dict(old)
    leaf = new_report
    for key in path[:-1]:
        leaf = leaf[key]
    leaf[path[-1]] += 0.01
    result = _files(tmp_path, "drape.json", json.dumps(old_report), json.dumps(new_report))
    (change,) = result.changes
    assert (change.where, change.unit) == (".".join(path), unit)
    assert change.amount == pytest.approx(0.01)


@pytest.mark.parametrize(("key", "unit"), [("waste", ""), ("length", "mm"), ("max_shear", "deg"), ("area", "mm²")])
def test_numbers_of_a_roll_are_judged_in_their_units(tmp_path: Path, key: str, unit: str) -> None:
    old, new = (json.dumps({"roll": {key: value}}) for value in (0.25, 0.75))
    (change,) = _files(tmp_path, "drape.json", old, new).changes
    assert (change.where, change.unit) == (f"roll.{key}", unit)


def test_counts_have_no_tolerance(tmp_path: Path) -> None:
    (change,) = _files(tmp_path, "a.json", '{"nodes": 5}', '{"nodes": 6}', Tolerance(10, 10)).changes
    assert change.amount == 1


def test_an_area_may_change_as_much_as_its_outline_may_move(tmp_path: Path) -> None:
    old, new = '{"area": {"part": 1e6}}', '{"area": {"part": 1000000.003}}'
    assert not _files(tmp_path, "a.json", old, new).changed  # 4 × 1000 mm × 1e-6 mm = 0.004 mm²
    (tmp_path / "new" / "a.json").write_text('{"area": {"part": 1000000.005}}')
    assert compare(tmp_path / "old" / "a.json", tmp_path / "new" / "a.json").changed


@pytest.mark.parametrize(
    ("old", "new", "what"),
    [
        ('{"a": 1}', '{"a": 1, "b": "x"}', 'b: appeared: "x"'),
        ('{"a": 1, "b": [1.5]}', '{"a": 1, "b": []}', "b.0: vanished: was 1.5"),
        ('{"a": "x"}', '{"a": "y"}', 'a: "x" -> "y"'),
        ('{"a": null}', '{"a": 1.0}', "a: null -> 1.0"),
        ('{"a": true}', '{"a": 1}', "a: true -> 1"),
    ],
)
def test_what_is_no_number_must_be_the_same(tmp_path: Path, old: str, new: str, what: str) -> None:
    (change,) = _files(tmp_path, "a.json", old, new).changes
    assert str(change) == f"a.json: {what}"


def test_version_and_list_of_files_are_no_part_of_the_result(tmp_path: Path) -> None:
    old = '{"version": "1", "files": {"json": "drape.json"}}'
    result = _files(tmp_path, "drape.json", old, '{"version": "2", "files": {}}')
    assert not result.changed
    assert result.notes == ["drape.json: written by geomdrap 1 and 2"]


def test_a_missing_file_is_a_change_and_an_additional_one_a_note(tmp_path: Path) -> None:
    old, new = _folder(tmp_path / "old", square_ply()), _folder(tmp_path / "new", square_ply())
    (new / "nodes.csv").unlink()
    (change,) = compare(old, new).changes
    assert (change.file, "missing" in change.what) == ("nodes.csv", True)
    back = compare(new, old)
    assert not back.changed
    assert "only in" in back.notes[0]


def _clean(path: Path, result: object) -> Path:
    folder = _folder(path, result)
    report_json.write(result, folder / "drape.json", {"json": "drape.json", "csv": "nodes.csv"})
    return folder


def test_a_folder_of_one_run_gives_no_note(tmp_path: Path) -> None:
    assert compare(_clean(tmp_path / "old", square_ply()), _clean(tmp_path / "new", square_ply())).notes == []


def test_a_file_that_the_report_beside_it_does_not_list_is_said_to_be_of_another_run(tmp_path: Path) -> None:
    old, new = _clean(tmp_path / "old", square_ply()), _clean(tmp_path / "new", square_ply())
    report_json.write(square_ply(), new / "drape.json", {"json": "drape.json"})
    (note,) = compare(old, new).notes
    assert f"{new / 'nodes.csv'} was not written by the run that wrote drape.json" in note


def test_a_report_of_an_earlier_run_beside_a_new_table_is_found_by_the_number_of_nodes(tmp_path: Path) -> None:
    old, new = _clean(tmp_path / "old", square_ply()), _clean(tmp_path / "new", square_ply())
    table.write(square_ply(cells=6), new / "nodes.csv")
    (note,) = compare(old, new).notes
    assert f"{new / 'nodes.csv'} has 48 nodes, drape.json beside it says 24" in note


def test_the_json_form_has_all_of_it(tmp_path: Path) -> None:
    new = square_ply()
    new.net.points[1, 3, 2] += 0.005
    old_folder, new_folder = _folder(tmp_path / "old", square_ply()), _folder(tmp_path / "new", new)
    document = json.loads(json.dumps(compare(old_folder, new_folder).as_dict()))
    assert document["schema"] == "geomdrap.diff/1"
    assert document["changed"] is True
    assert document["changes"][0]["amount"] == pytest.approx(0.005)


BAD = {
    "not json": ("a.json", "{", "cannot compare"),
    "empty json": ("a.json", "", "cannot compare"),
    "no table": ("a.csv", "hello\n", "not a node table"),
    "empty table": ("a.csv", "", "not a node table"),
    "short line": ("a.csv", "u,v,x,y,z,shear\n1,2,3\n", "line 2 has 3 values"),
    "no number": ("a.csv", "u,v,x,y,z,shear\n1,2,3,4,5,q\n", "cannot compare"),
    "node without u": ("a.csv", "u,v,x,y,z,shear\n,2,3,4,5,6\n", "without u or v"),
    "no svg": ("a.svg", "<svg", "not an SVG"),
    "no dxf": ("a.dxf", "hello", "not a DXF"),
    "other kind": ("a.txt", "hello", "only .json"),
}


@pytest.mark.parametrize("case", BAD)
def test_bad_files_are_named_with_what_is_wrong(tmp_path: Path, case: str) -> None:
    name, text, message = BAD[case]
    with pytest.raises(GeomdrapError, match=message) as caught:
        _files(tmp_path, name, text, text + " ")
    assert name in str(caught.value)


def test_bytes_that_are_no_text_are_named(tmp_path: Path) -> None:
    for name in ("old", "new"):
        for suffix in (".json", ".csv", ".dxf", ".svg"):
            (tmp_path / f"{name}{suffix}").write_bytes(b"\xff\xfe" + name.encode())
    for suffix in (".json", ".csv", ".dxf", ".svg"):
        with pytest.raises(GeomdrapError, match="cannot compare"):
            compare(tmp_path / f"old{suffix}", tmp_path / f"new{suffix}")


def test_folders_without_a_result_and_unlike_pairs_are_refused(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    (tmp_path / "a.json").write_text("{}")
    (tmp_path / "a.csv").write_text("u")
    for old, new, message in [
        ("a", "b", "holds no result"),
        ("a", "missing", "does not exist"),
        ("a", "a.json", "a folder and a file"),
        ("a.json", "a.csv", "not of one kind"),
    ]:
        with pytest.raises(GeomdrapError, match=message):
            compare(tmp_path / old, tmp_path / new)
