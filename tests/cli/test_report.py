"""`geomdrap drape` writes report.html with the command that made it."""

from __future__ import annotations

import html
import re
import shlex
from collections.abc import Callable
from pathlib import Path

from click.testing import Result

PART = Path(__file__).parents[2] / "samples" / "parts" / "saddle.stl"


def test_the_report_shows_the_command_as_it_can_be_typed_again(run: Callable[..., Result]) -> None:
    Path("my parts").mkdir()
    part = Path("my parts/saddle.stl")
    part.write_bytes(PART.read_bytes())
    words = ["drape", str(part), "--angle", "30", "--pitch", "15", "--outputs", "html", "-o", "out", "-q"]
    assert run(*words).exit_code == 0
    text = Path("out/report.html").read_text(encoding="utf-8")
    found = re.search(r'<code id="command">(.*?)</code>', text)
    assert found
    assert shlex.split(html.unescape(found[1])) == ["geomdrap", *words]
