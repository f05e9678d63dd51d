"""model.toml: a drape model as a list of effects with their values, written and read back."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from geomdrap.effects.registry import asked
from geomdrap.errors import EffectError
from geomdrap.fishnet import Effect

FORMAT = "geomdrap.model/1"


def write_model(path: str | Path, effects: Sequence[Effect], notes: Sequence[str] = ()) -> None:
    """Write effects (the placement among them) to a model file; ``notes`` become comments at its head.

    Raises EffectError for an effect without a name: it could not be found again.
    """
    lines = [f"# {line}" for note in notes for line in note.splitlines()]
    lines += [f'format = "{FORMAT}"']
    for effect in effects:
        if not effect.name:
            raise EffectError(f"effect {effect.title()} has no name, so no model file can hold it; give it one")
        lines += ["", "[[effect]]", f'name = "{effect.name}"']
        lines += [f"{p.name} = {effect.values[p.name]!r}{_unit(p.unit)}" for p in effect.parameters]
    Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")


def _unit(unit: str) -> str:
    return f"  # {unit}" if unit else ""


def read_model(path: str | Path) -> tuple[Effect, ...]:
    """The effects of a model file, in its order.

    Raises EffectError where it is no model file of a known format, names unknown effects or values, or an effect
    without the values that it needs to act.
    """
    try:
        document = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise EffectError(f"model {path} cannot be read: {error.strerror}") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise EffectError(f"model {path} is no TOML file: {error}") from error
    if document.get("format") != FORMAT:
        raise EffectError(f"model {path} has format {document.get('format')!r}; this version reads {FORMAT!r}")
    for key in set(document) - {"format", "effect"}:
        raise EffectError(f"model {path}: {key!r} is not known; a model has a format and [[effect]] tables")
    entries = document.get("effect", [])
    if not (isinstance(entries, list) and all(isinstance(entry, dict) for entry in entries)):
        raise EffectError(f"model {path}: write each effect as a table [[effect]]")
    return tuple(_effect_of(entry, path) for entry in entries)


def _effect_of(entry: Mapping[str, Any], path: str | Path) -> Effect:
    """The effect of one table."""
    values = {key: value for key, value in entry.items() if key != "name"}
    if not isinstance(entry.get("name"), str):
        raise EffectError(f"model {path}: an [[effect]] has no name")
    try:
        return asked(entry["name"], values)
    except EffectError as error:
        raise EffectError(f"model {path}: {error}") from error
