"""The guard of a user's effects: what fails is said to be theirs, and what is right goes on as it was."""

from __future__ import annotations

from dataclasses import replace
from importlib.metadata import EntryPoint

import pytest

import geomdrap as gd
from geomdrap.effects import registry
from geomdrap.effects.guard import guard
from geomdrap.surface import shapes

HEAD = """
import geomdrap as gd
class Own(gd.Effect):
    name = "own"
    parameters = (gd.Parameter("strain", "", 0.0, 0.05, 0.004, 0.0, "share"),)
"""
NEUTRAL = {
    "fails": ("@property", "return self.values['strian'] == 0", "failed in is_neutral, line 8: KeyError: 'strian'"),
    "no property": (
        "",
        "return False",
        "returned method from is_neutral; it must be a property that is True or False",
    ),
    "no return": ("@property", "False", "returned nothing from is_neutral; it must be a property"),
}


@pytest.fixture
def load(tmp_path):
    """The effect of a plugin with that body of its class."""

    def call(body: str, head: str = HEAD):
        file = tmp_path / "my.py"
        file.write_text(head + "\n".join(f"    {line}" for line in body.splitlines()) + "\n")
        gd.effects.load_plugin(file)
        return gd.effects.find("own")

    yield call
    registry._REGISTERED.pop("own", None)


@pytest.fixture(scope="module")
def net():
    return gd.drape(shapes.sphere_cap(80.0, 60.0, 8.0), "centroid", 0.0, 10.0)


@pytest.mark.parametrize(("decorator", "body", "words"), NEUTRAL.values(), ids=NEUTRAL)
def test_a_mistake_in_is_neutral_is_the_plugins(load, decorator, body, words):
    with pytest.raises(gd.PluginError) as error:
        load(f"{decorator}\ndef is_neutral(self):\n    {body}")(strain=0.01).is_neutral  # noqa: B018
    assert str(error.value).startswith(f"plugin my.py: effect own {words}")


def test_is_neutral_of_its_own_goes_on_working(load):
    own = load("@property\ndef is_neutral(self):\n    return self.values['strain'] < 0.01 or super().is_neutral")
    assert (own(strain=0.005).is_neutral, own(strain=0.02).is_neutral) == (True, False)
    assert load("is_neutral = False")().is_neutral is False


@pytest.mark.parametrize(("decorator", "first"), [("@staticmethod", ""), ("@classmethod", "cls, "), ("", "self, ")])
def test_static_and_class_methods_are_called_as_without_the_guard(load, decorator, first):
    own = load(f"{decorator}\ndef on_fabric({first}fabric):\n    return fabric")
    fabric = gd.Fabric()
    assert own(strain=0.01).on_fabric(fabric) is fabric


def test_a_list_of_parameters_is_taken(load):
    head = HEAD.replace('(gd.Parameter("strain"', '[gd.Parameter("strain"').replace('"share"),)', '"share")]')
    assert isinstance(load("pass", head).parameters, tuple)
    assert gd.effects.make("own", strain=0.01).values == {"strain": 0.01}


WRONG_NETS = {
    "a row less": (lambda net: {"shear": net.shear[1:]}, "whose shear is ("),
    "shear of cells": (lambda net: {"shear": net.cell_shear}, "whose shear is ("),
    "a list": (lambda net: {"points": net.points.tolist()}, "whose points is list"),
    "one side": (lambda net: {"sides": (net.shear,)}, "whose sides are no pair"),
    "a shorter u": (lambda net: {"u": net.u[:-1]}, "whose points is ("),
}


@pytest.mark.parametrize(("change", "words"), WRONG_NETS.values(), ids=WRONG_NETS)
def test_a_net_whose_arrays_do_not_go_together_is_refused(net, change, words):
    class Own(gd.Effect):
        def on_net(self, net):
            return replace(net, **change(net))

    guard(Own, "mine")
    with pytest.raises(gd.PluginError, match="mine: effect Own returned a Net from on_net") as error:
        Own().on_net(net)
    assert words in str(error.value)


def test_every_net_of_the_library_goes_through_the_guard(net):
    class Own(gd.Effect):
        def on_net(self, net):
            return net

    guard(Own, "mine")
    for texts in (
        [],
        ["yarn-extension:strain_warp=0.01"],
        ["shear-stiffness:ratio=0.01"],
        ["crossing-slip:share=0.2"],
    ):
        effects = [*map(gd.effects.parse, texts), Own()]
        assert gd.drape(net.surface, "centroid", 0.0, 10.0, effects=effects).effects


def test_effects_of_installed_packages_are_guarded_and_those_of_the_library_are_not(tmp_path, monkeypatch):
    (tmp_path / "another_package.py").write_text(
        f"{HEAD}    def on_fabric(self, fabric):\n        return fabric.sheer\nfrom geomdrap.effects.slip import Slip\n"
    )
    monkeypatch.syspath_prepend(tmp_path)
    points = [EntryPoint(name, f"another_package:{name}", registry.GROUP) for name in ("Own", "Slip")]
    monkeypatch.setattr(registry, "entry_points", lambda group: points)
    registry._installed.cache_clear()
    try:
        with pytest.raises(
            gd.PluginError, match="another_package:Own: effect own failed in on_fabric, line 7: Attri"
        ):
            gd.effects.make("own", strain=0.01).on_fabric(gd.Fabric())
        assert not hasattr(gd.effects.find("slip"), "_is_guarded")
    finally:
        monkeypatch.undo()
        registry._installed.cache_clear()
