"""Blind sets: reproducible, complete, sealed; what is asked for is what they hold."""

from __future__ import annotations

import csv
import tomllib
from dataclasses import replace

import numpy as np
import pytest

from geomdrap.blind import HIDDEN, LIBRARY, OUTSIDE, TOOLS, make, unseal
from geomdrap.blind.files import COLUMNS
from geomdrap.errors import GeomdrapError

QUICK = [
    n for n in HIDDEN if n not in ("shear-stiffness", "shear-asymmetry", "locking", "crossing-slip", "yarn-bending")
]


def table(folder):
    return np.genfromtxt(folder / "measured.csv", delimiter=",", names=True)


def test_a_seed_gives_the_same_measurements_and_another_salt(tmp_path):
    a, b = (make(3, effect="steering", folder=tmp_path / name) for name in "ab")
    for name in ("part.stl", "measured.csv", "setup.toml"):
        assert (a / name).read_bytes() == (b / name).read_bytes()
    assert (a / "seal.txt").read_text() != (b / "seal.txt").read_text()
    assert unseal(a) == unseal(b)
    assert make(4, effect="steering", folder=tmp_path / "c").joinpath("measured.csv").read_bytes() != (
        (a / "measured.csv").read_bytes()
    )


@pytest.mark.parametrize("effect", ["none", "placement", *QUICK])
def test_a_set_holds_the_effect_that_was_asked_for(tmp_path, effect):
    truth = unseal(make(7, effect=effect, folder=tmp_path))
    assert truth["answer"] == ("unknown" if effect in OUTSIDE else effect)
    assert list(truth["effect"]) == ([effect] if effect in HIDDEN else [])
    assert bool(truth["placement"]) or effect != "placement"
    assert 10_000 <= truth["facets"] <= 20_000
    assert len(table(tmp_path)) == truth["marks"] > 100


@pytest.mark.slow
@pytest.mark.parametrize("effect", [n for n in HIDDEN if n not in QUICK])
def test_a_relaxed_set_holds_the_effect_that_was_asked_for(tmp_path, effect):
    truth = unseal(make(7, effect=effect, folder=tmp_path))
    assert list(truth["effect"]) == [effect]
    assert truth["signal_to_noise"] > 5.0


def test_names_and_parameters_are_those_of_the_library():
    from geomdrap.effects import available

    known = available()
    rng = np.random.default_rng(0)
    for name in set(LIBRARY) & set(known):
        values = HIDDEN[name].draw(rng, 1.0, 20.0)[0]
        bounds = {p.name: p for p in known[name].parameters}
        assert set(values) <= set(bounds), name
        assert all(bounds[p].low <= value <= bounds[p].high for p, value in values.items()), name
    assert set(known) - set(LIBRARY) <= {"placement"}


@pytest.mark.parametrize("part", TOOLS)
def test_the_part_is_the_tool_and_its_normals_point_up(tmp_path, part):
    make(1, effect="none", part=part, folder=tmp_path)
    data = np.frombuffer((tmp_path / "part.stl").read_bytes()[84:], dtype=[("f", "<f4", 12), ("more", "<u2")])["f"]
    assert np.all(data[:, 2] > 0.0)
    corners = data[:, 3:].reshape(-1, 3, 3).astype(float)
    edge = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert np.all(edge[:, 2] > 0.0)


@pytest.mark.parametrize("columns", COLUMNS)
def test_the_table_has_the_columns_that_were_asked_for(tmp_path, columns):
    make(1, effect="none", columns=columns, folder=tmp_path)
    with (tmp_path / "measured.csv").open() as file:
        assert tuple(next(csv.reader(file))) == COLUMNS[columns]


