"""`geomdrap diagnose` and `geomdrap improve` from end to end, and the better model used again."""

from __future__ import annotations

import json
from functools import partial
from pathlib import Path

import pytest
from click.testing import CliRunner

import geomdrap as gd
from geomdrap.blind import make
from geomdrap.cli import cli

OWN = """
import geomdrap as gd
from dataclasses import replace


class Shrinkage(gd.Effect):
    name = "shrinkage"
    summary = "Yarns shrink."
    stage = "fabric"
    parameters = (gd.Parameter("strain", "", 0.0, 0.05, 0.004, 0.0, "share by which yarns shrink"),)

    def on_fabric(self, fabric):
        return replace(fabric, strain_warp=fabric.strain_warp - self.values["strain"])
"""


@pytest.fixture(scope="module")
def ply(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make(3, effect="weave-skew", part="saddle", points=90, folder=tmp_path_factory.mktemp("ply"))


def run(command: str, ply: Path, *more: str) -> dict:
    asked = [command, str(ply / "part.stl"), str(ply / "measured.csv"), "--setup", str(ply / "setup.toml"), "--json"]
    result = CliRunner().invoke(cli, [*asked, *more], catch_exceptions=False)
    assert result.exit_code == 0, result.output
    return json.loads(result.stdout)


@pytest.mark.slow
def test_what_improve_finds_takes_the_error_of_compare_to_the_noise(ply: Path, tmp_path: Path) -> None:
    model = tmp_path / "model.toml"
    found = run("improve", ply, "-o", str(model))
    assert found["schema"] == "geomdrap.improve/1"
    assert found["verdict"] == "weave-skew"
    assert [step["added"] for step in found["steps"]] == [None, "placement", "weave-skew"]
    assert {name: list(values) for name, values in found["sigma"].items()} == {
        name: list(values) for name, values in found["parameters"].items()
    }
    assert 0.0 < found["sigma"]["weave-skew"]["skew"] < 0.2
    assert found["confidence"] > 0.9
    assert (tmp_path / "improve.png").stat().st_size > 10_000
    before, after = (
        run("compare", ply, "--outputs", "none"),
        run("compare", ply, "--outputs", "none", "--model", str(model)),
    )
    assert before["chi2_per_dof"] > 3.0
    assert after["chi2_per_dof"] == pytest.approx(1.0, abs=0.2)


@pytest.mark.slow
def test_diagnose_tries_effects_of_the_users_own(ply: Path, tmp_path: Path) -> None:
    plugin = tmp_path / "own.py"
    plugin.write_text(OWN)
    found = run("diagnose", ply, "-o", str(tmp_path / "d"), "--plugin", str(plugin))
    assert found["verdict"] == "weave-skew"
    assert "shrinkage" in [effect["name"] for effect in found["effects"]]
    assert {"diagnose.json", "diagnose.png"} <= {path.name for path in (tmp_path / "d").iterdir()}


def test_files_of_an_earlier_diagnosis_are_warned_of(
    ply: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(gd, "diagnose", partial(gd.diagnose, effects=("weave-skew",)))
    (tmp_path / "diagnose.png").write_bytes(b"old")
    asked = ["diagnose", str(ply / "part.stl"), str(ply / "measured.csv"), "--setup", str(ply / "setup.toml")]
    result = CliRunner().invoke(cli, [*asked, "-o", str(tmp_path), "--outputs", "json"])
    assert f"diagnose.png in {tmp_path} is of an earlier run: remove it" in result.stderr


@pytest.mark.slow
@pytest.mark.parametrize("command", ["diagnose", "improve"])
def test_swapped_labels_are_warned_of_even_quietly(
    ply: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, command: str
) -> None:
    few = partial(getattr(gd, command), effects=("weave-skew",))  # what is tried makes no difference here
    monkeypatch.setattr(gd, command, few)
    head, *rows = (ply / "measured.csv").read_text().splitlines()
    names = {"u": "v", "v": "u"}
    swapped = tmp_path / "swapped.csv"
    swapped.write_text("\n".join([",".join(names.get(n, n) for n in head.split(",")), *rows]))
    where = {"diagnose": ["--outputs", "none"], "improve": ["-o", str(tmp_path / "m.toml")]}[command]
    asked = [command, str(ply / "part.stl"), str(swapped), "--setup", str(ply / "setup.toml"), "--json", "-q"]
    result = CliRunner().invoke(cli, [*asked, *where], catch_exceptions=False)
    assert result.exit_code == 0
    assert result.stderr.startswith("Warning: swapped.csv: it looks as if u and v are swapped")
    assert "swapped" in json.loads(result.stdout)["warnings"][0]
    assert not any("swapped" in note for note in json.loads(result.stdout)["notes"])


def test_a_model_file_that_is_no_toml_is_refused(ply: Path) -> None:
    asked = ["improve", str(ply / "part.stl"), str(ply / "measured.csv"), "-o", "model.txt"]
    result = CliRunner().invoke(cli, asked)
    assert result.exit_code == 2
    assert "ends in .toml" in result.output
