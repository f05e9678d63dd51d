"""The base class, the registry, plugins and model files."""

import pickle
from dataclasses import replace
from importlib.metadata import EntryPoint

import numpy as np
import pytest
from shared import drape

import geomdrap as gd
from geomdrap.effects import registry
from geomdrap.surface import shapes

CAP = shapes.sphere_cap(80.0, 50.0, 4.0)
TOP = (4.0, -3.0, 79.8)
NAMES = {
    "placement": ["du", "dv", "dangle"],
    "yarn-extension": ["strain_warp", "strain_weft"],
    "tension-gradient": ["k_warp", "k_weft"],
    "weave-skew": ["skew"],
    "steering": ["curvature_warp", "curvature_weft"],
    "slip": ["coefficient"],
    "thickness": ["offset"],
    "bridging": ["radius"],
    "shear-stiffness": ["ratio"],
    "locking": ["angle"],
    "springback": ["fraction"],
    "shear-asymmetry": ["alpha"],
    "yarn-bending": ["length"],
    "crossing-slip": ["share", "onset"],
}


@pytest.fixture(autouse=True)
def _nothing_stays_registered(monkeypatch):
    monkeypatch.setattr(registry, "_REGISTERED", {})


def test_the_library_has_the_effects_and_parameters_it_promises():
    assert {n: [p.name for p in e.parameters] for n, e in gd.effects.available().items()} == NAMES


@pytest.mark.parametrize("name", NAMES)
def test_an_effect_says_what_it_is(name):
    effect = gd.effects.find(name)
    assert effect.name == name
    for words in (effect.summary, effect.equation, effect.physics, effect.source, effect.seen_by):
        assert len(words) > 10
    assert effect.summary.endswith(".")
    assert effect.stage in ("surface", "placement", "fabric", "net")
    assert set(effect.confounded_with) <= set(NAMES)
    assert set(effect.includes) <= set(NAMES)
    assert effect.acts_at_once == (name in ("shear-stiffness", "yarn-bending"))
    for p in effect.parameters:
        assert p.low <= p.neutral <= p.high
        assert p.low <= p.typical <= p.high
        assert p.text


@pytest.mark.parametrize("name", NAMES)
def test_a_neutral_effect_changes_nothing_at_all(name):
    plain, neutral = drape(CAP, origin=TOP), drape(CAP, name, origin=TOP)
    np.testing.assert_array_equal(neutral.points, plain.points)
    np.testing.assert_array_equal(neutral.cell_shear, plain.cell_shear)
    np.testing.assert_array_equal(neutral.face, plain.face)
    assert neutral.effects == ()


SHOWS = {
    "locking": {"angle": 10.0},
    "crossing-slip": {"share": 0.2, "onset": 5.0},
}  # typical ones are beyond this part


@pytest.mark.parametrize("name", NAMES)
def test_a_typical_effect_changes_something_and_is_named_by_the_net(name):
    effect = gd.effects.find(name)
    values = SHOWS.get(name, {p.name: p.typical for p in effect.parameters})
    valley = shapes.grid_surface(
        lambda x, y: 0.1 * x**2 + 0.02 * y**2, np.linspace(-20, 20, 41), np.linspace(-20, 20, 41)
    )
    part, origin = (valley, (6.0, 0.0, 3.6)) if name == "bridging" else (CAP, TOP)
    plain = gd.drape(part, origin, 10.0, 6.0, project=True)
    net = gd.drape(part, origin, 10.0, 6.0, effects=[effect(**values)], project=True)
    assert net.effects[0].values == values
    same = plain.points.shape == net.points.shape and np.allclose(plain.points, net.points, atol=1e-6, equal_nan=True)
    assert not same or not np.allclose(plain.shear, net.shear, atol=1e-6, equal_nan=True)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("slip:coefficient=1.5", "coefficient must be a number from 0 to 1"),
        ("thickness:offset=nan", "offset must be a number from -50 to 50 mm"),
        ("slip:coefficient=inf", "from 0 to 1"),
        ("slip:friction=0.1", "slip has no parameter 'friction'; it takes coefficient"),
        ("slipp:coefficient=0.1", "no effect 'slipp' .is slip meant.*; the effects are placement"),
        ("slip:coefficient", "not PARAMETER=NUMBER"),
        ("slip:coefficient=a", "not PARAMETER=NUMBER"),
        ("slip:coefficient=0.1,coefficient=0.2", "not PARAMETER=NUMBER"),
        ("slip", "slip does nothing without a value of coefficient: give one, e.g. slip:coefficient=0.3"),
        ("slip:", "e.g. slip:coefficient=0.3"),
        ("locking", "e.g. locking:angle=40"),
        ("placement", "a value of du or dv or dangle: give one, e.g. placement:du=2"),
        ("crossing-slip:onset=10", "a value of share: give one, e.g. crossing-slip:share=0.15"),
        ("crossing-slip", "a value of share: give one, e.g. crossing-slip:share=0.15"),
    ],
)
def test_what_cannot_be_meant_is_refused_with_a_sentence(text, words):
    with pytest.raises(gd.GeomdrapError, match=words):
        gd.effects.parse(text)


