"""Runs the command line in this process, and apart from it."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from click.testing import CliRunner, Result

from geomdrap.cli import cli

sys.path.insert(0, str(Path(__file__).parents[1] / "export"))  # square_ply: a finished drape, made up


@pytest.fixture
def run(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., Result]:
    """Run a command in an empty folder; exceptions that are not turned into exit codes fail the test."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.delenv("GEOMDRAP_TRACEBACK", raising=False)

    def call(*arguments: object) -> Result:
        return CliRunner().invoke(
            cli, [str(a) for a in arguments], prog_name="geomdrap", catch_exceptions=False
        )

    return call


@pytest.fixture
def shell(tmp_path: Path) -> Callable[..., subprocess.CompletedProcess[str]]:
    """Run ``geomdrap`` as a process of its own in an empty folder."""

    def call(*arguments: object, **more: object) -> subprocess.CompletedProcess[str]:
        command = [sys.executable, "-m", "geomdrap", *map(str, arguments)]
        return subprocess.run(  # type: ignore[call-overload,no-any-return]
            command, capture_output=True, text=True, check=False, cwd=tmp_path, timeout=120, **more
        )

    return call


@pytest.fixture
def error_of(run: Callable[..., Result]) -> Callable[..., str]:
    """Run a command that must fail with exit code 2 and one line on stderr, and give that line."""

    def call(*arguments: object) -> str:
        result = run(*arguments)
        assert result.exit_code == 2, result.output
        assert result.stdout == ""
        lines = [line for line in result.stderr.splitlines() if not line.startswith(("Note:", "Warning:"))]
        assert len(lines) == 1, result.stderr
        assert lines[0].startswith("Error: ")
        return lines[0].removeprefix("Error: ")

    return call
