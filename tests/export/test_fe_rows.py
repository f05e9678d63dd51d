"""Rows of numbers: what rounds to zero has no sign, and everything else its own."""

from __future__ import annotations

import numpy as np
import pytest

from geomdrap.export.fe_nastran import degrees
from geomdrap.export.fe_rows import rows


@pytest.mark.parametrize("places", [3, 5, 6, 7])
def test_what_rounds_to_zero_is_written_without_a_sign(places):
    least = 10.0**-places
    values = np.array([-0.4 * least, -0.0, 0.4 * least, -0.6 * least])
    assert list(rows(f"%d,%.{places}f", np.arange(4), values)) == [
        *(f"{k},{0.0:.{places}f}" for k in range(3)),
        f"3,{-least:.{places}f}",
    ]


def test_columns_must_be_as_many_as_the_pattern_has():
    with pytest.raises(ValueError, match="zip"):
        list(rows("%d, %.3f", [1, 2]))


@pytest.mark.parametrize(("theta", "text"), [(-0.0004, "0.000"), (-0.0, "0.000"), (-0.0006, "-0.001"), (180.0, "180.000")])
def test_angles_in_nastran_fields_have_no_negative_zero(theta, text):
    assert degrees(theta) == text
