"""The readable summaries of a diagnosis and of an improvement: words first, then the table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from geomdrap.cli.wrapped import wrapped

if TYPE_CHECKING:
    from geomdrap.criticism import Diagnosis, Improvement


def summary(diagnosis: Diagnosis, files: Mapping[str, Path]) -> str:
    """Give the diagnosis as text."""
    from geomdrap.criticism.story import table_rows

    return "\n".join([*_words(diagnosis), "", *_table(table_rows(diagnosis)), *_files(files)])


def improvement_summary(improvement: Improvement, files: Mapping[str, Path]) -> str:
    """Give the improvement as text: the verdict, and a line for each model on the way."""
    d = improvement.diagnosis
    rows = [("model", "error", "held out", "position", "shear")]
    for step in d.steps:
        name = "as meant" if step.added is None else f"+ {step.added}"
        position = "-" if step.rms_position is None else f"{step.rms_position:.3g} mm"
        shear = "-" if step.rms_shear is None else f"{step.rms_shear:.3g}°"
        rows.append((name, f"{step.error:.2f}", f"{step.cv_error:.2f}", position, shear))
    rows.append(("noise and scatter", f"{d.noise_floor:.2f}", "", "", ""))
    return "\n".join([*_words(d, improvement.notes), "", *_table(rows), *_files(files)])


def _words(diagnosis: Diagnosis, more: Sequence[str] = ()) -> Iterator[str]:
    from geomdrap.criticism import story

    yield from wrapped(story.verdict_sentence(diagnosis))
    yield from wrapped(story.error_sentence(diagnosis))
    first = story.placement_sentence(diagnosis), story.rival_sentence(diagnosis)
    last = *story.unseen_sentences(diagnosis), story.outlier_sentence(diagnosis)
    for sentence in (*first, *more, *diagnosis.hints, *last):
        if sentence:
            yield from wrapped(sentence[0].upper() + sentence[1:])


def _table(rows: Sequence[tuple[str, ...]]) -> Iterator[str]:
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    for row in rows:
        yield "  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip()


def _files(files: Mapping[str, Path]) -> Iterator[str]:
    if files:
        yield ""
        yield f"files: {', '.join(str(f) for f in files.values())}"
