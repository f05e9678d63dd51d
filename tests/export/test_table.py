"""nodes.csv."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
from square_ply import square_ply

from geomdrap.export import table
from geomdrap.fishnet import Status


def _rows(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(text.splitlines()))


def test_the_first_rows_are_these_to_the_letter() -> None:
    lines = table.as_text(square_ply().net).split("\n")
    assert lines[0] == "i,j,u,v,x,y,z,shear,status"
    assert lines[1] == "-2,-2,-20.000000,-20.000000,-20.000000,-20.000000,0.000000,-2.000000,present"
    assert lines[25] == "2,2,20.000000,20.000000,,,,,off the part"
    assert lines[26:] == [""]


def test_numbers_come_back_to_the_sixth_decimal() -> None:
    net = square_ply(cells=6, pitch=1 / 3).net
    net.shear[0, 0] = -12.3456789
    rows = _rows(table.as_text(net))
    assert len(rows) == net.status.size
    for row in rows[:-1]:
        i, j = int(row["i"]) + 3, int(row["j"]) + 3
        read = [float(row[name]) for name in ("u", "v", "x", "y", "z", "shear")]
        exact = [net.u[i], net.v[j], *net.points[i, j], net.shear[i, j]]
        np.testing.assert_allclose(read, exact, rtol=0, atol=0.5000001e-6)


def test_zero_has_no_sign() -> None:
    net = square_ply().net
    net.points[0, 0] = [-1e-9, -0.0, 1e-9]
    assert "-0.000000" not in table.as_text(net)


def test_nodes_that_no_yarn_leads_to_have_no_row() -> None:
    net = square_ply().net
    net.status[-1, -1] = Status.UNREACHED
    assert len(_rows(table.as_text(net))) == 24


def test_a_node_without_shear_leaves_the_column_empty() -> None:
    net = square_ply().net
    net.shear[0, 0] = np.nan
    first = _rows(table.as_text(net))[0]
    assert (first["x"], first["shear"], first["status"]) == ("-20.000000", "", "present")


def test_every_reason_survives_a_csv_reader() -> None:
    net = square_ply().net
    for status in Status:
        if status not in (Status.UNREACHED, Status.PRESENT):
            net.status[-1, -1] = status
            assert _rows(table.as_text(net))[-1]["status"] == status.reason


def test_the_same_net_gives_the_same_bytes_with_unix_line_ends(tmp_path: Path) -> None:
    for name in ("a.csv", "b.csv"):
        table.write(square_ply(), tmp_path / name)
    raw = (tmp_path / "a.csv").read_bytes()
    assert raw == (tmp_path / "b.csv").read_bytes()
    assert b"\r" not in raw
