"""Whatever goes wrong ends in one line and the right exit code."""

from __future__ import annotations

import errno
import os
import signal
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import Result

import geomdrap.cli.drape as drape_module
from geomdrap.cli import COMMANDS
from geomdrap.errors import DrapeError

Run = Callable[..., Result]

IN_A_KERNEL = SystemError("<function kernel> returned a result with an exception set")
IN_A_KERNEL.__cause__ = KeyboardInterrupt()
OTHER_SYSTEM_ERROR = SystemError("odd")
OTHER_SYSTEM_ERROR.__context__ = ZeroDivisionError()


def _raising(error: BaseException) -> Callable[..., None]:
    def compute(*_: object, **__: object) -> None:
        raise error

    return compute


@pytest.mark.parametrize(
    ("error", "code", "words"),
    [
        (
            DrapeError("the seed is on the moon;\nuse another"),
            2,
            "Error: the seed is on the moon; use another\n",
        ),
        (OSError(errno.ENOSPC, "No space left on device", "x.csv"), 2, "x.csv: No space left"),
        (OSError("odd"), 2, "Error: odd"),
        (MemoryError(), 2, "not enough memory"),
        (KeyboardInterrupt(), 130, "interrupted"),
        (IN_A_KERNEL, 130, "interrupted"),
        (OTHER_SYSTEM_ERROR, 3, "a bug in geomdrap (SystemError: odd)"),
        (ZeroDivisionError("by zero"), 3, "a bug in geomdrap (ZeroDivisionError: by zero)"),
    ],
    ids=lambda value: type(value).__name__ if isinstance(value, BaseException) else "",
)
def test_an_exception_becomes_one_line(
    run: Run, monkeypatch: pytest.MonkeyPatch, error: BaseException, code: int, words: str
) -> None:
    monkeypatch.setattr(drape_module, "compute", _raising(error))
    result = run("drape", "part.stl", "-q")
    assert result.exit_code == code
    assert words in result.stderr
    assert len(result.stderr.strip().splitlines()) == 1
    assert result.stdout == ""


def test_a_bug_shows_its_traceback_on_request(run: Run, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(drape_module, "compute", _raising(ZeroDivisionError("by zero")))
    assert "GEOMDRAP_TRACEBACK=1" in run("drape", "part.stl").stderr
    monkeypatch.setenv("GEOMDRAP_TRACEBACK", "1")
    assert "Traceback" in run("drape", "part.stl").stderr


def test_an_unknown_command_names_those_there_are(error_of: Callable[..., str]) -> None:
    message = error_of("drap", "part.stl")
    assert "no command 'drap'" in message
    assert ", ".join(COMMANDS) in message


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["drape"], "Missing argument 'PART'"),
        (["drape", "a.stl", "--angel", "3"], "No such option"),
        (["drape", "a.stl", "b.stl"], "unexpected extra argument"),
        (["drape", "a.stl", "--unit", "ft"], "'ft' is not one of 'mm', 'cm', 'm', 'in'"),
        (["drape", "a.stl", "--angle"], "requires an argument"),
        (["--nonsense"], "No such option"),
        (["sample", "hood", "--list"], "either the NAME of a sample or --list"),
        (["sample"], "either the NAME of a sample or --list"),
        (["diff", "a"], "Missing argument 'NEW'"),
        (["diff", "a", "b", "--tol-mm", "-1"], "--tol-mm"),
    ],
    ids=" ".join,
)
def test_wrong_usage_is_one_line_that_says_where_to_look(
    error_of: Callable[..., str], arguments: list[str], words: str
) -> None:
    message = error_of(*arguments)
    assert words in message
    assert "--help')" in message


def test_no_arguments_show_the_help(run: Run) -> None:
    result = run()
    assert result.exit_code == 2
    assert "Commands:" in result.stderr


def test_a_reader_that_has_seen_enough_is_no_error(tmp_path: Path) -> None:
    code = f"{sys.executable} -m geomdrap sample --list | true; exit ${{PIPESTATUS[0]}}"
    done = subprocess.run(["bash", "-c", code], capture_output=True, text=True, check=False, timeout=60)
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.skipif(os.name == "nt", reason="signals of another kind")
def test_an_interrupt_from_the_keyboard_ends_with_130_and_no_traceback(tmp_path: Path) -> None:
    code = (
        "import time, geomdrap.cli.drape as d\n"
        "def compute(*_, **__):\n    print('ready', flush=True)\n    time.sleep(60)\n"
        "d.compute = compute\nfrom geomdrap.cli import cli\ncli.main(['drape', 'a.stl'])"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=tmp_path
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.1)
    process.send_signal(signal.SIGINT)
    _, errors = process.communicate(timeout=30)
    assert process.returncode == 130
    assert "interrupted" in errors
    assert "Traceback" not in errors
    assert not list(tmp_path.iterdir())


def test_the_exit_codes_of_the_help_are_those_of_the_readme(run):
    readme = " ".join((Path(__file__).parents[2] / "README.md").read_text(encoding="utf-8").replace("`", "").split())
    codes = run("--help").stdout.split("Exit codes:")[1].split("Options:")[0]
    said = [" ".join(line.split(maxsplit=1)) for line in codes.splitlines() if line.strip()]
    assert len(said) == 5
    assert "Exit codes: " + "; ".join(said) in readme
