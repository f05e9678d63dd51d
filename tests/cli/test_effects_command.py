"""``geomdrap effects``, and effects on the command line of ``drape``."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from click.testing import CliRunner

import geomdrap as gd
from geomdrap.cli import cli
from geomdrap.effects import registry
from geomdrap.effects.registry import LIBRARY

PLUGIN = Path(__file__).parents[2] / "samples" / "my_effect.py"


@pytest.fixture(autouse=True)
def _nothing_stays_registered(monkeypatch):
    monkeypatch.setattr(registry, "_REGISTERED", {})


@pytest.fixture
def part(tmp_path):
    return gd.surface.samples.write("hemisphere", tmp_path, 2000)[0]


def run(*arguments):
    return CliRunner().invoke(cli, [str(a) for a in arguments], prog_name="geomdrap")


def test_the_table_names_all_effects_with_their_units():
    lines = run("effects").stdout.splitlines()
    assert [line.split()[0] for line in lines] == list(LIBRARY)
    assert "curvature_warp [1/m], curvature_weft [1/m]" in "\n".join(lines)


def test_a_page_tells_physics_equation_bounds_and_source():
    text = run("effects", "slip").stdout
    for word in ("physics", "equation", "source", "looks like", "0 to 1, typical 0.3"):
        assert word in text


def test_json_holds_the_same():
    document = json.loads(run("effects", "thickness", "--json").stdout)
    assert document["schema"] == "geomdrap.effects/1"
    (effect,) = document["effects"]
    assert effect["parameters"][0]["unit"] == "mm"
    assert len(json.loads(run("effects", "--json").stdout)["effects"]) == len(LIBRARY)


def test_a_picture_of_the_signature_is_written(tmp_path):
    done = run("effects", "weave-skew:skew=3", "-o", tmp_path / "new")
    assert done.exit_code == 0, done.output
    assert (tmp_path / "new" / "signature-weave-skew.png").stat().st_size > 20_000


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["effects", "slide"], "there is no effect 'slide'; the effects are"),
        (["effects", "-o", "x"], "give its NAME"),
        (["effects", "--plugin", "missing.py"], "missing.py: there is no such file"),
        (["effects", "locking:angle=abc"], "is not PARAMETER=NUMBER"),
        (["effects", "locking:angle=-5"], "-5"),
        (["effects", "locking:foo=3"], "foo"),
        (["effects", "locking:angle=90", "-o", "x"], "does nothing, so nothing can be drawn"),
    ],
)
def test_what_cannot_be_done_is_said_in_one_line(arguments, words):
    done = run(*arguments)
    assert done.exit_code == 2
    assert words in done.stderr
    assert len(done.stderr.splitlines()) == 1


def test_drape_says_which_effects_acted(part, tmp_path):
    model = tmp_path / "model.toml"
    gd.effects.write_model(model, [gd.effects.make("placement", du=1.5)])
    chosen = [
        "--plugin",
        PLUGIN,
        "--effect",
        "oven-shrinkage:strain=0.01",
        "--effect",
        "slip:coefficient=0.2",
        "--model",
        model,
    ]
    done = run("drape", part, "--pitch", 12, *chosen, "--outputs", "none", "--json")
    assert done.exit_code == 0, done.output
    acted = {e["name"]: e["values"] for e in json.loads(done.stdout)["effects"]}
    assert acted == {
        "placement": {"du": 1.5, "dv": 0.0, "dangle": 0.0},
        "oven-shrinkage": {"strain": 0.01},
        "slip": {"coefficient": 0.2},
    }


def test_a_drape_without_effects_says_so(part):
    assert json.loads(run("drape", part, "--pitch", 12, "--outputs", "none", "--json").stdout)["effects"] == []


@pytest.mark.parametrize(
    ("option", "words"),
    [
        (["--effect", "slip:coefficient=2"], "coefficient must be a number from 0 to 1"),
        (["--effect", "slip=2"], "there is no effect 'slip=2'"),
        (["--effect", "shear-stifness"], "there is no effect 'shear-stifness' (is shear-stiffness meant?)"),
        (["--model", "missing.toml"], "missing.toml cannot be read"),
    ],
)
def test_effects_that_cannot_be_meant_end_in_one_line(part, option, words):
    done = run("drape", part, *option)
    assert done.exit_code == 2
    assert words in done.stderr


def test_the_sample_plugin_shrinks_the_net(part):
    surface = gd.read_surface(part)
    gd.effects.load_plugin(PLUGIN)
    plain, shrunk = (
        gd.drape(surface, pitch=10.0, effects=e) for e in ([], [gd.effects.make("oven-shrinkage", strain=0.02)])
    )
    ends = [net.interpolate([50.0], [0.0])[0][0] - net.origin for net in (plain, shrunk)]
    assert (ends[1] ** 2).sum() < (ends[0] ** 2).sum()
    assert shrunk.sides[0].max() == pytest.approx(9.8)


def test_a_model_drapes_the_ply_that_it_was_fitted_to_unless_told_otherwise(run, tmp_path):
    run("sample", "saddle")
    (tmp_path / "model.toml").write_text(
        'format = "geomdrap.model/1"\n[layup]\norigin = [10.0, -5.0, 0.0]\nangle = 20.0\n'
        '[[effect]]\nname = "yarn-extension"\nstrain_warp = 0.01\nstrain_weft = 0.0\n'
    )
    options = ("--pitch", "15", "--outputs", "json", "--json", "--project", "--model", "model.toml")
    own = run("drape", "saddle.stl", *options)
    drape = json.loads(own.stdout)
    assert drape["angle"] == 20.0
    assert drape["origin"][:2] == pytest.approx([10.0, -5.0], abs=0.5)
    assert "origin and angle of the ply are those of model.toml" in own.stderr
    told = json.loads(run("drape", "saddle.stl", "--angle", "45", *options).stdout)
    assert told["angle"] == 45.0
    assert told["origin"] == drape["origin"]


def test_a_model_of_a_relaxed_net_is_drawn_with_its_pitch_and_held_over_its_length(run, tmp_path):
    run("sample", "saddle")
    text = 'format = "geomdrap.model/1"\n[layup]\nangle = 20.0\npitch = 12.0\n%s[[effect]]\nname = "shear-stiffness"\nratio = 0.001\n'
    (tmp_path / "model.toml").write_text(text % "held = 24.0\n")
    (tmp_path / "short.toml").write_text(text % "")
    drapes = {}
    for model in ("model.toml", "short.toml"):
        drapes[model] = run("drape", "saddle.stl", "--outputs", "json", "--json", "--model", model)
    both = [json.loads(drape.stdout) for drape in drapes.values()]
    assert [one["pitch"] for one in both] == [12.0, 12.0]
    assert both[0]["effects"][-1]["name"] == "held-warp"
    assert "its heading held over 24 mm" in drapes["model.toml"].stderr
    assert "held over" not in drapes["short.toml"].stderr
    assert "angle and pitch of the ply are those of model.toml" in drapes["model.toml"].stderr
    told = json.loads(
        run("drape", "saddle.stl", "--pitch", "15", "--outputs", "json", "--json", "--model", "model.toml").stdout
    )
    assert told["pitch"] == 15.0


def test_a_comparison_takes_the_ply_of_a_model_unless_told_otherwise(run, tmp_path):
    run("sample", "saddle")
    surface = gd.read_surface(tmp_path / "saddle.stl")
    net = gd.drape(surface, (10.0, -5.0, 0.0), 20.0, 15.0, project=True)
    u, v = (a.ravel() for a in np.meshgrid(np.arange(-45.0, 46.0, 15.0), np.arange(-45.0, 46.0, 15.0)))
    points, _ = net.interpolate(u, v)
    rows = np.column_stack([points, u, v])[np.isfinite(points[:, 0])]
    np.savetxt(tmp_path / "marks.csv", rows, delimiter=",", header="x,y,z,u,v", comments="", fmt="%.6f")
    origin = ", ".join(f"{x:.6f}" for x in net.origin)
    (tmp_path / "model.toml").write_text(
        f'format = "geomdrap.model/1"\n[layup]\norigin = [{origin}]\nangle = 20.0\n[[effect]]\nname = "slip"\ncoefficient = 0.01\n'
    )
    found = run(
        "compare",
        "saddle.stl",
        "marks.csv",
        "--model",
        "model.toml",
        "--sigma-xyz",
        "0.2",
        "--outputs",
        "none",
        "--json",
    )
    assert json.loads(found.stdout)["position"]["rms"] < 0.5
    assert "origin and angle of the ply are those of model.toml" in found.stderr
    other = run(
        "compare", "saddle.stl", "marks.csv", "--model", "model.toml", "--angle", "35", "--outputs", "none", "--json"
    )
    assert json.loads(other.stdout)["position"]["rms"] > 2.0
    assert "origin of the ply is that of model.toml" in other.stderr


def test_an_effect_given_twice_is_refused(error_of, run, tmp_path):
    run("sample", "hemisphere", "-o", ".")
    slip = ("--effect", "slip:coefficient=0.5")
    plain = ("drape", "hemisphere.stl", "--outputs", "none")
    said = error_of(*plain, *slip, "--effect", "slip:coefficient=0.2")
    assert said == "effect slip is given more than once (--effect): give it once, with all its values"
    (tmp_path / "m.toml").write_text('format = "geomdrap.model/1"\n[[effect]]\nname = "slip"\ncoefficient = 0.2\n')
    assert "slip is given more than once (--effect and the model m.toml)" in error_of(*plain, *slip, "--model", "m.toml")


def test_an_origin_of_a_model_that_lies_off_the_part_is_said_to_be_the_models(error_of, run, tmp_path):
    run("sample", "hemisphere", "-o", ".")
    text = 'format = "geomdrap.model/1"\n[layup]\norigin = [0.0, 0.0, 500.0]\nangle = 0.0\n'
    (tmp_path / "m.toml").write_text(text)
    (tmp_path / "t.csv").write_text("x,y,z\n0,0,100\n50,0,86.6\n")
    for command in (("drape", "hemisphere.stl"), ("compare", "hemisphere.stl", "t.csv")):
        said = error_of(*command, "--model", "m.toml", "--outputs", "none", "-q")
        assert said.startswith("model m.toml: the origin lies ")
        assert said.endswith("or give another --origin")
        own = error_of(*command, "--model", "m.toml", "--outputs", "none", "-q", "--origin", "0,0,600")
        assert own.startswith("the origin lies")
