"""Names in scripts that the pictures' font lacks: a box for a letter, and no word from the library."""

from __future__ import annotations

import warnings

import pytest

from geomdrap.export.glyphs import MISSING, drawable


def drawn(text: str) -> str:
    """Draw a text with all warnings turned into errors; gives the text that matplotlib shows."""
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    figure = Figure()
    label = figure.text(0.1, 0.5, text, fontweight="bold")
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        FigureCanvasAgg(figure).draw()
    return str(label._preprocess_math(text)[0])


@pytest.mark.parametrize(
    ("name", "shown"),
    [
        ("Wölbung ü.stl", "Wölbung ü.stl"),
        ("部品.stl", f"{2 * MISSING}.stl"),
        ("a$x_1$b.stl", "a$x_1$b.stl"),
        ("one $.stl", "one $.stl"),
    ],
)
def test_any_name_is_drawn_without_a_warning(name: str, shown: str) -> None:
    assert drawn(drawable(name)) == shown


def test_a_name_without_glyphs_as_it_is_would_be_warned_of() -> None:
    with pytest.raises(UserWarning, match="missing"):
        drawn("部品.stl")