def test_an_effect_that_says_itself_when_it_does_nothing_is_refused_then():
    @gd.effects.register
    class Grip(gd.Effect):
        name = "grip"
        parameters = (gd.Parameter("force", "N", 0.0, 10.0, 2.0, 0.0, "of the clamp"),)

        @property
        def is_neutral(self):
            return self.values["force"] < 1.0

    assert gd.effects.parse("grip:force=2").values == {"force": 2.0}
    with pytest.raises(gd.EffectError, match="grip does nothing without a value of force"):
        gd.effects.parse("grip")
    with pytest.raises(gd.EffectError, match="grip does nothing with these values; give others"):
        gd.effects.parse("grip:force=0.5")


def test_values_are_read_as_written_and_the_rest_is_neutral():
    assert gd.effects.parse(" yarn-extension : strain_warp=1e-2 ").values == {"strain_warp": 0.01, "strain_weft": 0.0}
    assert gd.effects.parse("slip:coefficient=0").values == {"coefficient": 0.0}  # as in a loop over values
    assert gd.effects.make("locking").values == {"angle": 90.0}
    assert gd.effects.make("slip", coefficient=0.6).values == {"coefficient": 0.6}


def test_effects_can_be_sent_to_another_process():
    effect = gd.effects.make("steering", curvature_warp=0.5)
    assert pickle.loads(pickle.dumps(effect)).values == effect.values


def test_a_class_of_three_lines_is_an_effect():
    class Springback(gd.Effect):
        def on_net(self, net):
            return replace(net, shear=0.9 * net.shear, cell_shear=0.9 * net.cell_shear)

    plain, sprung = (gd.drape(CAP, TOP, effects=e, project=True) for e in ([], [Springback()]))
    np.testing.assert_allclose(sprung.shear, 0.9 * plain.shear)


def test_what_is_no_effect_is_refused():
    with pytest.raises(gd.EffectError, match="effects must be objects"):
        gd.drape(CAP, TOP, effects=["slip"], project=True)


def test_the_order_in_which_effects_are_given_makes_no_difference():
    texts = [
        "springback:fraction=0.1",
        "slip:coefficient=0.3",
        "thickness:offset=2",
        "placement:du=2",
        "weave-skew:skew=1",
    ]
    one, other = drape(CAP, *texts, origin=TOP), drape(CAP, *reversed(texts), origin=TOP)
    np.testing.assert_array_equal(one.points, other.points)
    np.testing.assert_array_equal(one.shear, other.shear)


PLUGIN = """
import geomdrap as gd
class Mine(gd.Effect):
    name = "mine"
    parameters = (gd.Parameter("size", "mm", 0.0, 2.0, 1.0, 0.0, "how much"),)
"""


def test_a_plugin_adds_its_effects(tmp_path):
    file = tmp_path / "mine.py"
    file.write_text(PLUGIN)
    assert gd.effects.load_plugin(file) == ("mine",)
    assert gd.effects.load_plugin(file) == ("mine",)  # again, after an edit
    assert gd.effects.parse("mine:size=1.5").values == {"size": 1.5}
    with pytest.raises(gd.EffectError, match="from 0 to 2 mm"):
        gd.effects.make("mine", size=3.0)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("x = (", "does not run: SyntaxError"),
        ("import nowhere_at_all", "does not run: ModuleNotFoundError"),
        ("import geomdrap as gd", "has no effect"),
        ("import geomdrap as gd\nclass Nameless(gd.Effect): pass", "has no effect"),
        ("import geomdrap as gd\nclass Slip(gd.Effect): name = 'slip'", "there is an effect slip already"),
    ],
)
def test_a_plugin_that_is_none_is_refused_with_its_name(tmp_path, text, words):
    file = tmp_path / "bad.py"
    file.write_text(text)
    with pytest.raises(gd.EffectError, match=words):
        gd.effects.load_plugin(file)
    with pytest.raises(gd.EffectError, match="no such file"):
        gd.effects.load_plugin(tmp_path / "missing.py")