def test_directions_and_shear_agree(tmp_path):
    (one, two) = (make(1, effect="weave-skew", columns=c, folder=tmp_path / c) for c in ("all", "directions"))
    t = table(two)
    warp, weft = (np.stack([t[f"{w}_{x}"] for x in "xyz"], axis=1) for w in ("warp", "weft"))
    assert np.linalg.norm(warp, axis=1) == pytest.approx(1.0, abs=1e-3)
    angle = np.rad2deg(np.arcsin(np.sum(warp * weft, axis=1)))
    clean = np.abs(angle - table(one)["shear"])
    assert np.median(clean) < 1.5  # two readings with 0.6° of noise each


def test_the_setup_is_what_the_person_believes_and_tells_the_noise(tmp_path):
    truth = unseal(make(2, effect="placement", noise=2.0, folder=tmp_path))
    setup = tomllib.loads((tmp_path / "setup.toml").read_text())
    assert setup["sigma_xyz"] == pytest.approx(0.4)
    assert setup["sigma_shear"] == pytest.approx(1.2)
    assert abs(setup["angle"] % 5.0) < 1e-9
    assert abs(truth["placement"]["dangle"]) > 0.3


@pytest.mark.parametrize("points", [40, 100, 700])
def test_as_many_points_are_measured_as_asked(tmp_path, points):
    make(1, effect="none", part="dome", points=points, folder=tmp_path)
    assert len(table(tmp_path)) == points


def test_outliers_are_far_off_and_listed(tmp_path):
    plain, spoilt = (make(1, effect="none", outliers=o, folder=tmp_path / str(o)) for o in (0.0, 0.04))
    listed = unseal(spoilt)["outliers"]
    one, two = (np.stack([table(f)[name] for name in ("x", "y", "z")], axis=1) for f in (plain, spoilt))
    moved = np.linalg.norm(one - two, axis=1)
    assert np.flatnonzero(moved > 1.0).tolist() == listed
    assert len(listed) == round(0.04 * len(moved))


def test_a_stronger_effect_shows_more(tmp_path):
    weak, strong = (
        unseal(make(5, effect="thickness", placement="right", amount=a, folder=tmp_path / str(a))) for a in (0.5, 1.0)
    )
    assert strong["signal_to_noise"] == pytest.approx(2.0 * weak["signal_to_noise"], rel=0.1)


def test_two_effects_can_be_hidden_at_once(tmp_path):
    truth = unseal(make(1, effect="yarn-extension+weave-skew", folder=tmp_path))
    assert truth["answer"] == "yarn-extension+weave-skew"
    assert set(truth["effect"]) == {"yarn-extension", "weave-skew"}


@pytest.mark.parametrize(
    ("options", "says"),
    [
        ({"effect": "gremlins"}, "no blind effect 'gremlins'"),
        ({"part": "teapot"}, "no blind part 'teapot'"),
        ({"columns": "some"}, "columns"),
        ({"placement": "odd"}, "placement"),
        ({"noise": 0.0}, "noise"),
        ({"outliers": 0.7}, "outliers"),
        ({"points": 3}, "points"),
        ({"scatter": -1.0}, "scatter"),
        ({"size": 9.0}, "size"),
        ({"effect": "slip+slip"}, "'slip.slip' names slip more than once; name it once"),
        ({"effect": "bridging+thickness"}, "thickness does not go together with bridging"),
        ({"effect": "thickness+bridging"}, "thickness does not go together with bridging"),
        ({"effect": "shear-stiffness+yarn-bending"}, "yarn-bending does not go together with shear-stiffness"),
    ],
)
def test_what_cannot_be_made_is_refused(tmp_path, options, says):
    with pytest.raises(GeomdrapError, match=says):
        make(1, folder=tmp_path / "set", **options)
    assert not (tmp_path / "set").exists()


def test_effects_that_no_part_shows_at_once_are_refused(tmp_path, monkeypatch):
    monkeypatch.setitem(HIDDEN, "bridging", replace(HIDDEN["bridging"], parts=("valley", "pan")))
    with pytest.raises(GeomdrapError, match="no blind part shows bridging and locking at once"):
        make(1, folder=tmp_path / "set", effect="bridging+locking")
    assert not (tmp_path / "set").exists()
