"""`geomdrap drape --roll-width`."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result

from geomdrap.cli.summary import _roll
from geomdrap.export.report_json import roll_as_dict
from geomdrap.fields.strips import Roll, RollStrip

SADDLE = Path(__file__).parents[2] / "samples" / "parts" / "saddle.stl"
DRAPE = ("drape", SADDLE, "--pitch", "15")


def test_strips_and_seams_are_told_in_the_summary_and_in_drape_json(run: Callable[..., Result]) -> None:
    done = run(*DRAPE, "--roll-width", "120", "--seam-overlap", "10", "--outputs", "json", "-o", "out", "-q", "--json")
    assert done.exit_code == 0, done.output
    roll = json.loads(done.stdout)["roll"]
    assert roll == json.loads(Path("out/drape.json").read_text(encoding="utf-8"))["roll"]
    assert (roll["width"], roll["overlap"]) == (120.0, 10.0)
    assert len(roll["seams"]) == len(roll["strips"]) - 1 > 0
    words = run(*DRAPE, "--roll-width", "120", "--seam-overlap", "10", "--outputs", "none").stdout
    assert f"120 mm wide: {len(roll['strips'])} strips, {roll['length']:.1f} mm used" in words
    assert words.count("seam at v = ") == len(roll["seams"])


def test_a_strip_of_loose_pieces_is_said_to_be_one() -> None:
    arms = tuple(np.array([[x, 0], [x + 30, 0], [x + 30, 60], [x, 60]], float) for x in (0, 60))
    roll = Roll(60.0, 0.0, (RollStrip((0.0, 60.0), (0.0, 90.0), arms),), ())
    assert roll_as_dict(roll)["strips"][0]["pieces"] == 2
    assert "strip 1 is of 2 loose pieces; the gaps between them count as used" in [words for _, words in _roll(roll)]


def test_a_roll_as_wide_as_the_pattern_is_said_to_need_no_seam(run: Callable[..., Result]) -> None:
    done = run(*DRAPE, "--roll-width", "5000", "--outputs", "none")
    assert done.exit_code == 0
    assert "5000 mm wide: one strip, no seam" in done.stdout


def test_each_ply_of_a_stack_is_laid_from_strips_of_its_own(run: Callable[..., Result]) -> None:
    stack = (*DRAPE, "--plies", "0,45", "--roll-width", "250", "-o", "stack")
    done = run(*stack, "--outputs", "json,cut", "-q", "--json")
    assert done.exit_code == 0, done.output
    rolls = [ply["roll"] for ply in json.loads(done.stdout)["plies"]]
    assert [len(roll["strips"]) for roll in rolls] == [2, 2]
    assert rolls[0]["seams"][0]["length"] < rolls[1]["seams"][0]["length"]
    assert "STRIP2" in Path("stack/ply-2/cut.dxf").read_text(encoding="utf-8")
    used = sum(roll["length"] for roll in rolls)
    words = run(*DRAPE, "--plies", "0,45", "--roll-width", "250", "--outputs", "none").stdout
    assert f"strips of a roll 250 mm wide: 2, 2; {used:.1f} mm used" in words


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (("--roll-width", "0"), "0 is not a finite number above 0"),
        (("--roll-width", "-3"), "-3 is not a finite number above 0"),
        (("--roll-width", "nan"), "nan is not a finite number above 0"),
        (("--roll-width", "9"), "a roll 9 mm wide is narrower than the pitch of 15 mm"),
        (("--roll-width", "100", "--seam-overlap", "90"), "an overlap of 90 mm leaves less of a roll 100 mm wide"),
        (("--roll-width", "100", "--seam-overlap", "-1"), "-1 is not a finite number of at least 0"),
        (("--seam-overlap", "5"), "--seam-overlap is of strips of a roll: give --roll-width, too"),
        (("--seam-overlap", "5", "--plies", "0,90"), "give --roll-width, too"),
        (("--roll-width", "9", "--plies", "0,90"), "a roll 9 mm wide is narrower than the pitch of 15 mm"),
    ],
)
def test_a_roll_that_cannot_be_is_refused_in_one_sentence(
    error_of: Callable[..., str], options: tuple[str, ...], words: str
) -> None:
    assert words in error_of(*DRAPE, "--outputs", "none", *options)
    assert not Path("drape").exists()
