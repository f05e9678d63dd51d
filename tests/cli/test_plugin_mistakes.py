"""Mistakes in the user's own effects are said to be theirs, with the file and line."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

import geomdrap as gd
from geomdrap.surface import shapes

HEAD = """import geomdrap as gd
class Own(gd.Effect):
    name = "own"
    summary = "Mine."
    stage = "fabric"
    parameters = (gd.Parameter("strain", "", 0.0, 0.05, 0.004, 0.0, "share"),)
"""

MISTAKES = {
    "a key": (
        "on_fabric",
        "return fabric.strain_warp * self.values['strian']",
        "on_fabric, line 8: KeyError: 'strian'",
    ),
    "no return": ("on_fabric", "fabric.strain_warp", "returned nothing from on_fabric; it must return the Fabric"),
    "another stage's": ("on_fabric", "return self", "returned Own from on_fabric; it must return the Fabric"),
    "a surface": (
        "on_surface",
        "return fabric.points",
        "returned ndarray from on_surface; it must return the Surface",
    ),
    "a placement": ("on_placement", "return 0.5", "returned float from on_placement; it must return the Shift"),
    "a net": ("on_net", "return None", "returned nothing from on_net; it must return the Net"),
    "a net's shape": (
        "on_net",
        "from dataclasses import replace; return replace(fabric, shear=fabric.shear[1:])",
        "returned a Net from on_net whose shear is (",
    ),
    "a net's field": ("on_net", "return fabric.sheer", "on_net, line 8: AttributeError"),
}


@pytest.fixture
def write(tmp_path):
    """Write a plugin whose one method has that body; a part and measured marks lie beside it."""
    import meshio

    part = shapes.sphere_cap(80.0, 60.0, 8.0)
    meshio.Mesh(part.points, [("triangle", part.triangles)]).write(tmp_path / "part.obj")
    net = gd.drape(part, "centroid", 0.0, 10.0)
    known = np.isfinite(net.points[..., 0])
    u, v = (a[known] for a in np.meshgrid(net.u, net.v, indexing="ij"))
    np.savetxt(
        tmp_path / "m.csv", np.column_stack([u, v, net.points[known]]), delimiter=",", header="u,v,x,y,z", comments=""
    )

    def call(method: str, body: str, head: str = HEAD) -> Path:
        file = tmp_path / "my.py"
        file.write_text(f"{head}    def {method}(self, fabric):\n        {body}\n")
        return file

    yield call
    gd.effects.registry._REGISTERED.pop("own", None)


@pytest.mark.parametrize(("method", "body", "words"), MISTAKES.values(), ids=MISTAKES)
def test_a_drape_says_whose_mistake_it_is(error_of, write, method, body, words):
    write(method, body)
    said = error_of("drape", "part.obj", "--plugin", "my.py", "--effect", "own:strain=0.01", "--outputs", "none")
    assert said.startswith("plugin my.py: effect own ")
    assert words in said
    assert "bug in geomdrap" not in said


@pytest.mark.parametrize(
    "command",
    [
        "sweep part.obj --angles 0,45 --effect own:strain=0.01 --outputs none -q",
        "compare part.obj m.csv --effect own:strain=0.01 --outputs none -q",
        "effects own -o pictures",
        "diagnose part.obj m.csv --sigma-xyz 0.2 --outputs none -q",
        "improve part.obj m.csv --sigma-xyz 0.2 -q",
    ],
)
def test_every_command_with_plugins_says_so(error_of, write, command):
    write("on_fabric", "return fabric.strain_warp * self.values['strian']")
    said = error_of(*command.split(), "--plugin", "my.py")
    assert "plugin my.py: effect own failed in on_fabric, line 8: KeyError: 'strian'" in said


def test_parameters_that_are_none_are_refused(error_of, write):
    head = HEAD.replace('gd.Parameter("strain", "", 0.0, 0.05, 0.004, 0.0, "share")', '"strain"')
    write("on_fabric", "return fabric", head)
    assert "parameters must be a tuple of geomdrap.Parameter" in error_of("effects", "--plugin", "my.py")


def test_what_a_plugin_refuses_on_purpose_is_said_in_its_own_words(error_of, write):
    write("on_fabric", "raise gd.EffectError('too warm')")
    said = error_of("drape", "part.obj", "--plugin", "my.py", "--effect", "own:strain=0.01", "--outputs", "none")
    assert said == "too warm"


def test_a_right_plugin_goes_on_working(run, write):
    write("on_fabric", "return fabric")
    result = run(
        "drape", "part.obj", "--plugin", "my.py", "--effect", "own:strain=0.01", "--outputs", "none", "--json"
    )
    assert json.loads(result.stdout)["effects"][0]["name"] == "own"
