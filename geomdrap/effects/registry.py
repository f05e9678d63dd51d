"""The effects there are, by name: the library's own, those of installed packages, and the user's."""

from __future__ import annotations

from collections.abc import Mapping
from difflib import get_close_matches
from functools import cache
from importlib import import_module
from importlib.metadata import entry_points

from geomdrap.effects.guard import guard
from geomdrap.errors import EffectError
from geomdrap.fishnet import Effect, Parameter

GROUP = "geomdrap.effects"  # of entry points of other packages

LIBRARY = (
    "placement",
    "yarn-extension",
    "tension-gradient",
    "weave-skew",
    "steering",
    "slip",
    "thickness",
    "bridging",
    "shear-stiffness",
    "locking",
    "shear-asymmetry",
    "yarn-bending",
    "crossing-slip",
    "springback",
)

_REGISTERED: dict[str, type[Effect]] = {}


def _own(name: str) -> type[Effect]:
    """The class of an effect of the library, in the module of the same name."""
    module = import_module(f"geomdrap.effects.{name.replace('-', '_')}")
    effect: type[Effect] = getattr(module, name.title().replace("-", ""))
    return effect


@cache
def _installed() -> dict[str, type[Effect]]:
    """The library's own effects and those that installed packages offer as entry points, which are guarded.

    Raises EffectError for an entry point that is no effect with a name of its own.
    """
    found = {name: _own(name) for name in LIBRARY}
    for point in entry_points(group=GROUP):
        try:
            effect = point.load()
        except Exception as error:  # another package's code may raise anything
            raise EffectError(
                f"effect {point.name} of {point.value} does not load ({error}); repair or remove it"
            ) from error
        _check(effect, point.value, found)
        for each in effect.__mro__:
            if issubclass(each, Effect) and each.__module__.partition(".")[0] != "geomdrap":
                guard(each, f"{each.__module__}:{each.__qualname__}")
        found[effect.name] = effect
    return found


def _check(effect: object, place: str, known: dict[str, type[Effect]]) -> None:
    """Raise EffectError for what is no effect or has no name of its own; a list of parameters becomes a tuple."""
    if not (isinstance(effect, type) and issubclass(effect, Effect) and effect.name):
        raise EffectError(f"{place} is no subclass of geomdrap.Effect with a name; give it one: name = 'my-effect'")
    if isinstance(effect.parameters, list):
        effect.parameters = tuple(effect.parameters)
    if not (isinstance(effect.parameters, tuple) and all(isinstance(p, Parameter) for p in effect.parameters)):
        raise EffectError(f"{place}: parameters must be a tuple of geomdrap.Parameter, as in samples/my_effect.py")
    if known.get(effect.name, effect) is not effect:
        raise EffectError(f"{place}: there is an effect {effect.name} already; choose another name")


def register(effect: type[Effect]) -> type[Effect]:
    """Make an effect known by its name, in place of one registered before; also a decorator.

    Raises EffectError where it has no name, or that of an effect of the library.
    """
    _check(effect, getattr(effect, "__name__", repr(effect)), _installed())
    _REGISTERED[effect.name] = effect
    return effect


def available() -> dict[str, type[Effect]]:
    """All effects by name; each says what it is and which ``parameters`` it takes (see ``Effect``)."""
    return {**_installed(), **_REGISTERED}


def find(name: str) -> type[Effect]:
    """The effect of a name. Raises EffectError, with the names there are, if there is none."""
    known = available()
    if name not in known:
        near = get_close_matches(name, known, 1, 0.7)
        meant = f" (is {near[0]} meant?)" if near else ""
        own = "" if near else "; one of your own comes with its file (--plugin, or gd.effects.load_plugin)"
        raise EffectError(f"there is no effect {name!r}{meant}; the effects are {', '.join(known)}{own}")
    return known[name]


def make(name: str, **values: float) -> Effect:
    """An effect by name with values of its parameters; those not given are neutral.

    Raises EffectError for an unknown effect or parameter, and for values out of bounds.
    """
    return find(name)(**values)


def asked(name: str, values: Mapping[str, float]) -> Effect:
    """As ``make``, for an effect that a person names in order that it acts; neutral values must be written out.

    Raises EffectError as ``make`` does, and where values are missing without which the effect does nothing.
    """
    effect = make(name, **values)
    if effect.is_neutral and all(effect.values[p] != _neutral(effect, p) for p in values):
        # those of which any would do: a threshold, such as an onset, does nothing alone
        missing = [p for p in effect.parameters if p.name not in values]
        missing = [p for p in missing if _acts(effect, p)] or missing
        if not missing:
            raise EffectError(f"effect {name} does nothing with these values; give others")
        first = missing[0]
        raise EffectError(
            f"effect {name} does nothing without a value of {' or '.join(p.name for p in missing)}: give one, "
            f"e.g. {name}:{first.name}={first.typical:g}"
        )
    return effect


def _acts(effect: Effect, more: Parameter) -> bool:
    """Whether an effect that does nothing does something with the typical value of one parameter more."""
    return not type(effect)(**{**effect.values, more.name: more.typical}).is_neutral


def _neutral(effect: Effect, name: str) -> float:
    return next(p.neutral for p in effect.parameters if p.name == name)


def parse(text: str) -> Effect:
    """An effect as written on a command line, ``slip:coefficient=0.6`` or ``yarn-extension:strain_warp=0.01,...``.

    Raises EffectError where it cannot be read, or would do nothing for want of a value.
    """
    name, _, rest = text.partition(":")
    values: dict[str, float] = {}
    for item in filter(None, (part.strip() for part in rest.split(","))):
        key, equals, number = (part.strip() for part in item.partition("="))
        try:
            value = float(number)
        except ValueError:
            equals = ""
        if not equals or key in values or "_" in number:
            raise EffectError(
                f"effect {text!r}: {item!r} is not PARAMETER=NUMBER, each once, as in slip:coefficient=0.6"
            )
        values[key] = value
    return asked(name.strip(), values)
