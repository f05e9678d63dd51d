"""Compiled kernels do not outlive the sources that they were built from."""

import pytest

from geomdrap.geodesic.stale import forget_stale_kernels


@pytest.fixture
def package(tmp_path):
    folder = tmp_path / "geomdrap"
    (folder / "part" / "__pycache__").mkdir(parents=True)
    (folder / "part" / "helper.py").write_text("x = 1\n")
    (folder / "part" / "user.py").write_text("from geomdrap.part.helper import x\n")
    (folder / "part" / "other.py").write_text("y = 1\n")
    forget_stale_kernels(folder)
    for name in ("user", "other"):
        (folder / "part" / "__pycache__" / f"{name}.kernel-1.py311.nbi").write_text("compiled")
    return folder


def kernels(package):
    return sorted(f.name.split(".")[0] for f in package.rglob("*.nbi"))


def test_kernels_stay_while_no_source_changes(package):
    assert forget_stale_kernels(package) == 0
    assert kernels(package) == ["other", "user"]


def test_an_edited_helper_drops_the_kernels_of_the_files_that_use_it_and_no_others(package):
    (package / "part" / "helper.py").write_text("x = 22\n")
    assert forget_stale_kernels(package) == 1
    assert kernels(package) == ["other"]


def test_kernels_of_a_file_that_is_gone_are_dropped(package):
    (package / "part" / "other.py").unlink()
    assert forget_stale_kernels(package) == 1
    assert kernels(package) == ["user"]


def test_a_stamp_that_cannot_be_read_drops_all_kernels(package):
    (package / "__pycache__" / "kernels.stamp").write_text("not json")
    assert forget_stale_kernels(package) == 2
    assert kernels(package) == []
