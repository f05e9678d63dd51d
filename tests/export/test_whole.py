"""Files are whole or untouched."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from geomdrap.errors import GeomdrapError
from geomdrap.export.whole import check_writable, whole_file, whole_folder, write_whole


def test_writes_text_and_bytes_as_they_are(tmp_path: Path) -> None:
    write_whole(tmp_path / "a.txt", "one\ntwo° \n")
    write_whole(tmp_path / "b.bin", b"\x00\r\n")
    assert (tmp_path / "a.txt").read_bytes() == "one\ntwo° \n".encode()
    assert (tmp_path / "b.bin").read_bytes() == b"\x00\r\n"


def test_replaces_the_old_file_and_leaves_nothing_else(tmp_path: Path) -> None:
    target = tmp_path / "a.txt"
    target.write_text("old")
    write_whole(target, "new")
    assert target.read_text() == "new"
    assert os.listdir(tmp_path) == ["a.txt"]


def test_a_failing_writer_leaves_the_old_file_and_no_temporary_one(tmp_path: Path) -> None:
    target = tmp_path / "a.txt"
    target.write_text("old")
    with pytest.raises(RuntimeError), whole_file(target) as temporary:
        temporary.write_text("half of the ne")
        raise RuntimeError
    assert target.read_text() == "old"
    assert os.listdir(tmp_path) == ["a.txt"]


def test_the_temporary_file_keeps_the_suffix_because_writers_look_at_it(tmp_path: Path) -> None:
    with whole_file(tmp_path / "a.vtu") as temporary:
        assert temporary.suffix == ".vtu"
        temporary.write_text("")


def test_a_folder_in_the_way_is_named(tmp_path: Path) -> None:
    (tmp_path / "a.txt").mkdir()
    with pytest.raises(GeomdrapError, match=r"cannot write .*a\.txt"):
        write_whole(tmp_path / "a.txt", "new")
    assert os.listdir(tmp_path) == ["a.txt"]


def test_a_missing_folder_is_an_error_not_made(tmp_path: Path) -> None:
    with pytest.raises(GeomdrapError, match="cannot write"):
        write_whole(tmp_path / "missing" / "a.txt", "new")


def test_files_of_a_folder_appear_together(tmp_path: Path) -> None:
    folder = tmp_path / "new" / "result"
    with whole_folder(folder) as scratch:
        (scratch / "a").write_text("1")
        assert not (folder / "a").exists()
        (scratch / "b").write_text("2")
    assert sorted(os.listdir(folder)) == ["a", "b"]


def test_a_failure_leaves_every_file_of_the_folder_as_it_was(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("old")
    with pytest.raises(RuntimeError), whole_folder(tmp_path) as scratch:
        (scratch / "a").write_text("new")
        raise RuntimeError
    assert os.listdir(tmp_path) == ["a"]
    assert (tmp_path / "a").read_text() == "old"


def test_a_folder_in_the_way_of_one_file_keeps_all_from_being_replaced(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("old")
    (tmp_path / "b").mkdir()
    with pytest.raises(GeomdrapError, match="in the way"), whole_folder(tmp_path) as scratch:
        (scratch / "a").write_text("new")
        (scratch / "b").write_text("new")
    assert (tmp_path / "a").read_text() == "old"


def test_a_file_cannot_be_the_folder(tmp_path: Path) -> None:
    (tmp_path / "a").write_text("old")
    for folder in (tmp_path / "a", tmp_path / "a" / "deeper"):
        with pytest.raises(GeomdrapError, match="not a folder"):
            check_writable(folder)


def test_a_folder_without_permission_is_named_before_anything_is_done(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(os, "access", lambda *_: False)  # as root every folder can be written
    with pytest.raises(GeomdrapError, match="no permission"):
        check_writable(tmp_path / "result")
