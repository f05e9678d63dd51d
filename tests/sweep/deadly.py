"""Effects that do harm, for workers to meet. Importable in worker processes, unlike what a test defines."""

from __future__ import annotations

import os
import signal
import time
from pathlib import Path

import geomdrap as gd

ANGLE = 30.0


class Deadly(gd.Effect):
    """Kills the process that drapes the case at 30°, but not ``spared``; only once if there is a ``marker``."""

    def __init__(self, spared: int, marker: Path | None = None):
        super().__init__()
        self.spared, self.marker = spared, marker

    def on_net(self, net: gd.Net) -> gd.Net:
        if net.angle == ANGLE and os.getpid() != self.spared and not (self.marker and self.marker.exists()):
            if self.marker:
                self.marker.touch()
            os.kill(os.getpid(), signal.SIGKILL)
        return net


class Wrong(gd.Effect):
    """Raises what no effect should at 30°."""

    def on_net(self, net: gd.Net) -> gd.Net:
        if net.angle == ANGLE:
            raise ZeroDivisionError("one by nought")
        return net


class Interrupted(gd.Effect):
    """At 30° raises what Python makes of a Ctrl-C that comes while a compiled kernel runs."""

    def on_net(self, net: gd.Net) -> gd.Net:
        if net.angle == ANGLE:
            raise SystemError("<function kernel> returned a result with an exception set") from KeyboardInterrupt()
        return net


class Slow(gd.Effect):
    """Takes its time, and writes down which process draped which case."""

    def __init__(self, diary: Path | None = None, seconds: float = 0.2):
        super().__init__()
        self.diary, self.seconds = diary, seconds

    def on_net(self, net: gd.Net) -> gd.Net:
        if self.diary:
            with self.diary.open("a", encoding="utf-8") as file:
                file.write(f"{os.getpid()} {net.angle}\n")
        time.sleep(self.seconds)
        return net
