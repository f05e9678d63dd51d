"""Sentences of a diagnosis: what was not seen is not given as a number, and ± says of what it is."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from geomdrap.criticism.diagnosis import Tried, Value
from geomdrap.criticism.evidence import Evidence
from geomdrap.criticism.leftover import Leftover
from geomdrap.criticism.likelihood import Scatter
from geomdrap.criticism.story import (
    fitted_words,
    outlier_sentence,
    rival_sentence,
    table_rows,
    unseen_sentences,
    verdict_sentence,
)
from geomdrap.effects import make

WIDE = float("inf")


def tried(name, *amounts, sigma=0.01, selected=False, looked_at_only=False, **known):
    """An effect with the amounts that would be seen of its parameters, at their typical values."""
    own = make(name).parameters
    values = tuple(Value(p.name, p.typical, sigma, p.unit) for p in own)
    visible = tuple((p.name, amount, p.unit) for p, amount in zip(own, amounts, strict=True))
    nothing = dict.fromkeys(Evidence.__dataclass_fields__, 0.0)
    evidence = Evidence(**{**nothing, "name": name, "includes": (), **known})
    return Tried(name, values, evidence, 0.1, 0.2, 1.0, (), visible, selected, looked_at_only)


def diagnosis(verdict, *rows):
    return SimpleNamespace(
        verdict=verdict,
        tried=rows,
        candidates=(),
        scatter=Scatter(0.0, 0.0),
        placement=(),
        confidence=1.0,
        warnings=(),
        leftover=Leftover(1.0, 0.0, ()),
    )


def test_thresholds_are_left_out_and_what_acts_downwards_is_seen_below_a_value():
    d = diagnosis("none", tried("locking", 2.4), tried("crossing-slip", 0.016, 1.3), tried("steering", 0.05, 0.06))
    text = unseen_sentences(d)[0].replace("\u00a0", " ")
    assert text == (
        "Would have been seen: locking below angle 87.6 deg; crossing-slip above share 0.016; "
        "steering above curvature_warp 0.05 1/m, curvature_weft 0.06 1/m."
    )
    # a threshold alone shows nothing
    assert unseen_sentences(diagnosis("none", tried("crossing-slip", None, 1.3))) == [
        "Cannot be seen in these data: crossing-slip."
    ]


@pytest.mark.parametrize(("amounts", "all_seen"), [((0.1, 0.1, 0.1), True), ((0.1, None, None), False)])
def test_nothing_is_missing_only_as_far_as_the_data_show(amounts, all_seen):
    rows = [tried(n, a) for n, a in zip(("thickness", "weave-skew", "springback"), amounts, strict=True)]
    text = verdict_sentence(diagnosis("none", *rows))
    assert text.startswith("Nothing is missing:" if all_seen else "Nothing that can be seen in these data is missing:")


def test_no_number_is_given_for_what_was_not_seen_or_not_fitted():
    assert fitted_words(tried("slip", None, sigma=WIDE)) == "not seen"
    assert fitted_words(tried("bridging", None, sigma=WIDE, looked_at_only=True)) == "looked at only"
    steering = tried("steering", 0.1, None)
    values = (steering.values[0], Value("curvature_weft", 0.0, WIDE, "1/m"))
    some = fitted_words(Tried(**{**vars(steering), "values": values})).replace("\u00a0", " ")
    assert some == "curvature_warp 0.5 ± 0.02 1/m, curvature_weft not seen"


def test_the_interval_is_said_to_be_that_of_95_percent_wherever_it_stands():
    d = diagnosis("weave-skew", tried("weave-skew", 0.1, selected=True))
    assert verdict_sentence(d).replace("\u00a0", " ") == "The model lacks weave-skew (skew 2 ± 0.02 deg; 95 %)."
    assert table_rows(d)[0][1] == "fitted (± 95 %)"
    d.verdict, d.placement = "placement", (Value("du", 3.0, 0.1, "mm"),)
    assert "du 3 ± 0.2 mm (95 %)." in verdict_sentence(d).replace("\u00a0", " ")
    assert np.ptp(d.placement[0].interval) == pytest.approx(2 * 1.96 * 0.1)


def test_what_speaks_against_the_answer_is_said_with_it():
    d = diagnosis("none", tried("steering", 0.05, 0.06))
    assert verdict_sentence(d).startswith("Nothing is missing")
    assert "open" not in verdict_sentence(d)
    for d.confidence, said in ((0.08, "8"), (0.154, "15")):
        assert verdict_sentence(d).endswith(f"These data leave that open (confidence {said} %): measure more points.")
    d.warnings = ("t.csv: it looks as if u and v are swapped: half of the points would then lie nearer",)
    assert verdict_sentence(d).startswith("The table looks wrong: see the warning. If it is right: N")


def test_a_size_that_cannot_be_is_no_rival_nor_is_what_these_data_do_not_show():
    rows = [
        tried("weave-skew", 0.1, selected=True),
        tried("shear-asymmetry", 0.1, share=0.5, in_range=False),  # found where it does nothing
        tried("springback", None, share=0.6, in_range=True),
        tried("thickness", 0.2, share=0.3, in_range=True),
    ]
    assert rival_sentence(diagnosis("weave-skew", *rows)).startswith("The next best, thickness, explains 30 %")
    assert rival_sentence(diagnosis("weave-skew", *rows[:3])).startswith("No other effect that these data show")
    assert rival_sentence(diagnosis("weave-skew", rows[0])) is None
    both = [*rows, tried("yarn-extension", 0.1, 0.1, selected=True)]
    assert "30 % of what weave-skew leaves" in rival_sentence(diagnosis("weave-skew+yarn-extension", *both))


def test_large_numbers_are_written_without_an_exponent():
    row = tried("bridging", 172.4, sigma=36.0, selected=True)
    d = diagnosis("none", Tried(**{**vars(row), "cv_error": 397256.05, "selected": False}))
    cells = " ".join(table_rows(d)[1] + tuple(unseen_sentences(d))).replace("\u00a0", " ")
    assert "397256" not in cells
    assert "397000" in cells
    assert "± 70 mm" in cells
    assert "radius 170 mm" in cells
    huge = Tried(**{**vars(d.tried[0]), "cv_error": 3972560.5})
    assert "3970000" in table_rows(diagnosis("none", huge))[1]


def test_lines_set_apart_are_named_once_and_the_rest_counted():
    d = diagnosis("none")
    d.outliers = [SimpleNamespace(line=line) for line in (5, 3, 3, *range(10, 24))]
    assert outlier_sentence(d).endswith("lines 3, 5, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19 and 4 more.")
    d.outliers = [SimpleNamespace(line=7)]
    assert outlier_sentence(d).endswith(": line 7.")
    d.outliers = []
    assert outlier_sentence(d) is None


def test_the_model_agrees_nearly_where_a_little_is_left():
    d = diagnosis("none", tried("steering", 0.05, 0.06))
    assert "agrees with the measurement down to its noise" in verdict_sentence(d)
    d.leftover = Leftover(0.01, 0.8, ("along",))
    assert "agrees with the measurement nearly down to its noise" in verdict_sentence(d)
