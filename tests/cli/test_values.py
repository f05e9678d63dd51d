"""Values of options: what is understood, and what is refused with which words."""

from __future__ import annotations

from typing import Any

import click
import pytest
from hypothesis import given
from hypothesis import strategies as st

from geomdrap.cli.values import Direction, NamedPath, Names, Number, Origin, Size, Triple

ANGLE, PITCH = Number("DEG"), Number("MM", above=0.0)


@pytest.mark.parametrize(
    ("kind", "text", "value"),
    [
        (ANGLE, "-45", -45.0),
        (ANGLE, "1e2", 100.0),
        (PITCH, "0.5", 0.5),
        (Triple(), "-5,5,84.4", (-5.0, 5.0, 84.4)),
        (Triple(), " 1, 2 ,3e0 ", (1.0, 2.0, 3.0)),
        (Direction(), "0,0,-1", (0.0, 0.0, -1.0)),
        (Origin(), "centroid", "centroid"),
        (Origin(), "-5,5,84.4", (-5.0, 5.0, 84.4)),
        (Origin(), "vertex:0", 0),
        (Origin(), "vertex:123", 123),
        (Size(), "400x300", (400.0, 300.0)),
        (Size(), "4e2X 300.5", (400.0, 300.5)),
        (Size(), "400×300", (400.0, 300.0)),
        (Names(("a", "b", "c")), "c,a", ("a", "c")),
        (Names(("a", "b", "c")), "B, b", ("b",)),
        (Names(("a", "b")), "none", ()),
    ],
)
def test_understands(kind: click.ParamType, text: str, value: Any) -> None:
    assert kind.convert(text, None, None) == value


@given(text=st.text(max_size=40) | st.from_regex(r"[-+0-9.,xeE:vn]{0,20}", fullmatch=True))
@pytest.mark.parametrize("kind", [ANGLE, PITCH, Triple(), Direction(), Origin(), Size(), Names(("a", "b"))])
def test_any_text_is_understood_or_refused_in_one_sentence(kind: click.ParamType, text: str) -> None:
    try:
        kind.convert(text, None, None)
    except click.BadParameter as refusal:
        assert len(refusal.message) > 10


@pytest.mark.parametrize(
    ("kind", "text", "words"),
    [
        (ANGLE, "north", "not a number"),
        (ANGLE, "nan", "not a finite number"),
        (ANGLE, "-inf", "not a finite number"),
        (ANGLE, "", "not a number"),
        (ANGLE, "1_0", "not a number"),
        (PITCH, "0", "above 0"),
        (PITCH, "-3", "above 0"),
        (PITCH, "nan", "above 0"),
        (PITCH, "inf", "above 0"),
        (Number("DEG", above=0, below=90), "90", "90 is not between 0 and 90, both excluded"),
        (Number("MM", least=0.0), "-1", "-1 is not a finite number of at least 0"),
        (NamedPath(), "", "the name is empty"),
        (Triple(), "1,2", "three finite numbers"),
        (Triple(), "1,2,3,4", "three finite numbers"),
        (Triple(), "1,2,x", "three finite numbers"),
        (Triple(), "1,2,nan", "three finite numbers"),
        (Triple(), "1,2,", "three finite numbers"),
        (Direction(), "0,0,0", "no direction"),
        (Origin(), "middle", "not centroid, a point"),
        (Origin(), "5", "not centroid, a point"),
        (Origin(), "vertex:", "not a vertex"),
        (Origin(), "vertex:-1", "not a vertex"),
        (Origin(), "vertex:1.5", "not a vertex"),
        (Origin(), "1,2", "three finite numbers"),
        (Origin(), "inf,0,0", "three finite numbers"),
        (Size(), "400", "width and a height"),
        (Size(), "400x", "width and a height"),
        (Size(), "0x300", "width and a height"),
        (Size(), "400x-1", "width and a height"),
        (Size(), "infx3", "width and a height"),
        (Size(), "1x2x3", "width and a height"),
        (Names(("a", "b")), "a,q", "'q' is not one of a, b"),
        (Names(("a", "b")), "", "is not one of a, b"),
        (Names(("a", "b")), "none,a", "'none,a' asks for none and for others"),
    ],
)
def test_refuses(kind: click.ParamType, text: str, words: str) -> None:
    with pytest.raises(click.BadParameter, match=words):
        kind.convert(text, None, None)
