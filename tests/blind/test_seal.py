"""The seal: the truth cannot be read at a glance nor changed unseen, and verdicts come before it."""

from __future__ import annotations

import hashlib
import json

import pytest

from geomdrap.blind import grade, make, parameters, read_seal, unseal
from geomdrap.blind.record import reveal, write_solved
from geomdrap.blind.seal import hashes, seal
from geomdrap.errors import GeomdrapError

TRUTH = {"answer": "slip", "effect": {"slip": {"coefficient": 0.7}}, "placement": {}}
FOUND = {
    "verdict": "slip",
    "candidates": ["slip"],
    "confidence": 0.9,
    "effects": [{"name": "slip", "parameters": {"coefficient": {"value": 0.8, "sigma": 0.1, "unit": ""}}}],
}


def test_the_truth_comes_back_and_the_hash_is_that_of_its_text_and_salt(tmp_path):
    found = seal(tmp_path, TRUTH)
    assert unseal(tmp_path) == {**TRUTH, "files": {}}
    assert found == read_seal(tmp_path)
    assert len(found) == len(hashlib.sha256().hexdigest())


def test_the_sealed_file_does_not_show_the_answer(tmp_path):
    seal(tmp_path, TRUTH)
    data = (tmp_path / "truth.sealed").read_bytes()
    assert b"slip" not in data
    assert not (tmp_path / "truth.json").exists()


@pytest.mark.parametrize("name", ["truth.sealed", "seal.txt"])
def test_a_changed_file_breaks_the_seal(tmp_path, name):
    seal(tmp_path, TRUTH)
    other = tmp_path / "other"
    other.mkdir()
    seal(other, {**TRUTH, "answer": "none"})
    (tmp_path / name).write_bytes((other / name).read_bytes())
    with pytest.raises(GeomdrapError, match="seal"):
        unseal(tmp_path)


def test_garbage_in_place_of_the_truth_is_refused(tmp_path):
    seal(tmp_path, TRUTH)
    (tmp_path / "truth.sealed").write_bytes(b"\xff\x00 not base64")
    with pytest.raises(GeomdrapError):
        unseal(tmp_path)


def test_a_set_is_not_revealed_before_it_is_solved_unless_anyway_and_takes_no_verdict_after(tmp_path):
    seal(tmp_path, TRUTH)
    with pytest.raises(GeomdrapError, match="not solved"):
        reveal(tmp_path)
    shown = reveal(tmp_path, anyway=True)
    assert (shown["truth"], shown["grade"], shown["right"]) == ({**TRUTH, "files": {}}, None, None)
    with pytest.raises(GeomdrapError, match="revealed"):
        write_solved(tmp_path, FOUND, hashes(tmp_path))


def test_the_reveal_grades_and_compares_and_says_when_it_was_solved(tmp_path):
    seal(tmp_path, TRUTH)
    solved = write_solved(tmp_path, FOUND, hashes(tmp_path))
    shown = reveal(tmp_path)
    assert (shown["verdict"], shown["grade"], shown["right"]) == ("slip", "right", True)
    assert shown["solved_at"] == solved["solved_at"] <= shown["revealed_at"]
    assert shown["parameters"][0]["off"] == pytest.approx(1.0)
    assert json.loads((tmp_path / "revealed.json").read_text())["grade"] == "right"


def test_a_verdict_for_another_seal_does_not_count(tmp_path):
    seal(tmp_path, TRUTH)
    write_solved(tmp_path, FOUND, hashes(tmp_path))
    seal(tmp_path, TRUTH)
    with pytest.raises(GeomdrapError, match="another seal"):
        reveal(tmp_path)


def test_a_verdict_on_another_table_than_the_sealed_one_does_not_count(tmp_path):
    table = tmp_path / "measured.csv"
    table.write_text("x,y,z\n1,2,3\n")
    seal(tmp_path, TRUTH)
    table.write_text("x,y,z\n1,2,4\n")
    write_solved(tmp_path, FOUND, hashes(tmp_path))
    table.write_text("x,y,z\n1,2,3\n")  # putting it back does not help
    with pytest.raises(GeomdrapError, match=r"measured\.csv was not the file that was sealed"):
        reveal(tmp_path)
    write_solved(tmp_path, FOUND, hashes(tmp_path))
    table.write_text("x,y,z\n")  # nor does what comes after harm
    assert reveal(tmp_path)["grade"] == "right"

    shown = reveal(tmp_path)
    assert (shown["changed"], shown["changed_since"], shown["edited"]) == ([], ["measured.csv"], False)


