"""model.toml: a drape model as a list of effects with their values, written and read back."""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from geomdrap.effects.registry import asked
from geomdrap.errors import EffectError
from geomdrap.fishnet import Effect
from geomdrap.fishnet.held_warp import HeldWarp

FORMAT = "geomdrap.model/1"
MEANT, HELD = ("origin", "angle", "reference", "pitch"), ("held",)


def write_model(
    path: str | Path,
    effects: Sequence[Effect],
    notes: Sequence[str] = (),
    layup: Mapping[str, str | float | Sequence[float]] | None = None,
) -> None:
    """Write effects (the placement among them) to a model file; ``notes`` become comments at its head.

    ``layup`` says how the ply was meant to lie that the effects were fitted to: origin, angle, reference; of relaxed
    nets also the pitch, mm, and the length of warp that was held, which a ``HeldWarp`` among the effects says, too.

    Raises EffectError for an effect without a name: it could not be found again.
    """
    held = next((e.values["length"] for e in effects if isinstance(e, HeldWarp)), None)
    effects, layup = [e for e in effects if not isinstance(e, HeldWarp)], dict(layup or {})
    layup |= {"held": held} if held else {}
    lines = [f"# {line}" for note in notes for line in note.splitlines()]
    lines += [f'format = "{FORMAT}"']
    if layup:
        lines += ["", "[layup]", *(f"{key} = {_toml(value)}" for key, value in layup.items())]
    for effect in effects:
        if not effect.name:
            raise EffectError(f"effect {effect.title()} has no name, so no model file can hold it; give it one")
        lines += ["", "[[effect]]", f'name = "{effect.name}"']
        lines += [f"{p.name} = {effect.values[p.name]!r}{_unit(p.unit)}" for p in effect.parameters]
    Path(path).write_text("\n".join(lines) + "\n", encoding="utf-8")


def _toml(value: str | float | Sequence[float]) -> str:
    """A text, a number or numbers as TOML has them."""
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, Sequence):
        return f"[{', '.join(repr(float(x)) for x in value)}]"
    return repr(float(value))


def _unit(unit: str) -> str:
    return f"  # {unit}" if unit else ""


def read_model(path: str | Path) -> tuple[Effect, ...]:
    """The effects of a model file, in its order, and a ``HeldWarp`` where its lay-up says how much was held.

    Raises EffectError where it is no model file of a known format, names unknown effects or values, or an effect
    without the values that it needs to act.
    """
    document = _document(path)
    entries = document.get("effect", [])
    if not (isinstance(entries, list) and all(isinstance(entry, dict) for entry in entries)):
        raise EffectError(f"model {path}: write each effect as a table [[effect]]")
    held = read_layup(path, HELD).get("held")
    return (*(_effect_of(entry, path) for entry in entries), *([HeldWarp(length=held)] if held else []))


def read_layup(path: str | Path, wanted: Sequence[str] = MEANT) -> dict[str, Any]:
    """How the ply was meant to lie that a model file was fitted to: ``origin``, ``angle`` ..., if it says.

    Raises EffectError where it is no model file, or holds something else there.
    """
    found = _document(path).get("layup", {})
    if not isinstance(found, dict):
        raise EffectError(f"model {path}: write the lay-up as a table [layup]")
    out: dict[str, Any] = {}
    for key, value in found.items():
        if key in ("angle", "pitch", "held") and isinstance(value, (int, float)) and (key == "angle" or value > 0.0):
            out[key] = float(value)
        elif key in ("origin", "reference") and _is_point(value):
            out[key] = tuple(float(x) for x in value)
        elif key == "origin" and isinstance(value, str):
            out[key] = value
        else:
            raise EffectError(
                f"model {path}: [layup] holds origin, angle, reference, pitch and held, not {key} = {value!r}"
            )
    return {key: value for key, value in out.items() if key in wanted}


def _is_point(value: Any) -> bool:
    return isinstance(value, list) and len(value) == 3 and all(isinstance(x, (int, float)) for x in value)


def _document(path: str | Path) -> dict[str, Any]:
    """What a model file holds, of a known format."""
    try:
        document = tomllib.loads(Path(path).read_text(encoding="utf-8"))
    except OSError as error:
        raise EffectError(f"model {path} cannot be read ({error.strerror}); check the path") from error
    except (tomllib.TOMLDecodeError, UnicodeDecodeError) as error:
        raise EffectError(f"model {path} is no TOML file: {error}") from error
    if "format" not in document:
        raise EffectError(f"{path} is no model file: it has no format = {FORMAT!r} (a set-up goes with --setup)")
    if document["format"] != FORMAT:
        raise EffectError(f"model {path} has format {document['format']!r}; this version reads {FORMAT!r}")
    for key in set(document) - {"format", "layup", "effect"}:
        raise EffectError(f"model {path}: {key!r} is not known; a model has a format, [layup] and [[effect]] tables")
    return document


def _effect_of(entry: Mapping[str, Any], path: str | Path) -> Effect:
    """The effect of one table."""
    values = {key: value for key, value in entry.items() if key != "name"}
    if not isinstance(entry.get("name"), str):
        raise EffectError(f"model {path}: an [[effect]] has no name")
    for key, value in values.items():
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise EffectError(f"model {path}: {key} of {entry['name']} must be a number, not {value!r}")
    try:
        return asked(entry["name"], values)
    except EffectError as error:
        raise EffectError(f"model {path}: {error}") from error
