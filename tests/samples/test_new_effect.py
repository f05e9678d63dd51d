"""The story of a new effect: unknown before, named after, with the value that was hidden."""

from __future__ import annotations

from pathlib import Path

import pytest

import geomdrap as gd
from geomdrap.blind import make, unseal

SAMPLES = Path(__file__).parents[2] / "samples"
RIVALS = ("thickness", "yarn-extension", "tension-gradient")


@pytest.fixture(scope="module")
def warm(tmp_path_factory):
    """The set of the story: its truth, and the keywords of ``diagnose``."""
    folder = make(6000, effect="heat-growth", part="valley", folder=tmp_path_factory.mktemp("warm"))
    setup = gd.read_setup(folder / "setup.toml")
    told = {name: getattr(setup, name) for name in ("origin", "angle", "sigma_xyz", "sigma_shear")}
    surface, measurement = gd.read_surface(folder / "part.stl"), gd.read_measurement(folder / "measured.csv")
    return unseal(folder), {"surface": surface, "measurement": measurement, **told}


def test_without_the_new_effect_the_cause_is_unknown(warm):
    d = gd.diagnose(**warm[1], effects=RIVALS)
    assert d.verdict == "unknown"
    assert d.steps[-1].error > 1.15


def test_with_it_the_cause_is_named_and_the_error_falls_to_the_noise(warm):
    truth, told = warm
    gd.effects.load_plugin(SAMPLES / "heat_growth.py")
    d = gd.diagnose(**told, effects=(*RIVALS, "heat-growth"))
    assert d.verdict == "heat-growth"
    assert d.steps[-1].cv_error < 1.05
    (strain,) = next(t for t in d.tried if t.selected).values
    low, high = strain.interval
    assert low < truth["effect"]["heat-growth"]["strain"] < high


def test_the_story_names_files_that_are_there():
    story = (SAMPLES / "new_effect.md").read_text(encoding="utf-8")
    for name in ("heat_growth.py", "pictures/new-effect-residuals.png", "pictures/new-effect-improved.png"):
        assert f"({name})" in story
        assert (SAMPLES / name).is_file()


def test_a_drape_with_it_has_as_much_fabric_as_it_covers(warm):
    """The net has grown with the part, and says so by its points alone: it was warned of too little fabric."""
    gd.effects.load_plugin(SAMPLES / "heat_growth.py")
    told = warm[1]
    grown = gd.effects.make("heat-growth", strain=0.0078)
    net = gd.drape(told["surface"], told["origin"], told["angle"], effects=[grown], project=True)
    assert not any("less than" in warning for warning in gd.evaluate(net).warnings)
