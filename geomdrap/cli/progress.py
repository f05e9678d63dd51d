"""Progress on stderr: only on a terminal, and only for steps that take over a second."""

from __future__ import annotations

import os
import sys
import threading
import time
from pathlib import Path
from types import TracebackType

import click

PATIENCE = 1.0  # s before a step is worth mentioning
_REDRAW = 0.1
_TICK = 1.0  # s between two counts of a step that tells no share
_WIDTH = 30


class Progress:
    """Steps of a run, shown once they take over a second.

    A step that tells its share is shown as ``Evaluating [#####.....] 50 %``, one that tells words as
    ``Fitting ... 12 runs``, another one as ``Draping ... 3 s``.
    """

    def __init__(self, quiet: bool = False):
        self.enabled = not quiet and sys.stderr.isatty()
        self._name = ""
        self._start = self._drawn_at = 0.0
        self._timer: threading.Timer | None = None
        self._lock = threading.Lock()
        self._drawn = False

    def __enter__(self) -> Progress:
        """Start."""
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Take the line away, also after an error."""
        self._end_step()

    def step(self, name: str) -> None:
        """Begin the step ``name``; the one before it is over."""
        self._end_step()
        if not self.enabled:
            return
        self._name = name
        self._start = time.monotonic()
        self._count(PATIENCE)

    def share(self, done: float, words: str = "") -> None:
        """Take the share of the step that is done, 0 to 1, and words on it. Cheap enough to be called often."""
        if not self._is_due():
            return
        filled = round(_WIDTH * min(max(done, 0.0), 1.0))
        bar = "#" * filled + "." * (_WIDTH - filled)
        self._draw(f"{self._name} [{bar}] {100 * done:3.0f} %{words and ', '}{words}")

    def tell(self, words: str) -> None:
        """Take words on how far a step is whose end is not known. Cheap enough to be called often."""
        if self._is_due():
            self._draw(f"{self._name} ... {words}")

    def _is_due(self) -> bool:
        """Whether it is time to draw again; then the seconds are no longer counted."""
        now = time.monotonic()
        if not self.enabled or now - self._start < PATIENCE or now - self._drawn_at < _REDRAW:
            return False
        self._drawn_at = now
        self._stop_counting()
        return True

    def _draw(self, text: str) -> None:
        self._drawn = True
        sys.stderr.write(f"\r\x1b[K{text}")  # not click.echo: it drops control codes by its own rules
        sys.stderr.flush()

    def _count(self, wait: float) -> None:
        """Show the seconds that the step has taken, after a while and then again and again."""
        timer = threading.Timer(wait, self._tick)
        timer.daemon = True
        self._timer = timer
        timer.start()

    def _tick(self) -> None:
        with self._lock:
            if self._timer is threading.current_thread():  # else the step has ended or tells its share
                self._draw(f"{self._name} ... {time.monotonic() - self._start:.0f} s")
                self._count(_TICK)

    def _stop_counting(self) -> None:
        with self._lock:
            if self._timer is not None:
                self._timer.cancel()
                self._timer = None

    def _end_step(self) -> None:
        self._stop_counting()
        if self._drawn:
            self._draw("")
            self._drawn = False


def announce_compilation(quiet: bool, package: str = "fishnet") -> None:
    """Say once, before the first run on a machine, why it takes longer; ``package`` holds the kernels used."""
    if not quiet and not kernels_are_compiled(package):
        more = "less where other commands first run"
        click.echo(f"Note: compiling the kernels for this machine, once: a minute or two, {more}", err=True)


def kernels_are_compiled(package: str = "fishnet") -> bool:
    """Tell whether numba's cache holds the kernels of ``package`` for this Python; needs no numba itself."""
    if os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0"):
        return True
    pattern = f"*.py{sys.version_info.major}{sys.version_info.minor}.nbi"
    return any(any(folder.glob(pattern)) for folder in _cache_folders(package))


def _cache_folders(package: str) -> list[Path]:
    """Give the folders where numba keeps what it compiled of ``package``: the one chosen, or its own two."""
    chosen = os.environ.get("NUMBA_CACHE_DIR")
    if chosen:
        return list(Path(chosen).glob(f"{package}_*"))
    user = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "numba"
    return [Path(__file__).parent.parent / package / "__pycache__", *user.glob(f"{package}_*")]
