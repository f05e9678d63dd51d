"""Compiled kernels do not outlive the sources that they were built from."""

import os

from geomdrap.geodesic.compiled import forget_stale_kernels


def package(folder):
    (folder / "part" / "__pycache__").mkdir(parents=True)
    (folder / "part" / "helper.py").write_text("x = 1\n")
    forget_stale_kernels(folder)
    kernel = folder / "part" / "__pycache__" / "user.kernel.nbi"
    kernel.write_text("compiled")
    return kernel


def test_kernels_stay_while_no_source_changes(tmp_path):
    kernel = package(tmp_path)
    assert forget_stale_kernels(tmp_path) == 0
    assert kernel.exists()


def test_an_edited_helper_drops_the_kernels_of_every_file(tmp_path):
    kernel = package(tmp_path)
    helper = tmp_path / "part" / "helper.py"
    helper.write_text("x = 2\n")
    os.utime(helper, ns=(1, 1))
    assert forget_stale_kernels(tmp_path) == 1
    assert not kernel.exists()