def test_a_verdict_that_was_edited_does_not_count(tmp_path):
    seal(tmp_path, TRUTH)
    write_solved(tmp_path, {**FOUND, "verdict": "none", "confidence": 0.1 + 0.2}, hashes(tmp_path))
    assert reveal(tmp_path)["edited"] is False
    solved = tmp_path / "solved.json"
    (tmp_path / "revealed.json").unlink()
    solved.write_text(solved.read_text().replace('"verdict": "none"', '"verdict": "slip"'))
    with pytest.raises(GeomdrapError, match=r"solved\.json was edited after it was written"):
        reveal(tmp_path)
    shown = reveal(tmp_path, anyway=True)
    assert (shown["edited"], shown["verdict"], shown["grade"], shown["right"]) == (True, None, None, None)


@pytest.mark.parametrize("without", [["digest"], ["digest", "files"]])
def test_a_verdict_of_an_earlier_version_has_no_digest_and_is_not_said_to_be_edited(tmp_path, without):
    (tmp_path / "measured.csv").write_text("x,y,z\n1,2,3\n")
    seal(tmp_path, TRUTH)
    record = write_solved(tmp_path, FOUND, hashes(tmp_path))
    old = {key: value for key, value in record.items() if key not in without}
    (tmp_path / "solved.json").write_text(json.dumps(old))
    with pytest.raises(GeomdrapError, match=r"solved\.json was written by an earlier version.*solve the set again"):
        reveal(tmp_path)
    shown = reveal(tmp_path, anyway=True)
    assert (shown["earlier"], shown["edited"], shown["changed"], shown["grade"]) == (True, False, [], None)


@pytest.mark.parametrize(
    ("value", "sigma", "outside", "sign"),
    [
        (0.8, 0.1, False, False),
        (1.0, 0.1, True, False),
        (-0.1, 0.1, True, True),
        (-0.1, 0.9, False, True),
        (0.8, None, None, None),
    ],
)
def test_values_outside_their_interval_or_of_the_wrong_sign_are_marked(value, sigma, outside, sign):
    found = {
        "effects": [{"name": "slip", "parameters": {"coefficient": {"value": value, "sigma": sigma, "unit": ""}}}]
    }
    (row,) = parameters(TRUTH, found)
    assert (row["outside"], row["wrong_sign"]) == (outside, sign)


def test_a_verdict_on_a_changed_table_is_shown_anyway_ungraded(tmp_path):
    (tmp_path / "measured.csv").write_text("x,y,z\n1,2,3\n")
    seal(tmp_path, TRUTH)
    (tmp_path / "measured.csv").unlink()
    write_solved(tmp_path, FOUND, hashes(tmp_path))
    shown = reveal(tmp_path, anyway=True)
    assert (shown["changed"], shown["grade"], shown["right"]) == (["measured.csv"], None, None)


def test_a_folder_that_is_no_set_is_refused(tmp_path):
    with pytest.raises(GeomdrapError, match=r"seal\.txt"):
        reveal(tmp_path)


@pytest.mark.parametrize(
    ("answer", "verdict", "candidates", "expected"),
    [
        ("slip", "slip", ["slip"], "right"),
        ("slip+thickness", "thickness+slip", [], "right"),
        ("slip", "ambiguous", ["locking", "slip"], "among the candidates"),
        ("slip", "ambiguous", ["locking"], "wrong"),
        ("slip+thickness", "ambiguous", ["slip+thickness", "locking"], "among the candidates"),
        ("slip", "unknown", [], "unexplained"),
        ("slip", "placement", [], "missed"),
        ("slip", "thickness", [], "wrong"),
        ("slip+thickness", "slip", [], "partly"),
        ("none", "none", [], "right"),
        ("none", "placement", [], "wrong"),
        ("none", "slip", [], "false alarm"),
        ("none", "unknown", [], "false alarm"),
        ("placement", "ambiguous", ["slip", "thickness"], "false alarm"),
        ("unknown", "unknown", [], "right"),
        ("unknown", "ambiguous", ["slip", "thickness"], "among the candidates"),
        ("unknown", "slip", [], "wrong"),
        ("unknown", "none", [], "missed"),
    ],
)
def test_grades(answer, verdict, candidates, expected):
    assert grade(answer, verdict, candidates) == expected


def test_a_parameter_that_was_not_fitted_is_listed_without_a_value():
    rows = parameters(TRUTH, {"effects": []})
    assert (rows[0]["true"], rows[0]["found"], rows[0]["off"]) == (0.7, None, None)


def test_a_set_made_by_make_is_sealed(tmp_path):
    truth = unseal(make(1, effect="none", folder=tmp_path))
    assert truth["answer"] == "none"
