"""Bad parts, seeds and pitches: exit code 2, one line that says what to do, earlier results untouched."""

from __future__ import annotations

import math
import os
import struct
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

Run = Callable[..., Result]
ErrorOf = Callable[..., str]

SQUARE = "v 0 0 0\nv 100 0 0\nv 100 100 0\nv 0 100 0\nf 1 2 3\nf 1 3 4\n"


def _obj(*corners: tuple[float, float, float]) -> str:
    points = "".join(f"v {x} {y} {z}\n" for x, y, z in corners)
    return points + "".join(f"f {k + 1} {k + 2} {k + 3}\n" for k in range(0, len(corners), 3))


def _moebius(n: int = 24) -> str:
    rows = []
    for k in range(n):
        turn = 2 * math.pi * k / n
        for side in (-20.0, 20.0):
            radius = 100 + side * math.cos(turn / 2)
            place = radius * math.cos(turn), radius * math.sin(turn), side * math.sin(turn / 2)
            rows.append("v {:.9f} {:.9f} {:.9f}".format(*place))
    quads = [(2 * k, 2 * k + 1, 2 * k + 3, 2 * k + 2) for k in range(n - 1)] + [(2 * n - 2, 2 * n - 1, 0, 1)]
    for a, b, c, d in quads:
        rows += [f"f {a + 1} {b + 1} {c + 1}", f"f {a + 1} {c + 1} {d + 1}"]
    return "\n".join(rows) + "\n"


def _binary_stl(triangles: int, said: int) -> bytes:
    facet = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 100, 0, 0, 0, 100, 0, 0)
    return b"\0" * 80 + struct.pack("<I", said) + facet * triangles


PARTS: dict[str, tuple[str, str | bytes, str]] = {
    "an empty file": ("part.stl", b"", "empty"),
    "garbage": ("part.stl", bytes(range(256)) * 40, "part.stl"),
    "garbage of another format": ("part.vtu", b"garbage" * 100, "part.vtu"),
    "a truncated STL": ("part.stl", _binary_stl(3, 1000), "part.stl"),
    "a broken ASCII STL": (
        "part.stl",
        "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\nendloop\nendfacet\nendsolid a\n",
        "part.stl",
    ),
    "a cut ASCII STL": ("part.stl", "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0", "part.stl"),
    "a broken OBJ": ("part.obj", "v 0 0 0\nv 1 0\nf 1 2 99\n", "part.obj"),
    "NaN vertices": ("part.obj", SQUARE.replace("v 100 100 0", "v nan 100 0"), "part.obj"),
    "infinite vertices": ("part.obj", SQUARE.replace("v 100 100 0", "v inf 100 0"), "part.obj"),
    "points only": ("part.obj", SQUARE[: SQUARE.index("f")], "part.obj"),
    "an unknown format": ("part.xyz", "1 2 3\n", ".xyz"),
    "no area": ("part.obj", _obj((0, 0, 0), (50, 0, 0), (100, 0, 0)), "part.obj"),
    "a point as a triangle": ("part.obj", _obj(*[(1.0, 1.0, 1.0)] * 3), "part.obj"),
    "a Moebius strip": ("part.obj", _moebius(), "one side"),
    "a fin": ("part.obj", SQUARE + "v 50 50 80\nf 1 3 5\n", "(50, 50, 0)"),
}


@pytest.mark.parametrize("case", PARTS)
@pytest.mark.parametrize("command", ["drape", "check"])
def test_a_bad_part_is_named_in_one_line(run: Run, case: str, command: str) -> None:
    name, data, words = PARTS[case]
    Path(name).write_bytes(data if isinstance(data, bytes) else data.encode())
    result = run(command, name, "--json")
    assert result.exit_code == 2
    if command == "drape" or not result.stdout:
        assert result.stdout == ""
        (line,) = [text for text in result.stderr.splitlines() if text.startswith("Error:")]
        assert words in line
    assert "Traceback" not in result.stderr
    assert not Path("drape").exists()


def test_a_folder_is_no_part(error_of: ErrorOf) -> None:
    Path("part.stl").mkdir()
    assert "is a folder" in error_of("drape", "part.stl")


def test_a_missing_part_is_named(error_of: ErrorOf) -> None:
    assert "missing.stl does not exist" in error_of("drape", "missing.stl")


@pytest.mark.parametrize("name", ["a" * 300 + ".stl", ".", "no\nname.stl", ""])
def test_impossible_file_names_are_bad_input(run: Run, name: str) -> None:
    result = run("drape", name)
    assert result.exit_code == 2
    assert result.stderr.startswith("Error: ")


@pytest.mark.skipif(os.name == "nt" or os.geteuid() == 0, reason="this user may read everything")
def test_a_part_without_permission_is_named(error_of: ErrorOf) -> None:
    Path("part.obj").write_text(SQUARE)
    Path("part.obj").chmod(0)
    assert "may not be read" in error_of("drape", "part.obj")


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--pitch", "0"], "above 0"),
        (["--pitch", "-5"], "above 0"),
        (["--pitch", "nan"], "above 0"),
        (["--pitch", "5000"], "pitch"),
        (["--pitch", "0.0001"], "memory"),
        (["--pitch", "1e-300"], "pitch"),
        (["--pitch", "1e300"], "pitch"),
        (["--origin", "50,50,900"], "--project"),
        (["--origin", "nan,0,0"], "three finite numbers"),
        (["--origin", "1,2"], "three finite numbers"),
        (["--origin", "vertex:99"], "no vertex 99"),
        (["--angle", "nan"], "finite number"),
        (["--reference", "0,0,1"], "reference direction"),
        (["--reference", "0,0,0"], "no direction"),
        (["--blank", "0x10"], "width and a height"),
        (["--limit-angle", "91"], "between 0 and 90"),
        (["--outputs", "docx"], "json, csv, vtu, png, dxf, svg"),
        (["--tolerance", "0"], "above 0"),
    ],
    ids=lambda value: " ".join(value) if isinstance(value, list) else "",
)
def test_bad_options_are_named_and_earlier_results_stay(
    error_of: ErrorOf, options: list[str], words: str
) -> None:
    Path("part.obj").write_text(SQUARE)
    Path("drape").mkdir()
    Path("drape/drape.json").write_text("earlier")
    assert words in error_of("drape", "part.obj", *options)
    assert [file.name for file in Path("drape").iterdir()] == ["drape.json"]
    assert Path("drape/drape.json").read_text() == "earlier"
