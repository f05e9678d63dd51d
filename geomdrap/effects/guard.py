"""What the user's own effect does wrong is said of it, with its file and line: it is no bug of geomdrap."""

from __future__ import annotations

import functools
import sys
import traceback
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np

from geomdrap.errors import GeomdrapError, PluginError, interrupt_within
from geomdrap.fishnet import Effect

if TYPE_CHECKING:
    from geomdrap.fishnet import Net

STAGES = ("on_surface", "on_placement", "on_fabric", "on_net")
"""The methods at which an effect acts."""
GUARDED = "_is_guarded"
"""Attribute of a class that is guarded: once is enough."""


def guard(effect: type[Effect], place: str) -> None:
    """Let what a class of effects has of its own raise PluginError, naming ``place``, where it fails."""
    if GUARDED in vars(effect):
        return
    for name in ("__init__", *STAGES):
        if name in vars(effect):
            setattr(effect, name, _guarded(effect, name, place))
    if hasattr(vars(effect).get("is_neutral"), "__get__"):  # a plain True or False cannot fail
        setattr(effect, "is_neutral", property(_guarded(effect, "is_neutral", place)))  # noqa: B010 - not for mypy
    setattr(effect, GUARDED, True)


def _guarded(effect: type[Effect], name: str, place: str) -> Callable[..., Any]:
    """The method, or what gives the property, of that name."""
    own = vars(effect)[name]

    @functools.wraps(own)
    def call(self: Effect, *given: Any, **values: Any) -> Any:
        try:
            result = own.__get__(self, type(self)) if hasattr(own, "__get__") else own  # as Python binds it
            if name != "is_neutral":
                result = result(*given, **values)
        except (GeomdrapError, MemoryError):
            raise
        except Exception as error:  # the user's code may raise anything
            if interrupt_within(error) is not None:
                raise
            where = f"{name}{_line(error, effect)}"
            raise PluginError(
                f"{place}: effect {self.title()} failed in {where}: {type(error).__name__}: {error}"
            ) from error
        wrong = _wrong(name, result)
        if wrong:
            raise PluginError(f"{place}: effect {self.title()} returned {wrong} (see samples/my_effect.py)")
        return result

    return call


def _wrong(name: str, result: Any) -> str:
    """What is wrong with what a method returned, and what it must be; nothing where it is right."""
    wanted = _given_by(name)
    right = isinstance(result, wanted)
    if not right:
        what = "nothing" if result is None else type(result).__name__
        return f"{what} from {name}; it must {'be' if name == 'is_neutral' else 'return the'} {_words(wanted)}"
    return _misshapen(result) if name == "on_net" else ""


def _given_by(name: str) -> tuple[type, ...]:
    """What a method must return."""
    from geomdrap.fishnet import Fabric, Net
    from geomdrap.fishnet.shift import Shift
    from geomdrap.surface import Surface

    gives = {"on_surface": Surface, "on_placement": Shift, "on_fabric": Fabric, "on_net": Net}
    return (bool, np.bool_) if name == "is_neutral" else (gives.get(name, type(None)),)


def _words(wanted: tuple[type, ...]) -> str:
    return "a property that is True or False" if bool in wanted else wanted[0].__name__


def _misshapen(net: Net) -> str:
    """Which array of a net does not go with the others; nothing where all do."""
    nu, nv = np.size(net.u), np.size(net.v)
    shapes: dict[str, tuple[int, ...]] = {"u": (nu,), "v": (nv,), "points": (nu, nv, 3), "face": (nu, nv)}
    shapes |= {"status_around": (nu + 2, nv + 2), "lattice": (nu, nv, 3), "yarns": (2, nu, nv, 3), "shear": (nu, nv)}
    shapes |= dict.fromkeys(("cell_valid", "lattice_valid", "cell_shear"), (nu - 1, nv - 1))
    arrays = {name: getattr(net, name) for name in shapes}
    if net.sides is not None:
        if not (isinstance(net.sides, tuple) and len(net.sides) == 2):
            return "a Net from on_net whose sides are no pair; they must be two arrays, of warp and weft"
        arrays |= {"sides[0]": net.sides[0], "sides[1]": net.sides[1]}
        shapes |= {"sides[0]": (nu - 1, nv), "sides[1]": (nu, nv - 1)}
    if net.moved is not None:
        arrays["moved"], shapes["moved"] = net.moved, (nu, nv, 3)
    for name, array in arrays.items():
        found = array.shape if isinstance(array, np.ndarray) else type(array).__name__
        if found != shapes[name]:
            return f"a Net from on_net whose {name} is {found}; it must be an array {shapes[name]}"
    return ""


def _line(error: Exception, effect: type[Effect]) -> str:
    """Where in the file of the class it went wrong."""
    file = sys.modules[effect.__module__].__file__ if effect.__module__ in sys.modules else None
    lines = [frame.lineno for frame in traceback.extract_tb(error.__traceback__) if frame.filename == file]
    return f", line {lines[-1]}" if lines else ""
