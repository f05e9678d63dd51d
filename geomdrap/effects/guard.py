"""What the user's own effect does wrong is said of it, with its file and line: it is no bug of geomdrap."""

from __future__ import annotations

import functools
import sys
import traceback
from collections.abc import Callable
from typing import Any

from geomdrap.errors import GeomdrapError, PluginError, interrupt_within
from geomdrap.fishnet import Effect

STAGES = ("on_surface", "on_placement", "on_fabric", "on_net")
"""The methods at which an effect acts."""


def guard(effect: type[Effect], place: str) -> None:
    """Let the methods that a class of effects has of its own raise PluginError, naming ``place``, where they fail."""
    for name in ("__init__", *STAGES):
        if name in vars(effect):
            setattr(effect, name, _guarded(vars(effect)[name], name, place))


def _guarded(method: Callable[..., Any], name: str, place: str) -> Callable[..., Any]:
    @functools.wraps(method)
    def call(self: Effect, *given: Any, **values: Any) -> Any:
        try:
            result = method(self, *given, **values)
        except (GeomdrapError, MemoryError):
            raise
        except Exception as error:  # the user's code may raise anything
            if interrupt_within(error) is not None:
                raise
            where = f"{name}{_line(error, method)}"
            raise PluginError(
                f"{place}: effect {self.title()} failed in {where}: {type(error).__name__}: {error}"
            ) from error
        wanted = _given_by(name)
        if not isinstance(result, wanted):
            raise PluginError(
                f"{place}: effect {self.title()} returned {_told(result)} from {name}; it must return the "
                f"{wanted.__name__} (see samples/my_effect.py)"
            )
        return result

    return call


def _given_by(name: str) -> type:
    """What a method must return."""
    from geomdrap.fishnet import Fabric, Net
    from geomdrap.fishnet.shift import Shift
    from geomdrap.surface import Surface

    gives = {"on_surface": Surface, "on_placement": Shift, "on_fabric": Fabric, "on_net": Net}
    return gives.get(name, type(None))


def _line(error: Exception, method: Callable[..., Any]) -> str:
    """Where in the file of the method it went wrong."""
    file = sys.modules[method.__module__].__file__ if method.__module__ in sys.modules else None
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == file]
    return f", line {lines[-1]}" if lines else ""


def _told(result: Any) -> str:
    return "nothing" if result is None else type(result).__name__
