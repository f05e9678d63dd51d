"""`geomdrap drape --outputs cut,pdf`."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

from click.testing import Result

PART = Path(__file__).parents[2] / "samples" / "parts" / "saddle.stl"


def test_files_for_the_cutting_table_are_written_on_request_only(run: Callable[..., Result]) -> None:
    pages = {}
    for paper in ("A4", "a3"):
        done = run("drape", PART, "--pitch", "15", "--outputs", "cut,pdf", "--paper", paper, "-o", paper, "-q")
        assert (done.exit_code, done.stderr) == (0, "")
        assert sorted(f.name for f in Path(paper).iterdir()) == ["cut.dxf", "cut.pdf"]
        pages[paper] = Path(paper, "cut.pdf").read_bytes().count(b"/MediaBox")
    assert pages["A4"] > pages["a3"] > 1