def test_effects_of_installed_packages_are_found(tmp_path, monkeypatch):
    (tmp_path / "other_package.py").write_text(PLUGIN)
    monkeypatch.syspath_prepend(tmp_path)
    point = EntryPoint("mine", "other_package:Mine", registry.GROUP)
    monkeypatch.setattr(registry, "entry_points", lambda group: [point] if group == registry.GROUP else [])
    registry._installed.cache_clear()
    try:
        assert gd.effects.make("mine", size=1.0).values == {"size": 1.0}
    finally:
        monkeypatch.undo()
        registry._installed.cache_clear()


def test_a_model_file_gives_back_what_was_written(tmp_path):
    file = tmp_path / "model.toml"
    effects = [gd.effects.make("placement", du=1.25, dangle=-0.3), gd.effects.make("slip", coefficient=1 / 3)]
    gd.effects.write_model(file, effects, notes=["found by hand"])
    back = gd.effects.read_model(file)
    assert [(e.name, e.values) for e in back] == [(e.name, e.values) for e in effects]
    assert file.read_text().startswith("# found by hand\nformat = ")


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ('format = "geomdrap.model/9"', "this version reads"),
        ("", "is no model file"),
        ("[[effect", "no TOML file"),
        ('format = "geomdrap.model/1"\nspeed = 1', "'speed' is not known"),
        ('format = "geomdrap.model/1"\n[[effect]]\nname = "slip"\ncoefficient = 2.0', "from 0 to 1"),
        ('format = "geomdrap.model/1"\n[[effect]]\ncoefficient = 0.2', "has no name"),
        ('format = "geomdrap.model/1"\n[[effect]]\nname = "slip"', "does nothing without a value of coefficient"),
        ('format = "geomdrap.model/1"\n[[effect]]\nname = "slip"\ncoefficient = "0.5"', "must be a number, not '0.5'"),
        ('format = "geomdrap.model/1"\n[[effect]]\nname = "slip"\ncoefficient = true', "must be a number, not True"),
        ('format = "geomdrap.model/1"\n[[effect]]\nname = "my-own"\nx = 0.5', r"one of your own comes with its file \(--plugin"),
        ('format = "geomdrap.model/1"\neffect = 3', r"table \[\[effect\]\]"),
    ],
)
def test_a_model_file_that_is_none_is_refused_with_its_name(tmp_path, text, words):
    file = tmp_path / "model.toml"
    file.write_text(text)
    with pytest.raises(gd.EffectError, match=words) as error:
        gd.effects.read_model(file)
    assert "model.toml" in str(error.value)
    with pytest.raises(gd.EffectError, match="cannot be read"):
        gd.effects.read_model(tmp_path / "missing.toml")


def test_a_model_file_says_how_the_ply_was_meant_to_lie(tmp_path):
    file = tmp_path / "model.toml"
    meant = {"origin": (3.0, 2.0, 84.8472), "angle": 20.0, "reference": (0.0, 1.0, 0.0)}
    gd.effects.write_model(file, [gd.effects.make("slip", coefficient=0.3)], layup=meant)
    assert gd.effects.read_layup(file) == meant
    assert gd.effects.read_model(file)[0].values == {"coefficient": 0.3}
    gd.effects.write_model(file, [], layup={"origin": "vertex:7", "angle": -5.0})
    assert gd.effects.read_layup(file) == {"origin": "vertex:7", "angle": -5.0}
    gd.effects.write_model(file, [], layup={"angle": 5.0, "pitch": 4.0, "held": 8.0})
    assert gd.effects.read_layup(file) == {"angle": 5.0, "pitch": 4.0}
    held = gd.effects.read_model(file)[-1]
    assert held.on_fabric(gd.Fabric()).held_length == 8.0
    gd.effects.write_model(file, [gd.effects.make("shear-stiffness", ratio=0.003), held])  # as a net's own effects
    assert [e.name for e in gd.effects.read_model(file)] == ["shear-stiffness", "held-warp"]
    assert gd.effects.read_layup(file) == {}
    gd.effects.write_model(file, [])
    assert gd.effects.read_layup(file) == {}
    file.write_text('format = "geomdrap.model/1"\n[layup]\nangle = "steep"\n')
    with pytest.raises(gd.EffectError, match="not angle = 'steep'"):
        gd.effects.read_layup(file)
