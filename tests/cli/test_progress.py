"""Progress and the note on compilation."""

from __future__ import annotations

import io
import sys
import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest

from geomdrap.cli import progress
from geomdrap.cli.progress import Progress, announce_compilation, kernels_are_compiled


class Terminal(io.StringIO):
    """A stderr that says it is a terminal; put in place in the test, as pytest resets what fixtures set."""

    def isatty(self) -> bool:
        return True


@contextmanager
def _terminal(monkeypatch: pytest.MonkeyPatch, patience: float) -> Iterator[Terminal]:
    with monkeypatch.context() as patch:
        screen = Terminal()
        patch.setattr(sys, "stderr", screen)
        patch.setattr(progress, "PATIENCE", patience)
        yield screen


def test_nothing_is_shown_where_stderr_is_no_terminal(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(progress, "PATIENCE", 0.0)
    with Progress() as steps:
        steps.step("Draping")
        steps.share(0.5)
    assert capsys.readouterr().err == ""


def test_a_quick_step_shows_nothing(monkeypatch: pytest.MonkeyPatch) -> None:
    with _terminal(monkeypatch, patience=60.0) as screen, Progress() as steps:
        steps.step("Reading")
        steps.share(0.5)
        steps.step("Draping")
    assert screen.getvalue() == ""


def test_a_step_whose_end_is_not_known_shows_what_it_tells(monkeypatch: pytest.MonkeyPatch) -> None:
    with _terminal(monkeypatch, patience=0.0) as screen, Progress() as steps:
        steps.step("Fitting")
        steps.tell("12 runs")
    assert "\r\x1b[KFitting ... 12 runs" in screen.getvalue()
    assert screen.getvalue().endswith("\r\x1b[K")


def test_a_slow_step_shows_its_name_and_share_and_is_wiped_away(monkeypatch: pytest.MonkeyPatch) -> None:
    with _terminal(monkeypatch, patience=0.01) as screen, Progress() as steps:
        steps.step("Draping")
        time.sleep(0.1)
        steps.share(0.5)
    assert "Draping ..." in screen.getvalue()
    assert "50 %" in screen.getvalue()
    assert screen.getvalue().endswith("\r\x1b[K")


def test_a_step_without_shares_counts_its_seconds_and_no_longer_than_it_lasts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "_TICK", 0.02)
    with _terminal(monkeypatch, patience=0.01) as screen, Progress() as steps:
        steps.step("Draping")
        time.sleep(0.2)
        steps.step("Evaluating")
        drawn = screen.getvalue()
        assert drawn.count("Draping ... 0 s") > 2
        steps.share(0.5)
        time.sleep(0.1)
    assert "Draping" not in screen.getvalue()[len(drawn) :]


def test_quiet_shows_nothing_even_on_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    with _terminal(monkeypatch, patience=0.0) as screen, Progress(quiet=True) as steps:
        steps.step("Draping")
        steps.share(0.5)
    assert screen.getvalue() == ""


def test_the_line_is_wiped_away_after_an_error_too(monkeypatch: pytest.MonkeyPatch) -> None:
    with _terminal(monkeypatch, patience=0.0) as screen, pytest.raises(RuntimeError), Progress() as steps:
        steps.step("Draping")
        steps.share(0.5)
        raise RuntimeError
    assert screen.getvalue().endswith("\r\x1b[K")


def test_an_empty_cache_is_announced_and_a_filled_one_is_not(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("NUMBA_DISABLE_JIT", raising=False)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    assert not kernels_are_compiled()
    announce_compilation(quiet=False)
    assert capsys.readouterr().err.startswith("Note: compiling the kernels")
    deep = tmp_path / "fishnet_0a1b"
    deep.mkdir()
    (deep / f"march.walk-1.py{sys.version_info.major}{sys.version_info.minor}.nbi").touch()
    assert kernels_are_compiled()
    announce_compilation(quiet=False)
    assert capsys.readouterr().err == ""


def test_kernels_of_another_python_do_not_count(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("NUMBA_DISABLE_JIT", raising=False)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    (tmp_path / "fishnet_0a1b").mkdir()
    (tmp_path / "fishnet_0a1b" / "march.walk-1.py27.nbi").touch()
    assert not kernels_are_compiled()


def test_evaluating_and_writing_tell_their_shares_in_small_steps(tmp_path: Path) -> None:
    import geomdrap as gd
    from geomdrap.export.outputs import write_all
    from geomdrap.surface import shapes

    evaluating: list[float] = []
    writing: list[float] = []
    net = gd.drape(shapes.sphere_cap(100.0, 50.0, 8.0), "centroid", 20.0, 8.0)
    result = gd.evaluate(net, progress=evaluating.append)
    write_all(result, tmp_path / "all", progress=writing.append)
    for shares in (evaluating, writing):
        assert shares == sorted(shares)
        steps = [b - a for a, b in zip([0.0, *shares], [*shares, 1.0], strict=True)]
        assert max(steps) < 0.35
    assert writing[-1] == pytest.approx(1.0)
