"""The drape of a commercial tool as if it were a measurement: its node numbers, its metres, its mirrored weft."""

from __future__ import annotations

import gzip
from pathlib import Path

import numpy as np
import pytest

import geomdrap as gd

FOLDER = Path(__file__).parents[1] / "data" / "cma"
START = 5  # the seed: nodes into the warp course


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    """Surface, path of the table, and how the ply was laid."""
    folder = tmp_path_factory.mktemp("blade")
    part = folder / "blade.stl"
    part.write_bytes(gzip.decompress((FOLDER / "blade_like.stl.gz").read_bytes()))
    text = gzip.decompress((FOLDER / "GeoCourse.vfp.gz").read_bytes()).decode()
    rows = [row.split()[:10] for row in text.split("*PLY")[1].splitlines() if row and not row.startswith("*")]
    lines = ["warp course\tweft course\tX [m]\tY [m]\tZ [m]\tangle"]
    lines += ["\t".join([*row[:5], f"{np.degrees(float(row[8])):.9f}"]) for row in rows[::7]]
    table = folder / "nodes.txt"
    table.write_text("\n".join(lines))
    along = {row[0]: np.array(row[2:5], float) * 1e3 for row in rows if row[1] == "0"}
    seed, onward = along[str(START)], along[str(START + 1)]
    laid = {"origin": seed, "angle": 0.0, "pitch": 12.5, "reference": onward - seed}
    return gd.read_surface(part, unit="m"), table, laid


def _read(table, spacing):
    columns = {"i": "warp course", "j": "weft course", "x": "X [m]", "y": "Y [m]", "z": "Z [m]", "shear": "angle"}
    return gd.read_measurement(table, columns=columns, unit="m", mark_spacing=spacing, mark_origin=(START, 0))


def test_the_mirrored_weft_is_noticed(case):
    surface, table, laid = case
    c = gd.compare(surface, _read(table, (12.5, 12.5)), **laid, smooth=False)
    assert any("v runs the other way" in warning for warning in c.warnings)


def test_with_the_weft_turned_the_tools_agree(case):
    from dataclasses import replace

    surface, table, laid = case
    m = _read(table, (12.5, 12.5))
    c = gd.compare(surface, replace(m, v=-m.v, shear=-m.shear), **laid, smooth=False)
    assert not any("looks as if" in warning for warning in c.warnings)
    assert c.used.mean() > 0.97
    assert c.scores.position.rms < 0.2
    assert c.scores.shear.rms < 0.2
    assert np.abs(c.parts[c.used, 2]).max() < 0.1  # both lie on the mould


def test_without_its_numbers_the_nodes_are_found_on_the_drape(case):
    from dataclasses import replace

    surface, table, laid = case
    m = _read(table, (12.5, 12.5))
    c = gd.compare(surface, replace(m, u=None, v=None, shear=-m.shear), **laid, smooth=False)
    assert c.used.mean() > 0.95
    away = np.hypot(c.matched.u - m.u, c.matched.v + m.v)[c.used]
    assert np.percentile(away, 95) < 0.5
    assert c.scores.shear.robust_rms < 0.2
