"""``geomdrap blind``: make, solve, reveal."""

from __future__ import annotations

import json

import pytest
from click.testing import CliRunner

from geomdrap.blind import draw, files, unseal
from geomdrap.cli import blind as commands
from geomdrap.cli import cli


def run(*arguments):
    done = CliRunner().invoke(cli, ["blind", *map(str, arguments)])
    return done.exit_code, done.stdout, done.stderr


class Found:
    """A diagnosis with a given verdict."""

    def __init__(self, verdict):
        self.verdict = verdict

    def as_dict(self):
        return {"verdict": self.verdict, "candidates": [self.verdict], "confidence": 0.9, "effects": []}


def test_choices_offered_are_those_of_the_simulator():
    assert draw.PLACEMENTS == commands.PLACEMENTS
    assert tuple(files.COLUMNS) == commands.COLUMNS


def test_make_prints_the_seal_and_not_the_truth(tmp_path):
    code, out, _ = run("make", "--effect", "weave-skew", "--seed", 1, "-o", tmp_path / "set", "--json")
    assert code == 0
    made = json.loads(out)
    assert made["seal"] == (tmp_path / "set" / "seal.txt").read_text().strip()
    assert "skew" not in out


def test_a_set_without_a_seed_is_another_each_time(tmp_path):
    run("make", "--effect", "none", "-o", tmp_path / "a")
    run("make", "--effect", "none", "-o", tmp_path / "b")
    assert unseal(tmp_path / "a")["seed"] != unseal(tmp_path / "b")["seed"]


@pytest.mark.parametrize(("verdict", "exit_code"), [("weave-skew", 0), ("slip", 1)])
def test_reveal_after_solve_exits_by_whether_the_verdict_was_right(tmp_path, monkeypatch, verdict, exit_code):
    import geomdrap as gd

    run("make", "--effect", "weave-skew", "--seed", 1, "-o", tmp_path)
    monkeypatch.setattr(gd, "diagnose", lambda surface, measurement, **laid: Found(verdict), raising=False)
    code, out, _ = run("solve", tmp_path)
    assert code == 0
    assert verdict in out
    code, out, _ = run("reveal", tmp_path)
    assert code == exit_code
    assert "hidden  weave-skew" in out
    code, out, _ = run("reveal", tmp_path, "--json")
    assert (code, json.loads(out)["verdict"]) == (exit_code, verdict)


def test_an_unsolved_set_is_revealed_only_anyway(tmp_path):
    run("make", "--effect", "none", "--seed", 1, "-o", tmp_path)
    code, _, err = run("reveal", tmp_path)
    assert code == 2
    assert "not solved" in err
    code, out, _ = run("reveal", tmp_path, "--anyway")
    assert code == 0
    assert "hidden  none" in out
    assert "since" not in out
    with (tmp_path / "measured.csv").open("a") as table:
        table.write("# one line more\n")
    assert "since   measured.csv changed after sealing" in run("reveal", tmp_path, "--anyway")[1]
    code, _, err = run("solve", tmp_path)
    assert code == 2
    assert "revealed" in err


def test_a_new_set_in_an_old_folder_is_not_solved(tmp_path, monkeypatch):
    import geomdrap as gd

    monkeypatch.setattr(gd, "diagnose", lambda surface, measurement, **laid: Found("none"), raising=False)
    run("make", "--effect", "none", "-o", tmp_path)
    run("solve", tmp_path)
    _, out, err = run("make", "--effect", "none", "-o", tmp_path, "--json")
    assert json.loads(out)["removed"] == ["solved.json"]
    assert "solved.json" in err
    assert run("reveal", tmp_path)[0] == 2


def test_bad_input_is_one_line(tmp_path):
    code, _, err = run("make", "--effect", "gremlins", "-o", tmp_path / "set")
    assert code == 2
    assert len(err.strip().splitlines()) == 1
    code, _, err = run("solve", tmp_path)
    assert code == 2
    assert "seal.txt" in err


@pytest.mark.slow
@pytest.mark.parametrize("effect", ["none", "weave-skew"])
def test_a_plain_set_is_solved_right_by_the_product_itself(tmp_path, effect):
    made = ["--effect", effect, "--seed", 1, "--scatter", 0, "--outliers", 0, "--placement", "right"]
    run("make", *made, "-o", tmp_path)
    assert run("solve", tmp_path, "-q")[0] == 0
    assert run("reveal", tmp_path)[0] == 0


def test_reveal_gives_the_interval_of_what_was_seen_and_no_number_for_the_rest() -> None:
    from geomdrap.cli.blind import _found

    row = {"found": 2.99, "sigma": 0.01, "unit": "deg"}
    assert _found(row) == "found 2.99 ± 0.02 deg (95 %)"
    assert _found({**row, "sigma": None}) == "not seen"
    assert _found({**row, "found": None, "sigma": None}) == "not fitted"


def test_reveal_says_which_values_are_wrong_and_what_has_changed(tmp_path, monkeypatch):
    import geomdrap as gd

    class Off(Found):
        def as_dict(self):
            skew = {"value": -30.0, "sigma": 0.01, "unit": "deg"}
            return {**super().as_dict(), "effects": [{"name": "weave-skew", "parameters": {"skew": skew}}]}

    run("make", "--effect", "weave-skew", "--seed", 1, "-o", tmp_path)
    true = unseal(tmp_path)["effect"]["weave-skew"]["skew"]
    monkeypatch.setattr(gd, "diagnose", lambda surface, measurement, **laid: Off("weave-skew"), raising=False)
    run("solve", tmp_path)
    (tmp_path / "measured.csv").write_text("x,y,z\n")
    code, out, _ = run("reveal", tmp_path)
    assert code == 0
    both = " and of the other sign" if true > 0.0 else ""
    assert f"found -30 ± 0.02 deg (95 %): the true value is outside it{both}" in out
    assert "since   measured.csv changed after solving" in out
    solved = tmp_path / "solved.json"
    solved.write_text(solved.read_text().replace("-30.0", "3.0"))
    code, _, err = run("reveal", tmp_path)
    assert code == 2
    assert "was edited after it was written" in err
    code, out, _ = run("reveal", tmp_path, "--anyway")
    assert "edited  solved.json" in out


def test_a_verdict_on_a_changed_table_is_not_said_to_be_on_what_was_sealed(tmp_path, monkeypatch):
    import geomdrap as gd

    monkeypatch.setattr(gd, "diagnose", lambda surface, measurement, **laid: Found("none"), raising=False)
    run("make", "--effect", "none", "--seed", 1, "-o", tmp_path)
    table = tmp_path / "measured.csv"
    sealed = table.read_bytes()
    table.write_bytes(sealed + b"\n")
    run("solve", tmp_path)
    table.write_bytes(sealed)
    _, out, _ = run("reveal", tmp_path, "--anyway")
    assert "changed measured.csv: not what was sealed, so nothing is graded" in out
    assert "since   measured.csv changed after solving\n" in out
    assert "the verdict is on what was sealed" not in out
