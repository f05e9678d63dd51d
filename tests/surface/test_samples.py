"""The samples by name: sizes, bytes of the STL, agreement with the files shipped and with the README."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
import trimesh

from geomdrap.errors import SurfaceError
from geomdrap.surface import samples

HOME = Path(__file__).parents[2] / "samples"
ASKED = {"hemisphere", "double-dome", "hood", "bracket", "cone", "cylinder", "saddle", "l-shape"}


def test_all_samples_have_a_name_and_one_line_that_describes_them():
    assert set(samples.names()) == ASKED
    for name in samples.names():
        text = samples.describe(name)
        assert "\n" not in text
        assert " mm" in text


@pytest.mark.parametrize("name", sorted(ASKED))
def test_a_sample_is_one_drapable_part_of_real_size_and_shipped_in_a_small_file(name):
    surface = samples.build(name)
    surface.require_drapable()
    assert surface.source == name
    assert surface.n_components == 1
    assert 80 + 4 + 50 * len(surface.triangles) < 600_000
    sizes = np.sort(surface.bounds[1] - surface.bounds[0])
    assert sizes[-1] < 1500.0
    assert sizes[1] > 100.0


@pytest.mark.parametrize("name", sorted(ASKED))
def test_a_sample_can_be_had_with_55000_facets(name):
    surface = samples.build(name, facets=55_000)
    assert len(surface.triangles) == pytest.approx(55_000, rel=0.05)


def test_a_sample_can_be_had_with_a_given_edge():
    edge = 3.0
    surface = samples.build("saddle", edge=edge)
    assert surface.mean_edge == pytest.approx(edge, rel=0.25)


@pytest.mark.parametrize("name", sorted(ASKED))
def test_the_stl_holds_the_part_and_another_reader_agrees(name, tmp_path):
    (path,) = samples.write(name, tmp_path)
    surface = samples.build(name)
    assert path == tmp_path / f"{name}.stl"
    read = trimesh.load_mesh(path)
    assert len(read.faces) == len(surface.triangles)
    assert read.is_winding_consistent
    assert read.area == pytest.approx(surface.area, rel=1e-5)
    assert np.abs(read.bounds - surface.bounds).max() < 1e-4
    assert len(read.vertices) == len(surface.points)
    assert np.abs(read.face_normals - surface.normals).max() < 1e-3


def test_writing_twice_gives_the_same_bytes_and_leaves_nothing_else(tmp_path):
    (first,) = samples.write("cone", tmp_path)
    before = first.read_bytes()
    (second,) = samples.write("cone", tmp_path)
    assert second.read_bytes() == before
    assert [p.name for p in tmp_path.iterdir()] == ["cone.stl"]
    assert not before.startswith(b"solid")  # else readers take it for ASCII


@pytest.mark.parametrize("name", sorted(ASKED))
def test_the_shipped_file_is_the_part_that_the_code_makes(name):
    raw = (HOME / "parts" / f"{name}.stl").read_bytes()
    corners = np.frombuffer(raw[84:], samples.FACET)["corners"]
    surface = samples.build(name)
    made = surface.points[surface.triangles]
    assert corners.shape == made.shape
    # another machine's sine may differ in the last digit, and with it single-precision rounding
    assert np.abs(corners - made).max() < 1e-3


def test_the_readme_of_the_samples_has_the_same_table():
    text = (HOME / "README.md").read_text(encoding="utf-8")
    for name in samples.names():
        sample = samples.find(name)
        assert f"| `{name}` | {sample.part} | {sample.dimensions} | {sample.source} |" in text


def test_an_unknown_sample_names_those_that_there_are(tmp_path):
    with pytest.raises(SurfaceError, match=r"'teapot'.*hemisphere.*l-shape"):
        samples.write("teapot", tmp_path)


@pytest.mark.parametrize(
    ("how", "word"),
    [({"facets": 3}, "facets"), ({"facets": 10**9}, "facets"), ({"facets": 500, "edge": 1.0}, "either")],
)
def test_senseless_sizes_are_refused(how, word):
    with pytest.raises(SurfaceError, match=word):
        samples.build("cone", **how)


def test_a_folder_that_is_missing_is_an_error_that_names_the_file(tmp_path):
    with pytest.raises(SurfaceError, match=r"cone\.stl"):
        samples.write("cone", tmp_path / "nowhere")
