"""What `geomdrap drape` prints, writes and returns; the drape itself is made up here."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from click.testing import Result
from square_ply import square_ply

import geomdrap.cli.drape as drape_module
from geomdrap.export.outputs import OUTPUTS

Run = Callable[..., Result]
SOME = "--outputs", "json,csv,vtu"


@pytest.fixture
def asked(monkeypatch: pytest.MonkeyPatch) -> dict[str, Any]:
    """Replace the computation; what it was asked for is in the dictionary."""
    said: dict[str, Any] = {"result": square_ply()}

    def compute(progress: object, before_drape: object, **options: Any) -> SimpleNamespace:
        said.update(options)
        return said["result"]

    monkeypatch.setattr(drape_module, "compute", compute)
    return said


def test_options_arrive_as_values(run: Run, asked: dict[str, Any], tmp_path: Path) -> None:
    (tmp_path / "m.toml").write_text('format = "geomdrap.model/1"\n')
    result = run(
        *(
            "drape",
            "a.stl",
            "--origin",
            "-5,5,84.4",
            "--angle",
            "-45",
            "--pitch",
            "2.5",
            "--reference",
            "0,1,0",
        ),
        *(
            "--blank",
            "400x300",
            "--limit-angle",
            "40",
            "--unit",
            "m",
            "--tolerance",
            "0.1",
            "--flip",
            "--project",
        ),
        *("--cut", "slit.csv", "--cut", "dart.csv", "--roll-width", "1270", "--seam-overlap", "25"),
        *("--effect", "slip:coefficient=0.2", "--effect", "bridging:radius=9", "--model", "m.toml", "--plugin", "p.py"),
        *SOME,
    )
    assert result.exit_code == 0, result.stderr
    asked.pop("result")
    assert asked == {
        "cuts": (Path("slit.csv"), Path("dart.csv")),
        "roll_width": 1270.0,
        "seam_overlap": 25.0,
        "part": Path("a.stl"),
        "origin": (-5.0, 5.0, 84.4),
        "angle": -45.0,
        "pitch": 2.5,
        "reference": (0.0, 1.0, 0.0),
        "blank": (400.0, 300.0),
        "warp_guide": None,
        "weft_guide": None,
        "limit_angle": 40.0,
        "unit": "m",
        "tolerance": 0.1,
        "flip": True,
        "project": True,
        "effect_texts": ("slip:coefficient=0.2", "bridging:radius=9"),
        "model": Path("m.toml"),
        "plugins": (Path("p.py"),),
    }


def test_without_options_the_library_decides(run: Run, asked: dict[str, Any]) -> None:
    run("drape", "a.stl", *SOME)
    assert (asked["origin"], asked["angle"], asked["unit"]) == ("centroid", 0.0, "mm")
    for name in ("pitch", "reference", "blank", "limit_angle", "tolerance"):
        assert asked[name] is None


def test_files_go_to_the_folder_drape_unless_told_otherwise(run: Run, asked: dict[str, Any]) -> None:
    run("drape", "a.stl", *SOME)
    names = ["drape.json", "net.vtu", "nodes.csv", "part.vtu"]
    assert sorted(file.name for file in Path("drape").iterdir()) == names
    run("drape", "a.stl", *SOME, "-o", "deep/er")
    assert sorted(file.name for file in Path("deep/er").iterdir()) == names


def test_no_files_are_written_if_none_are_wanted(run: Run, asked: dict[str, Any]) -> None:
    assert run("drape", "a.stl", "--outputs", "none").exit_code == 0
    assert not list(Path().iterdir())


def test_a_folder_for_no_files_is_a_contradiction(
    error_of: Callable[..., str], asked: dict[str, Any]
) -> None:
    assert "--outputs none" in error_of("drape", "a.stl", "--outputs", "none", "-o", "x")


def test_json_is_all_of_stdout(run: Run, asked: dict[str, Any]) -> None:
    result = run("drape", "a.stl", "--json", *SOME, "-o", "out")
    document = json.loads(result.stdout)
    assert document["schema"] == "geomdrap.drape/1"
    assert document["files"]["csv"] == str(Path("out/nodes.csv"))
    assert result.stderr == "Warning: a warning\nNote: pitch 10 mm was chosen\n"


def test_json_on_stdout_and_in_the_file_are_the_same_but_for_the_folder(
    run: Run, asked: dict[str, Any]
) -> None:
    printed = json.loads(run("drape", "a.stl", "--json", *SOME, "-o", "out").stdout)
    written = json.loads(Path("out/drape.json").read_text())
    assert written["files"] == {key: Path(name).name for key, name in printed["files"].items()}
    assert {**written, "files": None} == {**printed, "files": None}


def test_the_summary_names_what_matters(run: Run, asked: dict[str, Any]) -> None:
    summary = run("drape", "a.stl", *SOME).stdout
    for fact in (
        "square.stl",
        "2 facets",
        "40 x 40 x 0 mm",
        "warp at 30°",
        "pitch 10 mm",
        "24 nodes",
        "15 cells",
        "max 2.00°",
        "coverage   96.88 %",
        "50.0 mm² at (18.00, 18.00, 0.00): off the part",
        "drape.json",
        "sides too long by 2e-13 of the pitch",
    ):
        assert fact in summary, summary
    assert "nan" not in summary
    assert max(map(len, summary.splitlines())) <= 110


def test_areas_have_one_unit_whatever_their_size(run: Run, asked: dict[str, Any]) -> None:
    asked["result"].area.part, asked["result"].area.fabric = 4.2e6 + 0.25, 0.0123
    line = next(line for line in run("drape", "a.stl", *SOME).stdout.splitlines() if line.startswith("area"))
    assert "part 4,200,000.2 mm², draped 1,550.0 mm², fabric 0.0123 mm²" in line


def test_an_empty_name_is_no_folder_and_no_part(error_of: Callable[..., str]) -> None:
    assert "the name is empty" in error_of("drape", "a.stl", "-o", "")
    assert "the name is empty" in error_of("drape", "")
    assert "the name is empty" in error_of("diff", "", "b")


def test_quiet_leaves_warnings_only(run: Run, asked: dict[str, Any]) -> None:
    result = run("drape", "a.stl", "-q", *SOME)
    assert (result.stdout, result.stderr) == ("", "Warning: a warning\n")


@pytest.mark.parametrize(
    ("coverage", "flags", "code"),
    [(0.97, ["--strict"], 1), (0.97, [], 0), (0.999, ["--strict"], 0)],
)
def test_strict_turns_an_incomplete_drape_into_exit_code_1(
    run: Run, asked: dict[str, Any], coverage: float, flags: list[str], code: int
) -> None:
    asked["result"].area.coverage = coverage
    result = run("drape", "a.stl", *SOME, *flags)
    assert result.exit_code == code
    assert Path("drape/drape.json").exists()


def test_the_folder_is_checked_before_anything_is_computed(
    run: Run, asked: dict[str, Any], error_of: Callable[..., str]
) -> None:
    Path("taken").write_text("a file")
    assert "not a folder" in error_of("drape", "a.stl", "-o", "taken")
    assert "part" not in asked


def test_a_failing_format_leaves_all_earlier_files_untouched(
    run: Run, asked: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    run("drape", "a.stl", *SOME)
    before = {file.name: file.read_bytes() for file in Path("drape").iterdir()}
    asked["result"] = square_ply(cells=6)
    monkeypatch.setattr("geomdrap.export.vtu.write_part", lambda *_: 1 / 0)
    assert run("drape", "a.stl", *SOME).exit_code == 3
    assert {file.name: file.read_bytes() for file in Path("drape").iterdir()} == before


def test_files_that_an_earlier_run_left_in_the_folder_are_named(run: Run, asked: dict[str, Any]) -> None:
    assert "earlier run" not in run("drape", "a.stl", *SOME).stderr
    again = run("drape", "a.stl", "--outputs", "json,csv", "--json", "--quiet")
    words = "net.vtu, part.vtu in drape are of an earlier run: remove them, or use another folder (-o)"
    assert f"Warning: {words}\n" in again.stderr  # quiet or not: whoever reads the folder reads two runs
    assert words in json.loads(again.stdout)["warnings"]
    assert "earlier run" not in Path("drape/drape.json").read_text()  # the same bytes for the same input


def test_files_of_other_programs_in_the_folder_stay(run: Run, asked: dict[str, Any]) -> None:
    Path("drape").mkdir()
    Path("drape/mine.txt").write_text("mine")
    run("drape", "a.stl", *SOME)
    assert Path("drape/mine.txt").read_text() == "mine"


def test_every_output_has_a_key_and_a_file_of_its_own() -> None:
    outputs = [output for group in OUTPUTS.values() for output in group]
    assert len({output.key for output in outputs}) == len({output.file for output in outputs}) == len(outputs)
