"""The pitch that the program chooses does not warn of itself, and one without room is refused before the work."""

from __future__ import annotations

import json
import math
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from click.testing import Result

import geomdrap as gd
from geomdrap.cli.pitch import require_room
from geomdrap.surface import Surface, samples, shapes
from geomdrap.surface.samples import stl_bytes

Run = Callable[..., Result]


@pytest.fixture
def dome(tmp_path: Path) -> Path:
    return samples.write("double-dome", tmp_path)[0]


def test_a_chosen_pitch_that_is_coarse_for_the_part_is_halved_and_it_says_so(run: Run, dome: Path) -> None:
    alone = gd.drape(gd.read_surface(dome))
    assert "halve it" in " ".join(gd.evaluate(alone).warnings)
    document = json.loads(run("drape", dome, "--outputs", "none", "--json").stdout)
    assert document["pitch"] == alone.pitch / 2
    assert document["warnings"] == []
    assert f"pitch {alone.pitch / 2:g} mm chosen from the part, {alone.pitch:g} mm being too" in document["notes"][0]


def test_a_given_pitch_is_kept_and_warned_of(run: Run, dome: Path) -> None:
    document = json.loads(run("drape", dome, "--pitch", 10, "--outputs", "none", "--json").stdout)
    assert document["pitch"] == 10.0
    assert "halve it" in document["warnings"][0]


def test_where_the_facets_forbid_a_smaller_pitch_the_reason_is_said(run: Run, tmp_path: Path) -> None:
    (tmp_path / "ball.stl").write_bytes(stl_bytes(shapes.icosphere(50.0, 3)))
    document = json.loads(run("drape", "ball.stl", "--outputs", "none", "--json").stdout)
    assert any("narrower than the pitch" in region["reason"] for region in document["bare"])
    assert "a smaller pitch than 10 mm was not chosen, as it would follow the facets" in document["notes"][0]


def test_a_pitch_without_room_is_refused_before_the_march(
    tmp_path: Path, error_of: Callable[..., str], monkeypatch: pytest.MonkeyPatch
) -> None:
    plane = shapes.plane(200.0, 200.0, 10.0)
    (tmp_path / "plane.stl").write_bytes(stl_bytes(plane))
    monkeypatch.setattr("geomdrap.drape", lambda *_, **__: pytest.fail("draped"))
    words = error_of("drape", "plane.stl", "--pitch", "0.05", "--outputs", "none")
    assert "a pitch of 0.05 mm is too small for plane.stl: its 1.6e+07 cells need about 7.2 GB of memory" in words
    least = float(words.split("use ")[1].split()[0])
    require_room(plane, least)
    with pytest.raises(gd.DrapeError):
        require_room(plane, 0.9 * least)
    assert least == pytest.approx(math.sqrt(2.0 * 200.0**2 / 1e7) / 1.5, rel=0.1)


def test_one_huge_facet_is_not_blamed_on_the_pitch() -> None:
    plane = shapes.plane(200.0, 200.0, 10.0)
    points = np.vstack([plane.points, [[3e6, 0.0, 0.0]]])
    rim = (
        int(np.argmax(plane.points[:, 0] + 1e-3 * plane.points[:, 1])),
        int(np.argmax(plane.points[:, 0] - 1e-3 * plane.points[:, 1])),
    )
    require_room(Surface(points, np.vstack([plane.triangles, [[rim[1], len(points) - 1, rim[0]]]])), 5.0)
